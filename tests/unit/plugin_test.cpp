// Plugins that work: what is read of them, loading, options, and the guard around calls.
#include <cstdlib>

#include <lgabench/core/perturbations.hpp>
#include <lgabench/plugin/fingerprint.hpp>
#include <lgabench/plugin/guarded.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/plugin/plugin.hpp>
#include <lgabench/plugin/reader.hpp>
#include <tabletop/two_poses.hpp>

#include "plugin_fixtures.hpp"

namespace lgabench {
namespace {

struct NoModel : LanguageModel {
  std::vector<bool> answer(const Command&, const FeatureSpace&, const std::vector<Question>&) override { return {}; }
  std::string model() const override { return "none"; }
  Provenance provenance() const override { return Provenance::none; }
  SelectionCost cost() const override { return {}; }
};
struct NoHuman : HumanAnswers {
  Selection specify(const Command&) override { return {}; }
  Selection edit(const Command&, const Selection& proposal) override { return proposal; }
};
struct CountingLog : TrainingLog {
  void epoch(int epochs, long long steps, double) override {
    last_epoch = epochs;
    last_steps = steps;
  }
  int last_epoch = 0;
  long long last_steps = 0;
};

struct Host {
  NoModel lm;
  NoHuman human;
  CountingLog log;
  Json options;
  Services services{lm, human, options, 0, log, tabletop::two_poses()};
};

TEST(Options, AQuestionnaireIsNoOptionUnlessItIsOne) {
  const std::string declared = "{" LGABENCH_QUESTIONNAIRE R"("a": {"default": 1, "help": "", "source": ""}})";
  EXPECT_TRUE(read_options(declared).questionnaire);
  EXPECT_EQ(read_options(declared).options.size(), 1u);
  const std::string named = R"({"questionnaire": {"default": true, "help": "", "source": ""}})";
  EXPECT_FALSE(read_options(named).questionnaire);
  EXPECT_EQ(read_options(named).options.size(), 1u);
  EXPECT_THROW(read_options(R"({"questionnaire": "yes"})"), PluginError);
}

TEST(Options, ANumberLiesBetweenItsBounds) {
  PluginInfo plugin;
  plugin.kind = "method";
  plugin.id = "mine";
  plugin.options = read_options(R"({
    "p": {"default": 0.5, "min": 0, "max": 1, "help": "", "source": ""},
    "n": {"default": 3, "max": 9, "words": ["all"], "help": "", "source": ""}})")
                       .options;
  const auto said = [&plugin](const Json& given) {
    return message_of<InputError>([&] { resolve_options(plugin, given); });
  };
  EXPECT_EQ(resolve_options(plugin, {{"p", 1}, {"n", 9}}), (Json{{"p", 1.}, {"n", 9}}));
  EXPECT_EQ(resolve_options(plugin, {{"n", "all"}}).at("n"), "all");
  EXPECT_SAYS(said({{"p", 1.5}}), "/p: expected a number from 0 to 1, got 1.5");
  EXPECT_SAYS(said({{"p", -.5}}), "/p: expected a number from 0 to 1, got -0.5");
  EXPECT_SAYS(said({{"n", 10}}), "/n: expected a whole number of 9 or less, got 10");

  const auto refused = [](const char* bound) {
    return message_of<PluginError>(
        [bound] { read_options(std::string(R"({"p": {"default": 2, "help": "", "source": "", )") + bound + "}}"); });
  };
  EXPECT_SAYS(refused(R"("max": 1)"), "options: /p/max: expected a number, not below a default that is one");
  EXPECT_SAYS(refused(R"("max": "many")"), "options: /p/max: expected a number");
}

TEST(Plugin, DescriptorIsReadFromTheBytes) {
  const PluginInfo info = read_plugin(fixture("good/fixture_constant"));
  EXPECT_EQ(info.kind, "method");
  EXPECT_EQ(info.id, "fixture_constant");
  EXPECT_EQ(info.version, "0.1");
  EXPECT_EQ(info.summary, "acts as in one of its demonstrations");
  EXPECT_EQ(info.fingerprint, LGABENCH_FINGERPRINT);  // this test is compiled like the plugin
  EXPECT_EQ(info.options.at("mode").at("values"), Json({"plain", "other"}));
  EXPECT_EQ(info.sha256.size(), 64u);
}

TEST(Plugin, LoadedMethodLearnsAndActs) {
  const PluginInfo info = read_plugin(fixture("good/fixture_constant"));
  Host host;
  host.options = resolve_options(info, {{"demonstration", 1}});
  std::vector<Demonstration> demonstrations(3);
  for (std::size_t i = 0; i < demonstrations.size(); ++i) {
    demonstrations[i].steps.resize(1);
    demonstrations[i].steps[0].label = {0.25 + 0.125 * static_cast<double>(i), -0.25};
  }
  std::unique_ptr<Policy> policy;
  {
    const auto method = load_method(info);
    EXPECT_EQ(method->needs(host.options).targets, Needs::Targets::truth);
    policy = method->learn(demonstrations, host.services);
  }
  const Action action = policy->act({}, {});  // the policy outlives its method
  EXPECT_EQ(action, (Action{0.375, -0.25}));
  EXPECT_EQ(host.log.last_epoch, 1);
  EXPECT_EQ(host.log.last_steps, 3);
}

TEST(Plugin, APerturbationSaysWhatItsAxisIsAndPerceives) {
  const PluginInfo plugin = read_plugin(fixture("perturbations/fixture_axis"));
  EXPECT_EQ(plugin.kind, "perturbation");
  EXPECT_EQ(plugin.axis.at("levels").at(1), "dead");
  EXPECT_EQ(plugin.axis.at("changes"), Json({"rgb"}));
  EXPECT_EQ(plugin.axis.at("version"), plugin.version);
  EXPECT_THROW(load_method(plugin), PluginError);
  const auto perturbation = load_perturbation(plugin);
  const Observation seen{{2, 2}, std::vector<std::uint8_t>(12, 100), {0, 1, 1, 0}, {{1, "heart", "red", 2}}};
  EXPECT_EQ(perturbation->perceive(seen, 2, RandomStream("a")).rgb, seen.rgb);
  const Observation brighter = perturbation->perceive(seen, 1, RandomStream("a"));
  EXPECT_GT(brighter.rgb.front(), 100);
  EXPECT_EQ(brighter.rgb, perturbation->perceive(seen, 1, RandomStream("a")).rgb);
  EXPECT_NE(brighter.rgb, perturbation->perceive(seen, 1, RandomStream("b")).rgb);
}

// examples/tinted_light and the shipped light_colour: an axis that changes perception alone needs nothing of lgabench's
// own.
TEST(Plugin, AnExampleMakesTheBytesOfAShippedAxis) {
  const PluginInfo plugin = read_plugin(fixture("examples/tinted_light"));
  const auto mine = load_perturbation(plugin);
  const PerturbationAxis& shipped = *axes_named("light_colour").front();
  EXPECT_EQ(plugin.axis.at("levels"), Json(shipped.levels));
  EXPECT_EQ(plugin.axis.at("changes"), Json(part_words(shipped.changes)));
  Observation seen{{16, 16}, std::vector<std::uint8_t>(3 * 256), std::vector<std::uint8_t>(256, 1), {}};
  for (std::size_t i = 0; i < seen.rgb.size(); ++i) seen.rgb[i] = static_cast<std::uint8_t>(i / 3);  // each grey
  for (int level = 1; level <= shipped.most(); ++level)
    for (const char* scene : {"a", "b", "c", "d", "e"}) {
      const Observation changed = mine->perceive(seen, level, RandomStream(scene));
      EXPECT_EQ(changed.rgb, shipped.perceive(seen, Scenario(), level, RandomStream(scene)).rgb);
      EXPECT_NE(changed.rgb, seen.rgb);
    }
}

TEST(Plugin, SameFileLoadsTwice) {
  const PluginInfo info = read_plugin(fixture("good/fixture_constant"));
  const auto a = load_method(info), b = load_method(info);
  EXPECT_NE(a.get(), b.get());
}

TEST(Plugin, ErrorsOfTheFrameworkCrossTheBoundaryTyped) {
  const PluginInfo info = read_plugin(fixture("good/fixture_constant"));
  Host host;
  host.options = resolve_options(info, Json::object());
  const auto method = load_method(info);
  const auto learn_from_nothing = [&] { return guarded(info.id, [&] { return method->learn({}, host.services); }); };
  EXPECT_EQ(message_of<MethodError>(learn_from_nothing), "plugin fixture_constant: needs a demonstration");
}

TEST(Plugin, FaultyMethodsFailWhenUsedNotWhenLoaded) {
  Host host;
  const auto policy_of = [&host](const PluginInfo& info) {
    host.options = resolve_options(info, Json::object());
    return load_method(info)->learn({}, host.services);
  };
  const PluginInfo throwing = read_plugin(fixture("faulty/fixture_throw"));
  const auto policy = policy_of(throwing);
  EXPECT_EQ(message_of<MethodError>([&] { guarded(throwing.id, [&] { policy->act({}, {}); }); }),
            "plugin fixture_throw: the fixture's own failure");

  const Action nan = policy_of(read_plugin(fixture("faulty/fixture_nan")))->act({}, {});
  EXPECT_THROW(executable(tabletop::two_poses(), nan), MethodError);

  const auto segfaulting = policy_of(read_plugin(fixture("faulty/fixture_segfault")));
  EXPECT_EXIT(
      segfaulting->act({}, {}), [](int status) { return status != 0; }, "");
}

TEST(Plugin, FlushToZeroIsRestoredAfterACallThatClearsIt) {
  const PluginInfo info = read_plugin(fixture("faulty/fixture_denormals"));
  Host host;
  host.options = Json::object();
  const auto policy = load_method(info)->learn({}, host.services);
  flush_denormals();
  policy->act({}, {});
#if defined(__SSE2__)
  EXPECT_FALSE(denormals_flushed()) << "the fixture does not do its harm";
#endif
  guarded(info.id, [&] { return policy->act({}, {}); });
  EXPECT_TRUE(denormals_flushed());
}

TEST(Guarded, ReturnsWhatTheCallReturns) {
  int value = 3;
  int& same = guarded("p", [&]() -> int& { return value; });
  EXPECT_EQ(&same, &value);
  EXPECT_EQ(*guarded("p", [] { return std::make_unique<int>(4); }), 4);
  guarded("p", [&] { value = 5; });
  EXPECT_EQ(value, 5);
}

TEST(Guarded, GivesEveryExceptionATypeAndTheCulprit) {
  const auto message = [](auto thrown) {
    return message_of<MethodError>([&] { guarded("p", [&] { throw thrown; }); });
  };
  EXPECT_EQ(message(std::runtime_error("first line\nsecond line")), "plugin p: first line");
  EXPECT_EQ(message(std::runtime_error("")), "plugin p: threw std::runtime_error");
  EXPECT_EQ(message(7), "plugin p: threw int");
  EXPECT_EQ(message(MethodError("x")), "plugin p: x");
  EXPECT_EQ(message(EngineError("x")), "plugin p: x") << "a method's failure is not the engine's";
}

TEST(Guarded, KeepsInputErrorsAndBlamesEnginesForTheirOwn) {
  EXPECT_EQ(message_of<InputError>([] { guarded("p", []() { throw InputError("no such file"); }); }),
            "plugin p: no such file");
  EXPECT_EQ(message_of<EngineError>([] { guarded<EngineError>("e", []() { throw std::bad_alloc(); }); }),
            "plugin e: std::bad_alloc");
  EXPECT_THROW(guarded("p", []() { throw std::bad_alloc(); }), std::bad_alloc) << "the cell's end, not an episode's";
}

TEST(Options, DefaultsFillIn) {
  const PluginInfo info = read_plugin(fixture("good/fixture_constant"));
  EXPECT_EQ(canonical(resolve_options(info, Json::object())),
            R"({"demonstration":0,"mode":"plain","scale":1.0,"verbose":false})");
  EXPECT_EQ(canonical(resolve_options(info, {{"mode", "other"}, {"scale", 2}, {"demonstration", 3}})),
            R"({"demonstration":3,"mode":"other","scale":2.0,"verbose":false})");
}

TEST(Options, WrongOnesAreNamedWithWhatIsExpected) {
  const PluginInfo info = read_plugin(fixture("good/fixture_constant"));
  const auto refusal = [&info](const Json& overrides) {
    const std::string message = message_of<InputError>([&] { resolve_options(info, overrides); });
    EXPECT_SAYS(message, "options of method fixture_constant: ");
    return message;
  };
  EXPECT_SAYS(
      refusal({{"scael", 2}}),
      "unknown member \"scael\" (did you mean \"scale\"?), expected one of: demonstration, mode, scale, verbose");
  EXPECT_SAYS(refusal({{"scale", "big"}}), "/scale: expected a number, got \"big\"");
  EXPECT_SAYS(refusal({{"demonstration", 0.5}}), "/demonstration: expected a whole number, got 0.5");
  EXPECT_SAYS(refusal({{"demonstration", -3}}), "/demonstration: expected a whole number of 0 or more, got -3");
  EXPECT_SAYS(refusal({{"verbose", 1}}), "/verbose: expected true or false, got 1");
  EXPECT_SAYS(refusal({{"mode", nullptr}}), "/mode: expected a text, got null");
  EXPECT_SAYS(refusal({{"mode", "third"}}), "/mode: expected one of [\"plain\",\"other\"] (");
  EXPECT_SAYS(refusal({{"mode", "third"}}), "), got \"third\"");
  EXPECT_SAYS(refusal(Json::array()), "expected an object");
}

TEST(Options, AValueMayNeedAnotherOptions) {
  PluginInfo info;
  info.kind = "method", info.id = "m";
  info.options = Json::parse(R"({
    "see": {"default": "mask", "values": ["mask", "all", "rgb"], "help": "", "source": ""},
    "way": {"default": "plain", "values": ["plain", "centroid"], "help": "", "source": "",
            "needs": {"centroid": {"see": ["mask", "all"]}}}})");
  EXPECT_EQ(resolve_options(info, {{"see", "all"}, {"way", "centroid"}})["way"], "centroid");
  EXPECT_EQ(resolve_options(info, {{"see", "rgb"}})["way"], "plain");
  EXPECT_SAYS(message_of<InputError>([&] {
                resolve_options(info, {{"see", "rgb"}, {"way", "centroid"}});
              }),
              R"(options of method m: /see: expected one of ["mask","all"], which way=centroid needs, got "rgb")");
}

TEST(Options, APluginWithoutOptionsSaysSo) {
  const PluginInfo info = read_plugin(fixture("faulty/fixture_throw"));
  EXPECT_EQ(resolve_options(info, Json::object()), Json::object());
  EXPECT_SAYS(message_of<InputError>([&] { resolve_options(info, {{"epochs", 1}}); }), "has no options");
}

TEST(Options, OfARowAreReadAsTheyAreWritten) {
  for (const char* text : {"squared", "5", "0.5", "1e+30", "true"}) EXPECT_EQ(option_text(option_value(text)), text);
  using Words = std::vector<std::string>;
  EXPECT_EQ(row_words("lga"), Words{"lga"});
  EXPECT_EQ(row_words("lga+loss=squared+rate=1e+30"), (Words{"lga", "loss=squared", "rate=1e+30"}));
  EXPECT_EQ(row_words("lga+5+"), (Words{"lga", "5", ""})) << "neither is lost: both are refused";
}

TEST(Directories, ShippedThenEnvironmentThenCommandLine) {
  ::setenv("LGABENCH_PLUGIN_PATH", "/first::/second", 1);
  const auto directories = plugin_directories({"/third"});
  ::unsetenv("LGABENCH_PLUGIN_PATH");
  EXPECT_EQ(directories, (std::vector<fs::path>{shipped_plugin_directory(), "/first", "/second", "/third"}));
}

}  // namespace
}  // namespace lgabench

// Perturbation axes: what each changes and leaves alone, nested levels, and that a dead or a leaking axis is caught.
#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/abstraction/selection_errors.hpp>
#include <lgabench/cell/hosted_axes.hpp>
#include <lgabench/cell/perturbed.hpp>
#include <lgabench/cell/steps.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/harness/suite_scenario.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

constexpr int episodes = 5;

struct Drawn {
  Scene scene;
  Observation seen;
};

// Test scenes of the first arm as they are seen without perturbations: drawn once.
const std::vector<Drawn>& drawn(const Scenario& scenario) {
  static std::map<std::string, std::vector<Drawn>> all;
  std::vector<Drawn>& of = all[scenario.id];
  for (int i = static_cast<int>(of.size()); i < episodes; ++i) {
    const Scene scene = test_scene(scenario, layouts_of(scenario).front(), scenario.tests.front().id, 0, i);
    of.push_back({scene, scenario.environment->draw(scene)});
  }
  return of;
}

// Scenes of an arm that has that axis, as a policy sees them; level 0: the control's.
std::vector<PerturbedEpisode> played(const std::vector<const PerturbationAxis*>& axes, int level,
                                     const std::string& id = "heart") {
  const Scenario scenario = load_scenario(id);
  const EnvironmentType& environment = *scenario.environment;
  std::vector<PerturbedEpisode> all;
  for (int i = 0; i < episodes; ++i) {
    auto [scene, seen] = drawn(scenario)[static_cast<std::size_t>(i)];
    const Instruction right{"u", scenario.commands.front().truth};
    Instruction told = right;
    View view;
    for (const PerturbationAxis* axis : level > 0 ? axes : std::vector<const PerturbationAxis*>())
      if (axis->look) axis->look(view, scene, level, perturbation_stream(axis->id, scene, {}));
    if (view != View()) seen = environment.draw(scene, view);
    for (const PerturbationAxis* axis : level > 0 ? axes : std::vector<const PerturbationAxis*>()) {
      if (axis->perceive) seen = axis->perceive(seen, scenario, level, perturbation_stream(axis->id, scene, {}));
      if (axis->selection_errors) {
        const double p = axis->selection_errors(level);
        told.selection = with_errors(told.selection, scenario, 0, SelectionErrors{p, p},
                                     perturbation_stream(axis->id, scene, {}), environment.goal_type());
      }
    }
    all.push_back({level > 0 ? "perturbed" : "control", i, level > 0 ? axes.front()->id : "", level,
                   parts_of({scene, {}, scene}, seen, &right, &told)});
  }
  return all;
}

// A scenario whose arm "perturbed" has that axis.
Scenario with_axis(const PerturbationAxis& axis) {
  Scenario scenario;
  scenario.tests.resize(1);
  scenario.tests.front().id = "perturbed";
  scenario.tests.front().axes = {&axis};
  return scenario;
}

void expect_as_declared(const PerturbationAxis& axis, int level, const std::string& scenario = "heart") {
  std::vector<PerturbedEpisode> all = played({&axis}, 0, scenario);
  const auto perturbed = played({&axis}, level, scenario);
  all.insert(all.end(), perturbed.begin(), perturbed.end());
  expect_declared(all, {}, false, with_axis(axis));
}

TEST(Perturbations, EveryAxisChangesWhatItDeclaresAndNothingElse) {
  for (const PerturbationAxis& axis : perturbation_axes())
    for (int level = 1; level <= axis.most() && (axis.perceive || axis.look || axis.selection_errors); ++level)
      for (const char* scenario : {"heart", "fetch_fruit"}) {
        SCOPED_TRACE(axis.id + " " + std::to_string(level) + " " + scenario);
        EXPECT_NO_THROW(expect_as_declared(axis, level, scenario));
      }
}

TEST(Perturbations, TheFirstArmIsTheControlAmongSeveral) {
  const PerturbationAxis& axis = *axes_named("light_intensity").front();
  std::vector<PerturbedEpisode> all = played({&axis}, 0);
  for (PerturbedEpisode e : played({}, 0, "red_heart")) {
    e.arm = "other";
    all.push_back(e);
  }
  for (const PerturbedEpisode& e : played({&axis}, 1)) all.push_back(e);
  EXPECT_NO_THROW(expect_declared(all, {}, false, with_axis(axis)));
}

TEST(Perturbations, ADeadAxisIsCaught) {
  const PerturbationAxis dead{
      "dead", {"nothing"}, {EpisodePart::rgb}, {}, [](Observation seen, const Scenario&, int, RandomStream) {
        return seen;
      }};
  EXPECT_SAYS(message_of<EngineError>([&] { expect_as_declared(dead, 1); }),
              "perturbation dead at level 1: rgb equals the control's in 5 of 5 episodes");
}

TEST(Perturbations, ALeakingAxisIsCaught) {
  const PerturbationAxis leaking{
      "leaking", {"too much"}, {EpisodePart::rgb}, {}, [](Observation seen, const Scenario&, int, RandomStream) {
        for (auto& value : seen.rgb) value ^= 1;
        seen.instances.front().texture = "leaked";
        return seen;
      }};
  EXPECT_SAYS(message_of<EngineError>([&] { expect_as_declared(leaking, 1); }),
              "perturbation leaking at level 1: instances differs from the control's in episode 0");
}

TEST(Perturbations, APluginIsAtFaultForItsOwnAxis) {
  PerturbationAxis dead{
      "dead", {"nothing"}, {EpisodePart::rgb}, {}, [](Observation seen, const Scenario&, int, RandomStream) {
        return seen;
      }};
  dead.of_plugin = true;
  EXPECT_SAYS(message_of<MethodError>([&] { expect_as_declared(dead, 1); }),
              "plugin dead (perturbation): perturbation dead at level 1: rgb equals the control's in 5 of 5 episodes");
}

TEST(Perturbations, WhatAPluginMakesOfAPictureIsLookedAt) {
  const Scenario scenario = load_scenario("heart");
  const Observation seen = drawn(scenario).front().seen;
  const auto refusal = [&](const std::function<void(Observation&)>& change) {
    Observation changed = seen;
    change(changed);
    return message_of<MethodError>([&] { expect_perceived(changed, scenario.space); });
  };
  EXPECT_NO_THROW(expect_perceived(seen, scenario.space));
  EXPECT_SAYS(refusal([](Observation& o) { o.ids.front() = 200; }), "ids: 200, expected 0 or the id of an instance");
  EXPECT_SAYS(refusal([](Observation& o) { o.instances.pop_back(); }), "expected 0 or the id of an instance");
  EXPECT_SAYS(refusal([](Observation& o) { o.instances.back().id = o.instances.front().id; }), "expected each once");
  EXPECT_SAYS(refusal([](Observation& o) { o.instances.front().object_type = "ghost"; }), "no object type \"ghost\"");
  EXPECT_SAYS(refusal([](Observation& o) { o.instances.front().texture = "glass"; }), "no texture \"glass\"");
}

TEST(Perturbations, APolicyThatActsOtherwiseOnTheSameInputIsCaught) {
  std::vector<PerturbedEpisode> all = played({}, 0), same = all;
  for (PerturbedEpisode& e : same) e.arm = "perturbed", e.axis = "none", e.level = 1;
  all.insert(all.end(), same.begin(), same.end());
  const PerturbationAxis none{"none", {"nothing"}, {}};
  const Scenario scenario = with_axis(none);
  std::vector<Episode> acted{{"control", 3, 0, "", failure::none, {1., 2.}},
                             {"perturbed", 3, 0, "", failure::none, {1., 2.}}};
  EXPECT_NO_THROW(expect_declared(all, acted, true, scenario));
  acted.back().action.back() += 1e-12;
  EXPECT_SAYS(message_of<MethodError>([&] { expect_declared(all, acted, true, scenario); }),
              "in episode 3 of perturbed");
  EXPECT_NO_THROW(expect_declared(all, acted, false, scenario)) << "reference rows may look at more than their input";
}

TEST(Perturbations, AreComparedWithTheFirstArmAndNoOtherWithout) {
  const PerturbationAxis none{"none", {"nothing"}, {}};
  std::vector<PerturbedEpisode> all = played({}, 0), other = all, same = all;
  for (PerturbedEpisode& e : other) e.arm = "hard", e.hashes.fill("0");
  for (PerturbedEpisode& e : same) e.arm = "perturbed", e.axis = "none", e.level = 1;
  for (const auto& more : {other, same}) all.insert(all.end(), more.begin(), more.end());
  EXPECT_NO_THROW(expect_declared(all, {}, true, with_axis(none)));
}

// How far a picture, and a segmentation, lie from the control's: the size of a change grows with the level.
TEST(Perturbations, LevelsAreNested) {
  const Scenario scenario = load_scenario("heart");
  for (const PerturbationAxis& axis : perturbation_axes()) {
    if (!axis.perceive) continue;
    for (const auto& [scene, control] : drawn(scenario)) {
      double before = 0;
      std::vector<std::uint8_t> missed_before;
      for (int level = 1; level <= axis.most(); ++level) {
        const Observation seen = axis.perceive(control, scenario, level, perturbation_stream(axis.id, scene, {}));
        EXPECT_EQ(seen.rgb, axis.perceive(control, scenario, level, perturbation_stream(axis.id, scene, {})).rgb);
        double distance = 0;
        for (std::size_t p = 0; p < seen.rgb.size(); ++p) distance += std::abs(seen.rgb[p] - control.rgb[p]);
        if (axis.id == "segmentation") {
          EXPECT_EQ(seen.rgb, control.rgb);
          for (const std::uint8_t id : missed_before)
            EXPECT_TRUE(
                std::none_of(seen.instances.begin(), seen.instances.end(), [id](auto& o) { return o.id == id; }));
          missed_before.clear();
          for (const Instance& one : control.instances)
            if (std::none_of(seen.instances.begin(), seen.instances.end(), [&](auto& o) { return o.id == one.id; }))
              missed_before.push_back(one.id);
        } else {
          EXPECT_GT(distance, before) << axis.id << " " << level << " " << scene.index;
        }
        before = distance;
      }
    }
  }
}

// Which level each demonstration was seen at, by the speckle that it has.
TEST(TrainOn, DrawsOnceForEachDemonstrationAndNotAsTestsDo) {
  const Scenario scenario = load_scenario("heart");
  std::vector<Scene> scenes;
  std::vector<Demonstration> shown;
  for (const auto& [scene, seen] : drawn(scenario)) {
    scenes.push_back(scene);
    shown.push_back({{}, {{seen, {}}}, {{seen, {}}}});
  }
  const auto through = [&](std::optional<int> level) {
    return perceived(shown, scenes, scenario, {"sensor_noise", level});
  };
  const auto any = through({}), again = through({});
  std::vector<std::vector<Demonstration>> at{shown};
  for (int level = 1; level <= 4; ++level) at.push_back(through(level));
  std::set<int> levels;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const auto rgb = [i](const std::vector<Demonstration>& all) { return all[i].steps[0].observation.rgb; };
    EXPECT_EQ(rgb(any), rgb(again));
    EXPECT_EQ(rgb(any), any[i].recovery[0].observation.rgb) << "its recovery steps too";
    for (int level = 1; level <= 4; ++level)
      if (rgb(any) == rgb(at[static_cast<std::size_t>(level)])) levels.insert(level);
    const PerturbationAxis& axis = *axes_named("sensor_noise").front();
    EXPECT_NE(
        rgb(at[2]),
        axis.perceive(shown[i].steps[0].observation, scenario, 2, perturbation_stream(axis.id, scenes[i], {})).rgb);
    EXPECT_NE(rgb(at[2]), rgb(at[0]));
  }
  EXPECT_GT(levels.size(), 1u) << "of " << shown.size() << " demonstrations";
}

std::string refusal(const Json& perturbation) {
  Json json = load_scenario("heart").json;
  json["tests"].push_back(json["tests"].front());
  json["tests"].back().update({{"arm", "other"}, {"perturbation", perturbation}});
  return message_of<InputError>([&] { read_scenario(json, "mine.json"); });
}

TEST(Perturbations, WhatThereIsNotIsRefusedInOneLine) {
  EXPECT_SAYS(refusal({{"light_color", 1}}),
              "/tests/1/perturbation: no axis \"light_color\" (did you mean \"light_colour\"?)");
  EXPECT_SAYS(refusal({{"moon", 1}}),
              "/tests/1/perturbation: no axis \"moon\", expected one of: distractors, object_size, friction_mass, "
              "paraphrase, instruction, light_intensity");
  EXPECT_SAYS(refusal({{"light_colour", 5}}),
              "/tests/1/perturbation/light_colour: expected a level from 1 to 4 (10 %; 20 %");
  EXPECT_SAYS(refusal({{"all", 0}}), "/tests/1/perturbation/all: expected a level from 1 to 4");
  EXPECT_SAYS(refusal({{"light_colour", 1}, {"sensor_noise", 1}}),
              "expected an object with one axis and its level (two at once: all)");
  Json json = load_scenario("heart").json;
  json["tests"].push_back({{"arm", "other"}, {"distractors", {2, 2}}, {"perturbation", {{"all", 1}}}});
  EXPECT_SAYS(message_of<InputError>([&] { read_scenario(json, "mine.json"); }),
              "the other members of the first arm, its control");
}

TEST(Perturbations, AScenarioCarriesWhatThePluginsOfItsArmsDeclare) {
  const Json declared{{"version", "0.2"}, {"levels", {"thin", "thick"}}, {"changes", {"rgb"}}, {"may_change", {"ids"}}};
  Json json = load_scenario("heart").json;
  json["tests"].push_back(json["tests"].front());
  json["tests"].back().update({{"arm", "fog_2"}, {"perturbation", {{"fog", 2}}}});
  json["axes"] = {{"fog", declared}, {"rain", declared}};
  const Scenario scenario = read_scenario(json, "mine.json");
  ASSERT_EQ(scenario.axes.size(), 1u) << "rain is of no arm";
  EXPECT_EQ(scenario.json.at("axes"), Json({{"fog", declared}}));
  const PerturbationAxis& fog = *axes_of(scenario, *scenario.arm("fog_2").perturbation).front();
  EXPECT_TRUE(fog.of_plugin && fog.touches(EpisodePart::ids) && fog.touches(EpisodePart::input));
  EXPECT_FALSE(fog.touches(EpisodePart::instances) || fog.touches(EpisodePart::objects));
  EXPECT_SAYS(message_of<InputError>([&] { fog.perceive({}, scenario, 1, RandomStream("x")); }),
              "perturbation fog: its plugin runs only in the cells of a run");
  EXPECT_EQ(axes_of(scenario, {"all", 1}), axes_of(load_scenario("heart"), {"all", 1})) << "which all does without";
  json["axes"]["fog"]["changes"] = {"words"};
  EXPECT_SAYS(message_of<InputError>([&] { read_scenario(json, "mine.json"); }),
              "mine.json: /axes/fog/changes/0: expected rgb, ids or instances");
  json["axes"]["fog"] = declared;
  json["tests"].back()["perturbation"]["fog"] = 3;
  EXPECT_SAYS(message_of<InputError>([&] { read_scenario(json, "mine.json"); }), "a level from 1 to 2 (thin; thick)");
  json.erase("axes");
  EXPECT_SAYS(message_of<InputError>([&] { read_scenario(json, "mine.json"); }), "no axis \"fog\"");
  PerturbationAxis taken{"table", {"a"}, {EpisodePart::rgb}};
  EXPECT_SAYS(message_of<InputError>([&] { add_plugin_axis(taken); }), "an axis has that id already");
}

TEST(Perturbations, ASuiteNamesThemInALineEach) {
  const Suite suite = load_suite("perturbations");
  const Scenario whole = suite_scenario(suite, "heart", Truth::released);
  EXPECT_EQ(whole.tests.size(), 1 + (perturbation_ids().size() - 1) * 4) << "but instruction, of another preset";
  EXPECT_EQ(whole.tests[1].id, "distractors_1");
  const Design smoke = preset_design(suite, "smoke");
  const Scenario small = suite_scenario(suite, "heart", Truth::released, &smoke);
  EXPECT_EQ(small.tests.size(), 1u + 7 * 2);
  const Scene control = test_scene(whole, "continuous", "control", 0, 5),
              other = test_scene(whole, "continuous", "light_colour_4", 0, 5);
  EXPECT_EQ(to_json(control)["objects"], to_json(other)["objects"]);
  EXPECT_FALSE(to_json(load_suite("q1").design).contains("perturbations")) << "other suites stay as they are";
}

// A world of several commands with all levels of the axis, as the preset has it.
Scenario instructed_world(const std::string& id = "many_hearts") {
  const Suite suite = load_suite("perturbations");
  const Design design = preset_design(suite, "instruction");
  return suite_scenario(suite, id, Truth::released, &design);
}

const ScenarioCommand& given(const Scenario& scenario, const Scene& scene) {
  return scenario.commands.at(static_cast<std::size_t>(command_given(scene, scenario, {})));
}

bool in_view(const Scene& scene, const ScenarioCommand& command, bool target) {
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const SceneObject& object) {
    return object.role != role::goal && (object.role == role::target) == target && means(command, object);
  });
}

TEST(Instruction, GivesOtherWordsInTheControlsScenes) {
  for (const char* world : {"many_hearts", "many_vessels", "many_letters", "many_vowels"}) {
    const Scenario scenario = instructed_world(world);
    ASSERT_EQ(scenario.tests.size(), 4u);
    std::set<std::string> others;
    for (int i = 0; i < 40; ++i) {
      SCOPED_TRACE(fmt::format("{} {}", world, i));
      const auto scene = [&](int level) {
        const std::string arm = level == 0 ? "control" : arm_of({"instruction", level});
        return test_scene(scenario, "continuous", arm, 0, i);
      };
      const Scene control = scene(0);
      for (int level = 1; level <= 3; ++level) {
        EXPECT_EQ(to_json(scene(level))["objects"], to_json(control)["objects"]);
        EXPECT_EQ(scene(level).command, control.command);
      }
      EXPECT_EQ(command_given(control, scenario, {}), control.command);
      EXPECT_EQ(given(scenario, scene(1)).utterance, "");
      EXPECT_EQ(given(scenario, scene(2)).arm, "instruction_2");
      const ScenarioCommand& other = given(scenario, scene(3));
      EXPECT_TRUE(other.seen && other.arm.empty());
      EXPECT_TRUE(in_view(control, other, false)) << other.utterance;
      EXPECT_FALSE(in_view(control, other, true)) << other.utterance;
      others.insert(other.utterance);
    }
    EXPECT_GT(others.size(), 4u) << "each of several commands is the other one";
  }
}

TEST(Instruction, NonsenseCanBeReadAloudAndHoldsNoWordOfTheWorlds) {
  const Scenario scenario = instructed_world();
  std::string known;
  for (const auto* names : {&scenario.space.object_types, &scenario.space.textures})
    for (const std::string& name : *names) known += " " + name;
  std::set<std::string> sentences;
  for (const ScenarioCommand& command : scenario.commands)
    if (command.arm.empty())
      known += " " + command.utterance;
    else if (command.arm == "instruction_2")
      sentences.insert(command.utterance);
  EXPECT_EQ(sentences.size(), 8u);
  for (const std::string& sentence : sentences) {
    EXPECT_TRUE(std::regex_match(sentence, std::regex("[A-Z][a-z]+( [a-z]+){3}\\."))) << sentence;
    std::string lower = sentence.substr(0, sentence.size() - 1);
    lower.front() = static_cast<char>(std::tolower(lower.front()));
    std::istringstream words(lower);
    for (std::string word; words >> word;) {
      EXPECT_TRUE(std::regex_match(word, std::regex("([^aeiou][aeiou]){3}[^aeiou]"))) << word;
      EXPECT_EQ(known.find(word), std::string::npos) << word;
    }
  }
}

TEST(Instruction, IsAnsweredByItsWordsAloneAndWrittenOnce) {
  const Scenario scenario = instructed_world();
  EXPECT_EQ(scenario.answers_of, "");
  EXPECT_EQ(read_scenario(scenario.json, "again.json").json, scenario.json);
  RecordedLanguageModel lm(scenario, scenario.recorded);
  for (std::size_t i = 0; i < scenario.commands.size(); ++i)
    EXPECT_TRUE(lm.knows(scenario.command(static_cast<int>(i)))) << scenario.commands[i].utterance;
  EXPECT_FALSE(load_scenario("many_hearts").answers_of.empty()) << "without the axis";
}

TEST(Instruction, IsRefusedWhereNoOtherCommandIsDemonstratedAndIsNotOfAll) {
  EXPECT_SAYS(refusal({{"instruction", 1}}),
              "/tests/1/perturbation: instruction: expected several commands that are demonstrated");
  for (const PerturbationAxis* axis : axes_named("all")) EXPECT_NE(axis->id, "instruction");
  EXPECT_EQ(instructing_axis(load_scenario("many_hearts")), nullptr);
}

}  // namespace
}  // namespace lgabench

#include <lgabench/cli/run_plan.hpp>

#include <fmt/format.h>

#include <set>

#include <lgabench/abstraction/asked_model.hpp>
#include <lgabench/abstraction/cassette.hpp>
#include <lgabench/abstraction/openai_options.hpp>
#include <lgabench/abstraction/prompt.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/cli/cache.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/shell.hpp>
#include <lgabench/core/suggest.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/host/python_method.hpp>

namespace lgabench::cli {
namespace {

// 0,1,2 or 0:3 (without its end). @throws InputError for anything else, which names the option.
Json numbers(const char* option, const Words& words) {
  Json all = Json::array();
  for (const std::string& word : words) {
    const std::size_t colon = word.find(':');
    const Json first = option_value(word.substr(0, colon)),
               last = colon == std::string::npos ? Json() : option_value(word.substr(colon + 1));
    const bool is_range = first.is_number_unsigned() && last.is_number_unsigned();
    if (!is_range && (!first.is_number_integer() || colon != std::string::npos))
      throw InputError(fmt::format(
          "{}: expected whole numbers, such as 10,50, or a range, such as 0:3 for 0,1,2; got \"{}\"", option, word));
    if (!is_range) {
      all.push_back(first);
      continue;
    }
    constexpr std::uint64_t most = 10000;
    const auto begin = first.get<std::uint64_t>(), end = last.get<std::uint64_t>();
    if (begin >= end || end - begin > most)
      throw InputError(fmt::format("{}: expected FIRST:END, END not included, with 1 to {} numbers; {} has {}", option,
                                   most, word, begin < end ? end - begin : 0));
    for (auto n = begin; n < end; ++n) all.push_back(n);
  }
  return all;
}

// "none", or "added=0.1+missing=0.2" in either order or one of them alone, as an object.
Json selection_errors(const std::string& words) {
  Json errors = Json::object();
  if (words == "none") return errors;
  for (const std::string& word : row_words(words)) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const Json p = equals == std::string::npos ? Json() : option_value(word.substr(equals + 1));
    if ((name != "missing" && name != "added") || !p.is_number() || errors.contains(name))
      throw InputError(
          fmt::format("--selection-errors: expected none, missing=P, added=P or added=P+missing=P, several with "
                      "commas; got \"{}\"",
                      words));
    errors[name] = p;
  }
  return errors;
}

// "AXIS:LEVEL" or "AXIS:any", as an object.
Json train_on(const std::string& words) {
  const std::size_t colon = words.find(':');
  const std::string level = colon == std::string::npos ? "" : words.substr(colon + 1);
  const Json number = option_value(level);
  if (colon == 0 || (level != "any" && !number.is_number_integer()))
    throw InputError(
        fmt::format("--train-on: expected AXIS:LEVEL or AXIS:any, such as sensor_noise:2; got \"{}\"", words));
  return {{words.substr(0, colon), level == "any" ? Json(level) : number}};
}

// Of "AXIS" or "AXIS:LEVEL+LEVEL" each. Which there are is known once scenarios are read.
std::vector<DesignAxis> played_axes(const Words& words) {
  std::vector<DesignAxis> all;
  for (const std::string& word : words) {
    const std::size_t colon = word.find(':');
    DesignAxis& axis = all.emplace_back(DesignAxis{word.substr(0, colon), {}});
    if (colon == std::string::npos) continue;
    for (const std::string& text : items_of(word.substr(colon + 1), '+')) {
      const std::optional<int> level = number_of<int>(text);
      if (!level || contains(axis.levels, *level))
        throw InputError(fmt::format(
            "--axes: expected AXIS or AXIS:LEVEL+LEVEL, each level once, such as camera_turn:1+4; got \"{}\"", word));
      axis.levels.push_back(*level);
    }
  }
  return all;
}

constexpr const char* command_line_place = "command line";

// "--demos: expected each value once" for "command line: /demonstrations/1: expected each value once".
std::string by_option(const std::string& complaint) {
  for (const auto& [member, option] : {std::pair{"methods", "--methods"},
                                       {"engines", "--engines"},
                                       {"scenarios", "--scenarios"},
                                       {"layouts", "--layout"},
                                       {"demonstrations", "--demos"},
                                       {"seeds", "--seeds"},
                                       {"selection_errors", "--selection-errors"},
                                       {"train_on", "--train-on"},
                                       {"names", "--names"},
                                       {"segments", "--segments"},
                                       {"episodes", "--episodes"},
                                       {"scene_seed", "--scene-seed"}})
    if (complaint.rfind(fmt::format("{}: /{}", command_line_place, member), 0) == 0)
      return option + complaint.substr(complaint.find(": ", complaint.find('/')));
  return complaint;
}

// A layout that neither the suite nor lgabench's own environments have: the suite's are offered.
void expect_layouts(const Suite& suite, const Words& layouts) {
  std::set<std::string> offered;
  for (const std::string& id : suite.design.scenarios)
    for (const std::string& layout : layouts_of(load_scenario(id))) offered.insert(layout);
  const Words all = installed_layouts();
  for (const std::string& layout : layouts)
    if (!contains(all, layout) && offered.count(layout) == 0)
      throw InputError("--layout: " + none_named("layout", layout, {offered.begin(), offered.end()}));
}

// A preset with a scene seed of its own is one of the board's.
bool is_boards(const Suite& suite, const std::string& preset) {
  return !preset.empty() && suite.presets.at(preset).contains("scene_seed");
}

// The command line's part of the design, checked by the same reader as a suite's file.
Design design_of(const RunArguments& a, const Suite& suite) {
  Json overrides = Json::object();
  const auto give = [&overrides](const char* member, const Words& words) {
    if (!words.empty()) overrides[member] = words;
  };
  give("methods", a.methods);
  give("engines", a.engines);
  give("scenarios", a.scenarios);
  expect_layouts(suite, a.layouts);
  give("layouts", a.layouts);
  if (!a.demonstrations.empty()) overrides["demonstrations"] = numbers("--demos", a.demonstrations);
  if (!a.seeds.empty()) overrides["seeds"] = numbers("--seeds", a.seeds);
  for (const std::string& words : a.selection_errors) overrides["selection_errors"].push_back(selection_errors(words));
  if (!a.train_on.empty()) overrides["train_on"] = train_on(a.train_on);
  give("names", a.names);
  give("segments", a.segments);
  if (a.episodes) overrides["episodes"] = *a.episodes;
  Design design = preset_design(suite, a.preset);
  if (a.scene_seed) {
    if (is_boards(suite, a.preset))
      throw InputError(fmt::format(
          "--scene-seed: preset {} of {} is the leaderboard's, whose rows share their scenes; without --preset the "
          "suite is played, on any scenes",
          a.preset, suite.id));
    overrides["scene_seed"] = *a.scene_seed;
  }
  try {
    design = apply(JsonReader(overrides, command_line_place), design);
  } catch (const InputError& e) {
    throw InputError(by_option(e.what()));
  }
  design.smoke |= a.limit != 0;
  return design;
}

// --set method.option=value, or *.option=value
Json options_of(const Words& settings) {
  Json options = Json::object();
  for (const std::string& setting : settings) {
    const std::size_t dot = setting.find('.'), equals = setting.find('=');
    if (dot == std::string::npos || equals == std::string::npos || dot > equals)
      throw InputError(fmt::format("--set {}: expected method.option=value or *.option=value", setting));
    options[setting.substr(0, dot)][setting.substr(dot + 1, equals - dot - 1)] =
        option_value(setting.substr(equals + 1));
  }
  return options;
}

Json participant_hashes(const std::vector<Participant>& participants) {
  Json hashes = Json::object();
  for (const Participant& one : participants) hashes[one.id] = one.sha256;
  return hashes;
}

// The server's model that --answers openai asks, and how; none for other answers, which need no server. `answers` is
// what cells say of it.
std::optional<LiveModel> live_model(const RunArguments& a, AnswerSource& answers, Json& about) {
  if (!std::holds_alternative<LiveAnswers>(answers)) {
    if (!a.model.empty() || !a.cassette.empty() || a.max_queries >= 0 || !a.request.empty() || !a.prompt.empty() ||
        a.reply_timeout_s != OpenAiOptions().timeout_s || a.concurrency != LiveModel().concurrency || a.any_served)
      throw InputError(
          "--model, --cassette, --max-queries, --request, --prompt, --reply-timeout, --concurrency and --any-served: "
          "expected --answers openai with them");
    return std::nullopt;
  }
  if (a.model.empty() || a.cassette.empty() || one_line(a.model) != a.model)
    throw InputError("--answers openai: expected --model MODEL and --cassette FILE too");
  const std::string prompt = read_prompt(a.prompt);
  Cassette(a.cassette).expect_prompt(prompt);
  const AskedModel model = asked_model(a.model, a.request, prompt);
  answers = LiveAnswers{to_text(model)};
  about = {{"model", to_text(model)},
           {"provider", provider(openai_from_environment())},
           {"prompt", PromptTemplate::of_text(prompt).version()}};
  return LiveModel{a.cassette, true, a.max_queries, a.reply_timeout_s, a.concurrency, a.any_served, prompt};
}

// Where --resume goes on: where the run would be, or was with another build. It begins none.
fs::path run_to_resume(const RunPlan& plan, const std::string& suffix) {
  const fs::path previous_run = is_run(plan.out) ? plan.out : earlier_run(plan.out, suffix, plan.request);
  if (previous_run.empty())
    throw InputError(
        fmt::format("--resume: no run of this command is in {}; without --resume a new run of {} cells begins",
                    plan.out.parent_path().string(), plan.cells.size()));
  to_stderr("resuming the run in {}\n", previous_run.string());
  return previous_run;
}

}  // namespace

PlannedRun plan_run(RunArguments a) {
  PlannedRun planned;
  Catalogue& catalogue = planned.catalogue;
  catalogue = plugins_at(a.plugin_path, a.python);
  for (std::string& word : a.methods) word = with_python_method(word, a.python, catalogue);
  const Suite suite = load_suite(a.suite);
  const Design design = design_of(a, suite);
  Variation variation{read_answer_source(a.answers), options_of(a.settings), !a.no_reference, read_truth(a.truth)};

  if (!a.axes.empty() || !a.arms.empty()) variation.played = PlayedArms{played_axes(a.axes), a.arms};

  RunPlan& plan = planned.plan;
  plan.live = live_model(a, variation.answers, plan.live_about);
  if (auto* cassette = std::get_if<CassetteAnswers>(&variation.answers)) {
    plan.answers.push_back(check_cassette(cassette->file, design.scenarios));
    cassette->file = fs::path(plan.answers.back().name).stem();
  } else if (auto* written = std::get_if<FileAnswers>(&variation.answers)) {
    plan.answers.push_back(check_written(written->file, design.scenarios));
    written->file = fs::path(plan.answers.back().name).stem();
  } else if (const auto* recorded = std::get_if<RecordedAnswers>(&variation.answers)) {
    check_recorded(*recorded, design.scenarios);
  }
  if (a.rehearsal && a.humans.empty()) throw InputError("--rehearsal: expected --humans DIR with it");
  if (!a.humans.empty())
    for (AnswerFile& file : read_participants(a.humans, a.rehearsal, variation.participants))
      plan.answers.push_back(std::move(file));
  plan.shard = read_shard(a.shard);
  plan.cells = expand(suite, design, variation, catalogue);
  if (a.limit != 0 && plan.cells.size() > static_cast<std::size_t>(a.limit))
    plan.cells.resize(static_cast<std::size_t>(a.limit));
  if (!plan.live && !std::holds_alternative<NoAnswers>(variation.answers))
    if (const LackingAnswers lacking = lacking_answers(plan.cells, catalogue, variation.answers,
                                                       plan.answers.empty() ? fs::path() : plan.answers[0].path);
        !lacking.rows.empty())
      throw InputError(fmt::format("{}: {} (scenarios that lack this: {})", fmt::join(lacking.rows, ", "),
                                   lacking.reason, some_of(lacking.scenarios)));
  plan.about = suite.about;
  plan.claims = suite.claims;
  plan.request = to_json(design);
  plan.request.update({{"suite", suite.id},
                       {"preset", a.preset},
                       {"answers", to_string(variation.answers)},
                       {"truth", a.truth},
                       {"participants", participant_hashes(variation.participants)},
                       {"set", variation.options},
                       {"references", variation.references},
                       {"limit", a.limit}});
  if (variation.played) plan.request["played"] = to_json(*variation.played);
  plan.command = shell_line(command_line());
  plan.program = a.program;
  plan.out = a.out;
  if (a.out.empty()) {
    const std::string suffix = plan.shard.count == 1 ? "" : fmt::format("-{}of{}", plan.shard.index, plan.shard.count);
    plan.out = fs::path("runs") / fmt::format("{}{}-{}{}", suite.id, a.preset.empty() ? "" : "-" + a.preset,
                                              run_hash(plan.cells, catalogue), suffix);
    if (a.resume) plan.out = run_to_resume(plan, suffix);
  }
  plan.cache = a.cache.empty() ? default_cache() : fs::path(a.cache);
  plan.existing = a.fresh ? Existing::fresh : a.resume ? Existing::resume : Existing::same;
  plan.pool.jobs = jobs_of(a.jobs);
  plan.pool.timeout_s = a.timeout_s;
  plan.pool.memory_gib = a.memory_gib;
  plan.confined = !a.unconfined;
  plan.keeps_policies = a.keep_policy;
  plan.quiet = a.quiet;
  plan.strangers = is_boards(suite, a.preset) ? Strangers::told_nothing : Strangers::told_afterwards;
  return planned;
}

void add_run_options(Verb& verb, RunArguments& a) {
  verb.option("suite SUITE", a.suite, "A suite's id, or a .json file of one", required);
  verb.below("What is computed");
  verb.option("--preset PRESET", a.preset,
              "One of the suite's presets, which `lgabench list presets --of SUITE` prints; paper: the suite as it is");
  verb.option(
      "--methods METHOD,...", a.methods,
      "Methods, by plugin id or as FILE.py:Class; ID+OPTION=VALUE+OPTION=VALUE for a variant; selected_by:METHOD to "
      "use only METHOD's Selections, while the shipped lga+policy=heat_map learns and acts");
  verb.option("--engines ENGINE,...", a.engines, "Engines, by plugin id");
  verb.option("--scenarios SCENARIO,...", a.scenarios, "Scenarios");
  verb.option("--axes AXIS,...", a.axes, "Play only these axes and the control; AXIS:LEVEL+LEVEL: some levels");
  verb.option("--arms ARM,...", a.arms, "Play only these arms (lgabench list arms) and each scenario's first");
  verb.option("--layout LAYOUT,...", a.layouts,
              "How objects are placed: `lgabench list layouts --of SUITE`; separate several with commas", rare);
  verb.option("--demos N,...", a.demonstrations, "Numbers of demonstrations per seen command, such as 10,20");
  verb.option("--seeds N,...", a.seeds, "Training seeds, such as 0,1,2 or 0:3");
  verb.option(
      "--selection-errors KIND=P,...", a.selection_errors,
      "Errors to make in the methods' Selections: missing=P drops each true feature with probability P, added=P adds "
      "each wrong one, added=P+missing=P does both; none",
      rare);
  verb.option("--train-on AXIS", a.train_on,
              "Show methods their demonstrations through a perturbation axis: AXIS:LEVEL, or AXIS:any for a level "
              "drawn for each demonstration; not for the leaderboard",
              rare);
  verb.option("--names SOURCE,...", a.names,
              "The source of the object names that methods see: simulator; read: read from the picture as it is; "
              "read_balanced: without its light; read_drawn: by a reader that learned from drawn light, noise and "
              "distance; read_robust: both; or a perceiver plugin's id",
              rare);
  verb.option("--segments SOURCE,...", a.segments,
              "The source of the segments that methods see: simulator; difference: from the empty place", rare);
  verb.option("--episodes N", a.episodes, "Test scenes per arm");
  verb.option("--scene-seed N", a.scene_seed,
              "Draw other test scenes, from this seed; demonstrations follow --seeds. Not for presets of the "
              "leaderboard",
              a_seed(), rare);
  verb.option("--set M.OPTION=VALUE", a.settings,
              "Set METHOD.OPTION, or *.OPTION for every method that has the option; this overrides the preset's value, "
              "not a row's own; can be repeated");
  verb.option(
      "--answers SOURCE", a.answers,
      "Where a language model's answers come from. recorded: each scenario's recorded answers (lgabench "
      "info SCENARIO); another name from lgabench list sources: only that source; cassette:FILE: a "
      "server's replies, recorded by lgabench select --suite; FILE.json: your own answers (docs/formats); "
      "openai: a server, asked during the run; none: no answers, for methods that ask no language model",
      [](const std::string& word) { return answers_complaint(word, true); }, with_default);
  verb.option("--model MODEL", a.model, "With --answers openai: the server's model", rare);
  verb.option("--cassette FILE", a.cassette,
              "With --answers openai: the file to append replies to; runs may share it, and questions that it "
              "answers are not asked again",
              rare);
  verb.option("--max-queries N", a.max_queries,
              "With --answers openai: the most questions that a cell may ask the server; -1: no limit",
              CLI::Range(-1, 1000000), with_default, rare);
  add_server(verb, a.request, a.reply_timeout_s, a.any_served, rare);
  add_prompt(verb, a.prompt, rare);
  verb.option("--concurrency N", a.concurrency, "With --answers openai: how many questions to ask at once",
              CLI::Range(1, 64), with_default, rare);
  verb.option("--truth released|printed", a.truth,
              "Which true distributions to use where they differ: those released with the paper's code, or those "
              "printed in its appendix",
              one_of("truth", {"released", "printed"}), with_default, rare);
  verb.option("--humans DIR", a.humans,
              "A directory of participants' .json files; methods that ask people then get a cell for each participant",
              rare);
  verb.option("--rehearsal", a.rehearsal,
              "With --humans: accept files from a rehearsal or from simulated people; the run, its tables and claims "
              "are marked, and the leaderboard does not take it",
              rare);
  verb.option("--no-reference", a.no_reference,
              "Leave out the reference rows: those of every suite, and the suite's own (lgabench list rows)", rare);
  verb.below("How cells are computed");
  add_pool(verb, a.jobs, a.timeout_s, rare);
  verb.option("--memory GIB", a.memory_gib,
              "Memory limit of a cell, in GiB (default: its share of the job's memory, at least 4 where it has them)",
              within(.1, 1e6), rare);
  add_python(verb, a.python, rare);
  add_plugin_path(verb, a.plugin_path, any_plugin);
  add_scenario_path(verb);
  verb.option("--unconfined", a.unconfined,
              "Do not confine methods: they then run as you, with access to your files (docs/trust.md); not for the "
              "leaderboard",
              rare);
  verb.below("How much is computed");
  verb.option("--shard I/N", a.shard, "Compute only part I of N of the cells; lgabench merge combines the parts", rare);
  auto* resume = verb.option("--resume", a.resume,
                             "Continue the run in --out or, without --out, the earlier run of the same command; "
                             "recompute cells of another build");
  verb.option("--fresh", a.fresh, "Delete the run in --out first", rare)->excludes(resume);
  verb.option("--limit N", a.limit, "Compute only the first N cells; not for the leaderboard", CLI::Range(1, 1 << 30),
              rare);
  verb.option(
      "--debug KEY", a.debug,
      "Compute one cell in the foreground and unconfined: a plugin under gdb, Python with breakpoint() working; "
      "results are not kept. KEY: the first digits of the cell's key (--debug list prints all keys)",
      rare);
  verb.option("--dry-run", a.dry_run, "Compute nothing; print the run's cells, hours and bytes");
  verb.below("Output");
  verb.option("--out DIR", a.out, "Run directory (default: runs/SUITE-PRESET-HASH, with -IofN appended for a shard)");
  verb.option("--cache DIR", a.cache,
              "The folder of kept demonstrations (default: $LGABENCH_CACHE, else ~/.cache/lgabench)", rare);
  verb.option("--keep-policy", a.keep_policy,
              "Keep the policy that each computed cell learned in its file policy.bin, for lgabench.load_policy() of "
              "the Python package; if a method cannot be saved, its cell's log says so",
              rare);
  auto* json = verb.option("--json", a.json, "Print summary.json instead of the means");
  verb.option("--tables", a.tables, "Print every table of the report instead of the means")->excludes(json);
  verb.option("--quiet", a.quiet, "Print only the table of means, and no progress");
}

}  // namespace lgabench::cli

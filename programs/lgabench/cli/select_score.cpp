#include <lgabench/cli/select_score.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <vector>

#include <lgabench/abstraction/best_product.hpp>
#include <lgabench/abstraction/chat_model.hpp>
#include <lgabench/abstraction/scene_score.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/cli/open_questions.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/rounding.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/counted_progress.hpp>
#include <lgabench/harness/suite_scenario.hpp>
#include <lgabench/statistics/statistics.hpp>

namespace lgabench::cli {
namespace {

constexpr const char* ways_of_asking[] = {"flat", "structured", "named"};

// Of one command, or summed over a group of them.
struct Row {
  std::string group, asking;
  SceneScore score;
  int questions = 0, otherwise = 0;  // otherwise: commands for which something else was selected than for the first
  int unanswered = 0;                // commands that are in nothing else here

  void add(const Row& other) {
    score += other.score;
    questions += other.questions;
    otherwise += other.otherwise;
    unanswered += other.unanswered;
  }
};

using Groups = std::vector<std::pair<std::string, std::vector<std::string>>>;  // name, scenarios

struct ScoredCommand {
  std::string scenario, arm;  // arm: the one that gives it, where the scenario's commands name arms; else ""
  std::string title;          // for a reader
  bool ambiguous = false;
  Row row;
};

// Of one way of asking.
struct Scores {
  std::vector<ScoredCommand> commands;
  std::vector<std::string> sources;
  OpenQuestions open;
};

std::string title_of(const Scenario& scenario, const ScenarioCommand& command, const std::string& arm) {
  if (!arm.empty()) return scenario.id + ", " + arm;
  return scenario.commands.size() == 1 ? scenario.id : fmt::format("{}, \"{}\"", scenario.id, command.utterance);
}

// The arm that gives the command, where they name arms.
std::string arm_of(const Scenario& scenario, int command) {
  const auto names = [](const ScenarioCommand& one) { return !one.arm.empty(); };
  if (std::none_of(scenario.commands.begin(), scenario.commands.end(), names)) return "";
  for (const Arm& arm : scenario.tests) {
    const std::vector<int> given = scenario.commands_of(arm.id);
    if (contains(given, command)) return arm.id;
  }
  return "";
}

int commands_of(const Suite& suite, Truth truth) {
  std::size_t commands = 0;
  for (const std::string& id : suite_scenario_ids(suite, suite.design))
    commands += suite_scenario(suite, id, truth).commands.size();
  return static_cast<int>(commands);
}

Scores scores_of(const std::string& asking, const Suite& suite, Truth truth, int scenes,
                 const WithAnswers& with_answers, CountedProgress& progress) {
  Scores all;
  for (const std::string& id : suite_scenario_ids(suite, suite.design)) {
    const Scenario scenario = suite_scenario(suite, id, truth);
    with_answers(scenario, [&](LanguageModel& model) {
      Json first;
      for (int i = 0; i < static_cast<int>(scenario.commands.size()); ++i) {
        const ScenarioCommand& command = scenario.commands[static_cast<std::size_t>(i)];
        const std::string arm = arm_of(scenario, i);
        ScoredCommand& scored = all.commands.emplace_back(
            ScoredCommand{id, arm, title_of(scenario, command, arm), command.ambiguous, {"", asking, {}}});
        progress.tell_next();
        const auto selection =
            all.open.answered([&] { return select_as_asked(asking, scenario.command(i), scenario.space, model); });
        if (!selection) {
          scored.row.unanswered = 1;
          continue;
        }
        add_source(selection->source, all.sources);
        const Json kept = distribution_json(*selection);
        if (first.is_null()) first = kept;
        scored.row.score =
            score(scenario, i, *selection, suite.design.layouts.front(), suite.design.scene_seed, scenes);
        scored.row.questions = selection->cost.lm_queries;
        scored.row.otherwise = kept == first ? 0 : 1;
      }
    });
  }
  return all;
}

// A command behind whose words stands a preference, and whether the hypotheses on it hold the truth: none where there
// is no answer.
struct Covered {
  std::string scenario, name;
  std::optional<bool> holds_truth;
};

// Those on which there are no hypotheses are left out.
std::vector<Covered> coverage_of(const Suite& suite, Truth truth, const WithAnswers& with_answers,
                                 OpenQuestions& open) {
  std::vector<Covered> all;
  for (const std::string& id : suite_scenario_ids(suite, suite.design)) {
    const Scenario scenario = suite_scenario(suite, id, truth);
    const bool of_persons = scenario.json.contains("persons");
    if (!of_persons && !scenario.json.contains("words")) continue;
    with_answers(scenario, [&](LanguageModel& model) {
      for (int i = 0; i < (of_persons ? static_cast<int>(scenario.commands.size()) : 1); ++i) {
        const Command command = scenario.command(i);
        const auto hypotheses = open.answered([&] { return model.hypotheses(command, scenario.space); });
        if (hypotheses && hypotheses->empty()) continue;
        Covered& one = all.emplace_back(Covered{id, of_persons ? command.utterance : id, {}});
        if (hypotheses) one.holds_truth = covers_truth(*hypotheses, scenario, i);
      }
    });
  }
  return all;
}

// A row for each group with such commands, or a line for all of them.
void print_coverage(const std::vector<Covered>& all, const Groups& groups, bool json) {
  if (all.empty()) return;
  for (const auto& [group, scenarios] : groups) {
    int commands = 0, with_truth = 0, unanswered = 0;
    for (const Covered& one : all) {
      if (!contains(scenarios, one.scenario)) continue;
      one.holds_truth ? ++commands : ++unanswered;
      with_truth += one.holds_truth.value_or(false);
    }
    if (json && commands + unanswered > 0)
      to_stdout("{}\n", canonical({{"group", group},
                                   {"asked", "hypotheses"},
                                   {"commands", commands},
                                   {"covered", with_truth},
                                   {"unanswered", unanswered}}));
  }
  if (json) return;
  constexpr std::size_t most_names = 10;
  std::size_t answered = 0;
  std::vector<std::string> lacking;
  for (const Covered& one : all) {
    answered += one.holds_truth.has_value();
    if (one.holds_truth == false) lacking.push_back(one.name);
  }
  const bool names_them = !lacking.empty() && lacking.size() <= most_names;
  to_stdout("hypotheses on what the words leave unsaid hold the truth for {} of {} commands{}{}\n",
            answered - lacking.size(), answered,
            names_them ? fmt::format(", not for {}", fmt::join(lacking, ", ")) : "",
            answered < all.size() ? fmt::format("; {} more have no answer", all.size() - answered) : "");
}

std::string share(int part, int of) { return of == 0 ? "-" : fixed(static_cast<double>(part) / of); }

std::string exact_scenes(const SceneScore& score) {
  if (score.scenes == 0) return "-";
  const statistics::Interval interval = statistics::wilson(score.exact_scenes, score.scenes);
  return fmt::format("{} [{}, {}]", share(score.exact_scenes, score.scenes), fixed(interval.low), fixed(interval.high));
}

Json to_json(const Row& row, bool by_arm) {
  Json json{{"group", row.group},
            {"asked", row.asking},
            {"commands", row.score.commands},
            {"exact_sets", row.score.exact_sets},
            {"scenes", row.score.scenes},
            {"exact_scenes", row.score.exact_scenes},
            {"kept", row.score.kept},
            {"meant", row.score.meant},
            {"right", row.score.right},
            {"questions", row.questions},
            {"unanswered", row.unanswered}};
  if (by_arm) json["otherwise"] = row.otherwise;
  return json;
}

void print(const Row& row, bool by_arm) {
  to_stdout("{:<14} {:<11} {:>4}  {:<18}  {:>5}  {:>9}  {:>6}  {:>9}{}{}\n", row.group, row.asking, row.score.commands,
            exact_scenes(row.score), share(row.score.exact_sets, row.score.commands),
            share(row.score.right, row.score.kept), share(row.score.right, row.score.meant), row.questions,
            by_arm ? fmt::format("  {:>9}", share(row.otherwise, row.score.commands)) : "",
            row.unanswered == 0 ? ""
                                : fmt::format("  {} of {} commands have no answer", row.unanswered,
                                              row.unanswered + row.score.commands));
}

// What a reader is told of a command: one whose scenes are not all exact, or that enters no mean.
void print_misread(const Scores& scores) {
  for (const ScoredCommand& command : scores.commands) {
    const int scenes = command.row.score.scenes, exact = command.row.score.exact_scenes;
    if (command.row.unanswered > 0 || (exact == scenes && !command.ambiguous)) continue;
    std::vector<std::string> words{fmt::format("{} of {} scenes", exact, scenes)};
    const SceneScore& score = command.row.score;
    if (!score.wrongly_kept.empty()) words.push_back(fmt::format("kept: {}", fmt::join(score.wrongly_kept, ", ")));
    if (!score.missed.empty()) words.push_back(fmt::format("missed: {}", fmt::join(score.missed, ", ")));
    to_stdout("{}, {}{}: {}\n", command.row.asking, command.title, command.ambiguous ? " (ambiguous, in no mean)" : "",
              fmt::join(words, "; "));
  }
}

// All that was asked about a suite, and what came of it.
struct SuiteScores {
  std::map<std::string, Scores> by_asking;  // of the ways in which somebody can answer
  std::vector<Covered> covered;
  std::vector<std::string> left_out;  // lines
  OpenQuestions open;
  bool hopeless = false;  // what was left out has answers that cannot be read
};

SuiteScores ask_all(const Suite& suite, Truth truth, int scenes, bool expects_answers,
                    const WithAnswers& with_answers) {
  SuiteScores all;
  const auto unless_impossible = [&all](const char* what, const std::function<void()>& ask) {
    try {
      ask();
    } catch (const InputError& e) {
      all.left_out.push_back(fmt::format("{}: {}", what, one_line(e.what())));
    } catch (const Hopeless& e) {
      all.hopeless = true;
      all.left_out.push_back(fmt::format("{}: {}", what, one_line(e.what())));
    }
  };
  std::vector<const char*> asked{"named"};  // which asks nobody
  if (expects_answers) asked.assign(std::begin(ways_of_asking), std::end(ways_of_asking));
  CountedProgress progress("commands scored:", static_cast<int>(asked.size()) * commands_of(suite, truth));
  for (const char* asking : asked)
    unless_impossible(asking, [&] {
      const Scores scores = scores_of(asking, suite, truth, scenes, with_answers, progress);
      all.open.add(scores.open);
      all.by_asking[asking] = scores;
    });
  progress.end();
  if (expects_answers)
    unless_impossible("hypotheses", [&] { all.covered = coverage_of(suite, truth, with_answers, all.open); });
  return all;
}

std::vector<std::string> sources_in(const SuiteScores& asked) {
  std::vector<std::string> sources;
  for (const char* asking : {"structured", "flat"})
    if (const auto scores = asked.by_asking.find(asking); scores != asked.by_asking.end())
      for (const std::string& source : scores->second.sources) add_source(source, sources);
  return sources;
}

// The arms that commands name, but for those that are called as a group of the suite.
std::vector<std::string> named_arms(const std::vector<ScoredCommand>& commands, const Suite& suite) {
  std::vector<std::string> arms;
  for (const ScoredCommand& command : commands) {
    const auto same = [&command](const auto& group) { return group.first == command.arm; };
    if (!command.arm.empty() && !contains(arms, command.arm) &&
        std::none_of(suite.groups.begin(), suite.groups.end(), same))
      arms.push_back(command.arm);
  }
  return arms;
}

using InGroup = std::function<bool(const ScoredCommand&)>;

// A row for each way of asking: of the commands in the group that enter means.
void print_group(const std::string& group, const InGroup& is_in, const SuiteScores& asked, bool by_arm, bool json) {
  for (const char* asking : ways_of_asking) {
    const auto scores = asked.by_asking.find(asking);
    if (scores == asked.by_asking.end()) continue;
    Row row{group, asking, {}};
    for (const ScoredCommand& command : scores->second.commands)
      if (is_in(command) && !command.ambiguous) row.add(command.row);
    json ? to_stdout("{}\n", canonical(to_json(row, by_arm))) : print(row, by_arm);
  }
}

// The suite's groups, the arms where commands name them, then all.
void print_groups(const Suite& suite, const std::vector<std::string>& arms, const SuiteScores& asked, bool json) {
  const bool by_arm = !arms.empty();
  for (const auto& [name, scenarios] : suite.groups)
    print_group(
        name, [list = scenarios](const ScoredCommand& one) { return contains(list, one.scenario); }, asked, by_arm,
        json);
  for (const std::string& arm : arms)
    print_group(
        arm, [&arm](const ScoredCommand& one) { return one.arm == arm; }, asked, by_arm, json);
  print_group(
      "all", [](const ScoredCommand&) { return true; }, asked, by_arm, json);
}

}  // namespace

void print_scores(const Suite& suite, Truth truth, int scenes, bool json, bool expects_answers,
                  const WithAnswers& with_answers) {
  const SuiteScores asked = ask_all(suite, truth, scenes, expects_answers, with_answers);
  if (asked.by_asking.count("named") == 0)  // no scene can be had
    throw InputError(fmt::format("{}", fmt::join(asked.left_out, "; ")));
  const std::vector<std::string> sources = sources_in(asked),
                                 arms = named_arms(asked.by_asking.at("named").commands, suite);
  if (!json)
    to_stdout("{}; {} scenes of each arm\n\n{:<14} {:<11} {:>4}  {:<18}  {:>5}  {:>9}  {:>6}  {:>9}{}\n",
              sources.empty() ? (expects_answers ? "nobody answered" : "nobody was asked")
                              : fmt::format("answers of {}", fmt::join(sources, " and ")),
              scenes, "", "asked", "n", "scenes exact", "sets", "precision", "recall", "questions",
              arms.empty() ? "" : "  otherwise");
  print_groups(suite, arms, asked, json);
  const std::string why = fmt::format("{}{}", fmt::join(asked.left_out, "\n"), asked.left_out.empty() ? "" : "\n");
  if (json)
    to_stderr("{}", why);
  else
    to_stdout(
        "\nn: commands; sets: share of them with no pair of type and texture wrong; precision and recall of the "
        "objects kept.\n{}{}",
        arms.empty()
            ? ""
            : "otherwise: share of them for which something else was selected than for the scenario's first.\n",
        why);
  Groups families(suite.groups.begin(), suite.groups.end());
  families.emplace_back("all", suite_scenario_ids(suite, suite.design));
  print_coverage(asked.covered, families, json);
  for (const char* asking : ways_of_asking) {
    const auto scores = asked.by_asking.find(asking);
    if (!json && scores != asked.by_asking.end() && std::string(asking) != "named") print_misread(scores->second);
  }
  asked.open.expect_none("questions have no answer; their commands are in no mean");
  if (asked.hopeless) throw MethodError("the model gives no answers that can be read in a form that was left out");
  if (expects_answers && sources.empty()) throw InputError("no answer was scored: " + asked.left_out.front());
}

void write_best_products(const Suite& suite, Truth truth, const std::filesystem::path& file) {
  constexpr int scenes = 1000;
  Json answers = Json::array();
  CountedProgress progress("commands solved:", commands_of(suite, truth));
  for (const std::string& id : suite_scenario_ids(suite, suite.design)) {
    const Scenario scenario = suite_scenario(suite, id, truth);
    const std::vector<FeatureSet> best =
        best_products(scenario, suite.design.layouts.front(), scenes, [&progress] { progress.tell_next(); });
    for (std::size_t i = 0; i < best.size(); ++i)
      answers.push_back(Json{{"space", scenario.space.id},
                             {"scenario", scenario.answers_of},
                             {"command", scenario.commands[i].utterance},
                             {"target", to_json(best[i])}});
  }
  const std::string how = fmt::format("coordinate ascent on {} training scenes a command, from the truth", scenes);
  write_file(file, Json{{"model", "best single product"}, {"how", how}, {"answers", answers}}.dump(1) + "\n");
  to_stdout("{}: {} commands\n", file.string(), answers.size());
}

}  // namespace lgabench::cli

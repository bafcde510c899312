#include <lgabench/cli/select_score.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include <lgabench/abstraction/best_product.hpp>
#include <lgabench/abstraction/named.hpp>
#include <lgabench/abstraction/scene_score.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/rounding.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/expand.hpp>
#include <lgabench/report/statistics.hpp>

namespace lgabench::cli {
namespace {

struct Asking {
  const char* name;
  std::function<Selection(const Command&, const FeatureSpace&, LanguageModel&)> select;
};

const std::vector<Asking>& ways_of_asking() {
  static const std::vector<Asking> all{{"flat", select_features},
                                       {"structured", select_meaning},
                                       {"named", [](const Command& command, const FeatureSpace& space, LanguageModel&) {
                                          return select_named(command, space);
                                        }}};
  return all;
}

struct Row {
  std::string group, asking;
  SceneScore score;
  int questions = 0;
};

using Groups = std::vector<std::pair<std::string, std::vector<std::string>>>;  // name, scenarios

// By scenario, of one way of asking.
struct Scores {
  std::map<std::string, SceneScore> by_scenario;
  std::map<std::string, int> questions;
  std::string source;
};

Scores scores_of(const Asking& asking, const Suite& suite, Truth truth, int scenes, const WithAnswers& with_answers) {
  Scores all;
  for (const std::string& id : suite_scenario_ids(suite, suite.design)) {
    const Scenario scenario = suite_scenario(suite, id, truth);
    with_answers(scenario, [&](LanguageModel& model) {
      for (int i = 0; i < static_cast<int>(scenario.commands.size()); ++i) {
        const Selection selection = asking.select(scenario.command(i), scenario.space, model);
        all.source = selection.source;
        all.questions[id] += selection.cost.lm_queries;
        all.by_scenario[id] +=
            score(scenario, i, selection, suite.design.layouts.front(), suite.design.scene_seed, scenes);
      }
    });
  }
  return all;
}

// Scenarios behind whose words stands a preference, and whether the hypotheses on it hold the truth. Those on which
// there are none are left out.
std::map<std::string, bool> coverage_of(const Suite& suite, Truth truth, const WithAnswers& with_answers) {
  std::map<std::string, bool> covered;
  for (const std::string& id : suite_scenario_ids(suite, suite.design)) {
    const Scenario scenario = suite_scenario(suite, id, truth);
    if (!scenario.json.contains("words")) continue;
    with_answers(scenario, [&](LanguageModel& model) {
      const std::vector<Hypothesis> hypotheses = model.hypotheses(scenario.command(0), scenario.space);
      if (!hypotheses.empty()) covered[id] = covers_truth(hypotheses, scenario, 0);
    });
  }
  return covered;
}

// A row for each group with such scenarios, or a line for all of them.
void print_coverage(const std::map<std::string, bool>& covered, const Groups& groups, bool json) {
  if (covered.empty()) return;
  for (const auto& [group, scenarios] : groups) {
    int commands = 0, with_truth = 0;
    for (const std::string& id : scenarios)
      if (const auto found = covered.find(id); found != covered.end()) ++commands, with_truth += found->second;
    if (json && commands > 0)
      to_stdout(
          "{}\n",
          canonical({{"group", group}, {"asked", "hypotheses"}, {"commands", commands}, {"covered", with_truth}}));
  }
  if (json) return;
  std::vector<std::string> lacking;
  for (const auto& [id, holds_truth] : covered)
    if (!holds_truth) lacking.push_back(id);
  to_stdout("hypotheses on what the words leave unsaid hold the truth for {} of {} commands{}{}\n",
            covered.size() - lacking.size(), covered.size(), lacking.empty() ? "" : ", not for ",
            fmt::join(lacking, ", "));
}

std::string share(int part, int of) { return of == 0 ? "-" : fixed(static_cast<double>(part) / of); }

std::string exact_scenes(const SceneScore& score) {
  const report::Interval interval = report::wilson(score.exact_scenes, score.scenes);
  return fmt::format("{} [{}, {}]", share(score.exact_scenes, score.scenes), fixed(interval.low), fixed(interval.high));
}

Json to_json(const Row& row) {
  return {{"group", row.group},
          {"asked", row.asking},
          {"commands", row.score.commands},
          {"exact_sets", row.score.exact_sets},
          {"scenes", row.score.scenes},
          {"exact_scenes", row.score.exact_scenes},
          {"kept", row.score.kept},
          {"meant", row.score.meant},
          {"right", row.score.right},
          {"questions", row.questions}};
}

void print(const Row& row) {
  to_stdout("{:<14} {:<11} {:>4}  {:<18}  {:>5}  {:>9}  {:>6}  {:>9}\n", row.group, row.asking, row.score.commands,
            exact_scenes(row.score), share(row.score.exact_sets, row.score.commands),
            share(row.score.right, row.score.kept), share(row.score.right, row.score.meant), row.questions);
}

}  // namespace

void print_scores(const Suite& suite, Truth truth, int scenes, bool json, const WithAnswers& with_answers) {
  std::map<std::string, Scores> by_asking;
  std::string left_out;
  for (const Asking& asking : ways_of_asking()) {
    try {
      by_asking[asking.name] = scores_of(asking, suite, truth, scenes, with_answers);
    } catch (const InputError& e) {
      if (&asking == &ways_of_asking().front()) throw;
      by_asking.erase(asking.name);
      left_out += fmt::format("{}: {}\n", asking.name, one_line(e.what()));
    }
  }
  std::map<std::string, bool> covered;
  try {
    covered = coverage_of(suite, truth, with_answers);
  } catch (const InputError& e) {
    left_out += fmt::format("hypotheses: {}\n", one_line(e.what()));
  }
  Groups groups;
  for (const auto& [name, scenarios] : suite.groups.items()) groups.emplace_back(name, scenarios);
  groups.emplace_back("all", suite_scenario_ids(suite, suite.design));

  if (!json)
    to_stdout("answers of {}; {} scenes of each arm\n\n{:<14} {:<11} {:>4}  {:<18}  {:>5}  {:>9}  {:>6}  {:>9}\n",
              by_asking.at("flat").source, scenes, "", "asked", "n", "scenes exact", "sets", "precision", "recall",
              "questions");
  for (const auto& [group, scenarios] : groups)
    for (const Asking& asking : ways_of_asking()) {
      const auto scores = by_asking.find(asking.name);
      if (scores == by_asking.end()) continue;
      Row row{group, asking.name, {}, 0};
      for (const std::string& id : scenarios) {
        row.score += scores->second.by_scenario.at(id);
        row.questions += scores->second.questions.at(id);
      }
      json ? to_stdout("{}\n", canonical(to_json(row))) : print(row);
    }
  if (json) return print_coverage(covered, groups, json);
  to_stdout(
      "\nn: commands; sets: share of them with no pair of type and texture wrong; precision and recall of the "
      "objects kept.\n{}",
      left_out);
  print_coverage(covered, groups, json);
  for (const Asking& asking : ways_of_asking()) {
    const auto scores = by_asking.find(asking.name);
    if (scores == by_asking.end() || std::string(asking.name) == "named") continue;
    for (const auto& [id, score] : scores->second.by_scenario) {
      if (score.exact_scenes == score.scenes) continue;
      std::vector<std::string> words;
      if (!score.wrongly_kept.empty()) words.push_back(fmt::format("kept: {}", fmt::join(score.wrongly_kept, ", ")));
      if (!score.missed.empty()) words.push_back(fmt::format("missed: {}", fmt::join(score.missed, ", ")));
      to_stdout("{}, {}: {} of {} scenes; {}\n", asking.name, id, score.exact_scenes, score.scenes,
                fmt::join(words, "; "));
    }
  }
}

void write_best_products(const Suite& suite, Truth truth, const std::filesystem::path& file) {
  constexpr int scenes = 1000;
  Json answers = Json::array();
  for (const std::string& id : suite_scenario_ids(suite, suite.design)) {
    const Scenario scenario = suite_scenario(suite, id, truth);
    for (int i = 0; i < static_cast<int>(scenario.commands.size()); ++i)
      answers.push_back(Json{{"space", scenario.space.id},
                             {"scenario", scenario.answers_of},
                             {"command", scenario.commands[static_cast<std::size_t>(i)].utterance},
                             {"target", to_json(best_product(scenario, i, suite.design.layouts.front(), scenes))}});
  }
  const std::string how = fmt::format("coordinate ascent on {} training scenes a command, from the truth", scenes);
  write_file(file, Json{{"model", "best single product"}, {"how", how}, {"answers", answers}}.dump(1) + "\n");
  to_stdout("{}: {} commands\n", file.string(), answers.size());
}

}  // namespace lgabench::cli

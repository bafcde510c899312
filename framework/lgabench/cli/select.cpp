#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include <lgabench/abstraction/quality.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/cli/verbs.hpp>

namespace lgabench::cli {
namespace {

struct Arguments {
  std::string command, answers = "recorded", task = "pick_and_place", space = "tabletop";
  bool json = false;
};

// The scenario of that id, or with that utterance; else one made of the words alone, which has no truth.
Scenario find_scenario(const Arguments& arguments) {
  for (const std::string& id : scenario_ids()) {
    Scenario scenario = load_scenario(id);
    if (id == arguments.command || scenario.command.utterance == arguments.command) return scenario;
  }
  if (arguments.command.find(' ') == std::string::npos)
    return load_scenario(arguments.command);  // says which there are
  Scenario scenario;
  scenario.command.utterance = arguments.command;
  for (const Task task : {Task::pick_and_place, Task::rotate, Task::sweep})
    if (to_string(task) == arguments.task) scenario.command.task = task;
  scenario.space = load_feature_space(arguments.space);
  return scenario;
}

std::string list(const std::vector<std::string>& names, const std::vector<std::string>& all) {
  if (names.empty()) return "(none)";
  return names == all ? fmt::format("any of the {}", all.size()) : fmt::format("{}", fmt::join(names, ", "));
}

// "precision .71, recall 1.00 of 4 true ones", where there is a truth.
std::string describe(const Json& quality) {
  const auto share = [](const Json& value) {
    return value.is_null() ? "-" : fmt::format("{:.2f}", value.get<double>());
  };
  return fmt::format("{} selected, {} true: precision {}, recall {}", quality.at("size").get<int>(),
                     quality.at("true_size").get<int>(), share(quality.at("precision")), share(quality.at("recall")));
}

void print_set(const char* name, const FeatureSet& set, const FeatureSpace& space, const Json& quality) {
  fmt::print("{}\n  object types  {}\n", name, list(set.object_types, space.object_types));
  if (!quality.is_null()) fmt::print("                {}\n", describe(quality.at("object_types")));
  fmt::print("  textures      {}\n", list(set.textures, space.textures));
  if (!quality.is_null()) fmt::print("                {}\n", describe(quality.at("textures")));
}

void select(const Arguments& arguments) {
  const Scenario scenario = find_scenario(arguments);
  RecordedLanguageModel model(scenario, arguments.answers);
  const Selection selection = select_features(scenario.command, scenario.space, model);
  const bool has_truth = scenario.truth.provenance == Provenance::truth;
  const Json judged = has_truth ? quality(selection, scenario.truth) : Json();
  if (arguments.json) {
    fmt::print("{}\n", canonical({{"selection", to_json(selection)}, {"quality", judged}}));
    return;
  }
  fmt::print("command     {}\n", scenario.command.utterance);
  if (selection.asked_as != scenario.command.utterance) fmt::print("asked as    {}\n", selection.asked_as);
  fmt::print("answers     {} ({})\n", selection.source, to_string(selection.provenance));
  fmt::print("cost        {} queries\n", selection.cost.lm_queries);
  print_set("target", selection.target, scenario.space, has_truth ? judged.at("target") : Json());
  if (selection.avoid) print_set("avoid", *selection.avoid, scenario.space, has_truth ? judged.at("avoid") : Json());
}

}  // namespace

void add_select(CLI::App& app, int&) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb = app.add_subcommand("select", "Ask which features matter for a command, and print the Selection");
  verb->add_option("command", arguments->command, "A scenario's id, or a command in quotes")->required();
  verb->add_option("--answers", arguments->answers,
                   "Whose recorded answers; recorded: GPT-4's where it was asked, else Claude's")
      ->check(CLI::IsMember({"recorded", "gpt4", "claude"}))
      ->capture_default_str();
  verb->add_option("--task", arguments->task, "Of a command that is no scenario's")
      ->check(CLI::IsMember({"pick_and_place", "rotate", "sweep"}))
      ->capture_default_str();
  verb->add_option("--space", arguments->space, "Feature space of a command that is no scenario's")
      ->capture_default_str();
  verb->add_flag("--json", arguments->json, "Print one line of JSON, as in a cell's selection.json");
  verb->footer("Example: lgabench select red_heart");
  verb->callback([arguments] { select(*arguments); });
}

}  // namespace lgabench::cli

// A scenario: a command, a task, the true distribution, and the scenes it trains and tests on. Read without an engine.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/scene.hpp>
#include <lgabench/core/selection.hpp>

namespace lgabench {

/// What a method is told of the task: the words, and the kind of motion that is wanted.
struct Command {
  std::string utterance;
  Task task = Task::pick_and_place;
};

/// Test scenes of one kind, played by one policy. "test" is the paper's; variants are named after what they change.
struct Arm {
  std::string id = "test";
};

struct Scenario {
  std::string id, environment;
  Command command;
  double angle_deg = 0;  // rotate only
  FeatureSpace space;
  Selection truth;                             // what the scenario's author means; provenance truth
  std::optional<FeatureSet> never_distractor;  // test distractors stay out of it, beyond the true distribution
  bool earliest_letter = false;  // "bring the one that comes earliest": a distractor may be a later letter
  std::vector<Arm> tests;
  Json json;  // as read: goes into a cell's configuration whole
};

/// Reads and checks a scenario's JSON; `file` is named in errors. @throws InputError with file and place.
Scenario read_scenario(const Json& json, const std::string& file);

/// The scenario named `id` from the data directory's scenarios/. @throws InputError that lists the known ids.
Scenario load_scenario(const std::string& id);

/// Ids of all shipped scenarios, sorted.
std::vector<std::string> scenario_ids();

}  // namespace lgabench

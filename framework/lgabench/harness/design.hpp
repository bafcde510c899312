// What is crossed to make the cells of a run: by a suite, one of its presets, or the command line.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/abstraction/selection_errors.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/record/test_scenes.hpp>
#include <lgabench/record/train_on.hpp>

namespace lgabench {

/// Arms of every scenario beside its others: its first arm with the axis at each level.
struct DesignAxis {
  std::string axis;
  std::vector<int> levels;
  std::optional<std::vector<std::string>> except{};  // scenarios that do not play them
};

/// What is crossed to make the cells of a run. As JSON the members have these names; a preset or the command line
/// gives some of them and keeps the rest.
struct Design {
  std::vector<std::string> scenarios, layouts, engines;
  std::vector<std::string> methods;  // a plugin's id, or one of its variants: "ID+OPTION=VALUE+OPTION=VALUE"
  std::vector<int> demonstrations;   // clean demonstrations a policy learns from
  std::vector<std::uint64_t> seeds;  // training seeds
  int episodes = 0;                  // test scenes of each arm
  std::uint64_t scene_seed = 0;      // of the test scenes
  bool smoke = false;                // stamped as not for the leaderboard
  TestScenes test_scenes = TestScenes::shared;
  /// Method id, or "*" for each method that has the framework's option of that name -> option -> value.
  Json options = Json::object();
  std::vector<SelectionErrors> selection_errors{};  // made in what methods select; none: cells without
  std::vector<DesignAxis> perturbations{};
  std::vector<std::string> arms{};         // which of the suite's are played; none: all
  std::optional<TrainOn> train_on{};       // what demonstrations are perceived through
  std::vector<std::string> names{};        // where methods' names come from (Reading); none: the simulator
  std::vector<std::string> segments{};     // likewise
  std::string options_place = "/options";  // in the suite's file, for messages; no member
};

Json to_json(const Design& design);

/// `base` with the members that `overrides` gives, each checked.
/// @throws InputError for an unknown member, scenario or layout, a list that is empty or names something twice, a
/// number out of range, options of what is no method of the design. Options themselves are checked by expand().
Design apply(const JsonReader& overrides, Design base);

/// Ids of the axes that `train_on` may name.
std::vector<std::string> train_on_axes();

/// Members of a design that a suite must have, and those that it may have.
extern const std::vector<std::string> needed_design_members, optional_design_members;

}  // namespace lgabench

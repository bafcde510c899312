// A suite: the scenarios, methods and seeds that make one table. Read without an engine or a plugin.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/abstraction/selection_errors.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/record/test_scenes.hpp>
#include <lgabench/record/train_on.hpp>

namespace lgabench {

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
  /// [{"axis", "levels"}, ...]: arms of every scenario beside its others, its first arm with that perturbation.
  Json perturbations = Json::array();
  std::vector<std::string> arms{};         // which of the suite's are played; none: all
  std::optional<TrainOn> train_on{};       // what demonstrations are perceived through
  std::string options_place = "/options";  // in the suite's file, for messages; no member
};

Json to_json(const Design& design);

/// `base` with the members that `overrides` gives, each checked.
/// @throws InputError for an unknown member, scenario or layout, a list that is empty or names something twice, a
/// number out of range, options of what is no method of the design. Options themselves are checked by expand().
Design apply(const JsonReader& overrides, Design base);

/// Ids of the axes that `train_on` may name.
std::vector<std::string> train_on_axes();

struct Suite {
  std::string id, environment;
  Design design;
  /// Arms that every scenario plays beside its own: each is the scenario's first arm with these members changed. Those
  /// that "except" names, with or without their variant, do not play it.
  Json arms = Json::array();
  bool only_arms = false;           // instead of the scenario's own
  Json train = Json::object();      // members that replace the "train" of every scenario
  Json near_miss = Json::object();  // scenario -> "near_miss" of its arms that have one, in place of true
  Json scenes = Json::object();     // scenario -> members of its "train" and of every arm, in place of those above
  /// Scenario -> another one, of the same command: the words of its unseen commands are wordings 1, 2, ... here, and
  /// its recorded answers hold.
  Json paraphrases = Json::object();
  Json answers = Json::object();  // scenario -> whose recorded answers hold, in place of those that it names
  /// Name -> {"train": members that replace those of every scenario's "train", "commands": how many of its demonstrated
  /// commands are left, the first ones, "arms": in place of those above}: in place of each scenario ID there is one
  /// ID_NAME for each, with arms ARM_NAME.
  Json variants = Json::object();
  Json groups = Json::object();              // name -> scenarios, each in one group at most: tables have a mean of each
  std::vector<std::string> selects_nothing;  // methods in which errors of a Selection make no difference: without alone
  std::vector<std::string> references;       // rows of that kind beside those that every suite has
  Json about;                                // of a suite in a file of the user's own, what pages say of it; null: none
  Json claims;                               // its own (suite_claims.hpp); null: none
  Json presets;                              // name -> members of Design
  std::string file;                          // for messages
};

/// The suite named `id` from the data directory's suites/, or the file `id` if it ends in .json; scenarios beside that
/// file are then found too. Every preset is checked. @throws InputError with file and place; for an unknown id it lists
/// the known ones.
Suite load_suite(const std::string& id);

/// The engine where nobody names one: the first that a shipped suite is played on and that is there, else the first
/// that is there. @throws InputError where there is none.
const PluginInfo& usual_engine(const Catalogue& catalogue);

/// The design of a preset; of the suite itself where `preset` is empty. @throws InputError for an unknown preset.
Design preset_design(const Suite& suite, const std::string& preset);

}  // namespace lgabench

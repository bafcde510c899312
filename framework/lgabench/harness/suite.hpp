// A suite: the scenarios, methods and seeds that make one table. Read without an engine or a plugin.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/harness/design.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench {

/// An arm that every scenario plays beside its own: the scenario's first arm with these members changed.
struct SuiteArm {
  std::string id;
  Json members;                       // of a scenario's arm, "arm" among them, which its environment reads
  std::vector<std::string> except{};  // scenarios that do not play it, with or without their variant
};

/// In place of each scenario ID there is one ID_NAME for each variant NAME, with arms ARM_NAME.
struct SuiteVariant {
  Json train = Json::object();                // members that replace those of every scenario's "train"
  std::optional<std::size_t> commands{};      // how many of its demonstrated commands are left, the first ones
  std::optional<std::vector<SuiteArm>> arms;  // in place of the suite's
};

/// Members of scenarios are JSON, since each environment reads its own.
struct Suite {
  std::string id, environment;
  Design design;
  std::vector<SuiteArm> arms;
  bool only_arms = false;                 // instead of the scenario's own
  Json train = Json::object();            // members that replace the "train" of every scenario
  std::map<std::string, Json> near_miss;  // scenario -> "near_miss" of its arms that have one, in place of true
  std::map<std::string, Json> scenes;  // scenario -> members of its "train" and of every arm, in place of those above
  /// Scenario -> another one, of the same command: the words of its unseen commands are wordings 1, 2, ... here, and
  /// its recorded answers hold.
  std::map<std::string, std::string> paraphrases;
  std::map<std::string, std::string> answers;  // scenario -> whose recorded answers hold, in place of those it names
  std::map<std::string, SuiteVariant> variants;
  std::map<std::string, std::vector<std::string>> groups;  // scenarios, each in one group at most, whose mean is shown
  std::vector<std::string>
      selects_nothing;  // methods that are run only without errors of a Selection, which change nothing in them
  std::vector<std::string> references;  // rows of that kind beside those that every suite has
  Json about;                           // of a suite in a file of the user's own, what pages say of it; null: none
  Json claims;                          // its own (suite_claims.hpp); null: none
  Json presets;                         // name -> members of Design
  std::string file;                     // for messages
};

/// The suite named `id` from the data directory's suites/ or else from the scenario path, or the file `id` if it ends
/// in .json; scenarios beside a file of the user's own are then found too. Every preset is checked. @throws InputError
/// with file and place; for an unknown id it lists the known ones.
Suite load_suite(const std::string& id);

/// The environment's engine where nobody names one: own_engine, or the first plugin that a shipped suite is played on
/// and that is there, else the first that is there. @throws InputError where there is none.
std::string default_engine(const Catalogue& catalogue, const EnvironmentType& environment);

/// The design of a preset; of the suite itself where `preset` is empty. @throws InputError for an unknown preset.
Design preset_design(const Suite& suite, const std::string& preset);

}  // namespace lgabench

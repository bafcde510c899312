// What all entries of one table of the leaderboard have in common: a preset of a suite, without its methods.
#pragma once
#include <cstdint>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <lgabench/core/json.hpp>
#include <lgabench/harness/expand.hpp>
#include <lgabench/harness/suite_scenario.hpp>
#include <lgabench/leaderboard/conditions.hpp>

namespace lgabench::leaderboard {

/// The place of a cell in its table, for any row.
struct Place {
  std::string scenario, layout;
  int demonstrations = 0;
  std::uint64_t seed = 0;

  /// "heart continuous n=10 seed=0"
  std::string text() const;
  bool operator<(const Place& other) const { return tied() < other.tied(); }
  bool operator==(const Place& other) const { return tied() == other.tied(); }

 private:
  std::tuple<const std::string&, const std::string&, const int&, const std::uint64_t&> tied() const {
    return std::tie(scenario, layout, demonstrations, seed);
  }
};

struct Setting {
  struct Scenario {
    std::string id, sha256;  // of the scenario with the suite's arms, as canonical JSON
    std::vector<std::string> arms;
    /// Where scenes come in pairs that differ in the command alone, the scenario that has the other scene of each:
    /// scene k there is the other of scene k here; where it is this one, scenes 2k and 2k + 1 are a pair. "" where they
    /// do not.
    std::string pair{};
  };
  std::string suite, preset;
  std::vector<Scenario> scenarios;
  std::vector<std::string> layouts;
  std::vector<int> demonstrations;
  std::vector<std::uint64_t> seeds;  // training seeds
  int episodes = 0;                  // of each arm
  TestScenes test_scenes = TestScenes::shared;
  std::uint64_t scene_seed = 0;

  /// "q1-leaderboard"
  std::string name() const { return suite + "-" + preset; }
  /// @throws InputError for a scenario that is none of its own.
  const Scenario& scenario(const std::string& id) const;
  /// A row's cells: those of a row that learns, or of a reference row that does not (harness/expand.hpp).
  std::vector<Place> places(bool learns) const;
  /// Whether scenes come in pairs, in every scenario or in none.
  bool paired() const { return !scenarios.empty() && !scenarios.front().pair.empty(); }
  /// Whether all training seeds play the same scenes.
  bool shared_scenes() const { return test_scenes == TestScenes::shared || seeds.size() == 1; }
};

Json to_json(const Setting& setting);
/// @throws InputError with file and place for what is not as docs/formats says.
Setting read_setting(const JsonReader& reader);
/// SHA-256 of all but the scene seed, as canonical JSON.
std::string hash(const Setting& setting);

/// A suite's preset as this installation has it.
struct Installed {
  Suite suite;
  Design design;
  Setting setting;
};
/// @throws InputError for a suite that is not installed, or a preset without a scene seed of its own: it is none of the
/// board's, since methods are tuned on the others' scenes.
Installed installed_setting(const std::string& suite, const std::string& preset);

/// A plugin by kind and id: what a row's episodes are played by, an engine or, where the environment has none
/// (own_engine), the environment.
std::pair<std::string, std::string> player_of(const std::string& engine, const Suite& suite);

/// The cells of a row, in the order of places(). Their keys are those of a run of this row alone. @throws InputError
/// where the environment has no such reader.
std::vector<Cell> cells_of_row(const Installed& installed, const Competitor& row, const std::string& engine,
                               const AnswerSource& answers, const Conditions& conditions = {});

}  // namespace lgabench::leaderboard

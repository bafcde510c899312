// Success over the test scenes in which nothing is disputed (abstraction/disputed.hpp), beside that over all of them.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <lgabench/leaderboard/entry.hpp>

namespace lgabench::leaderboard {

/// Where a table answers its suite's question.
struct MainColumn {
  std::string arm;         // the suite's main one
  int demonstrations = 0;  // the suite's main number where the preset has it, else its most
};
MainColumn main_column(const Setting& setting);

/// Which scenes of a table's main arm show something disputed.
struct Undisputed {
  struct Scenes {
    int disputed = 0, all = 0;
  };
  MainColumn main;
  /// Which scenes are disputed, by scenario, layout and set of scenes (scene_set()); none where none is disputed.
  std::map<std::tuple<std::string, std::string, std::uint64_t>, std::vector<bool>> disputed;
  std::map<std::string, Scenes> commands;  // by their words, those with some
};
/// The undisputed scenes of a table; none where no scene is disputed, and where the preset is not installed as it was:
/// its scenes are sampled anew.
/// @throws InputError for a file of disputed pairs that is not as docs/formats says.
std::optional<Undisputed> undisputed_of(const Setting& setting);

/// An entry's success in the main column: the mean over the scenarios with undisputed scenes. None where it played
/// none.
std::optional<double> success(const Undisputed& undisputed, const Entry& entry);

/// Which commands' scenes are left out, and how many of them.
std::string words_of(const Undisputed& undisputed);

}  // namespace lgabench::leaderboard

// What success is a share of: episodes, or where a table's scenes come in pairs (Setting::Scenario::pair) these.
#pragma once
#include <string>
#include <vector>

#include <lgabench/leaderboard/entry.hpp>

namespace lgabench::leaderboard {

/// Cells with a letter a unit. Episodes are letters as they are. A pair's letter is a success if both of its episodes
/// ended right, else the first failure's; where two scenarios make the pairs, the first one's cells have them.
class Units {
 public:
  explicit Units(const Entry& entry) : Units(entry.setting, entry.cells) {}
  /// @pre the cells outlive it, and hold both scenes of each pair
  Units(const Setting& setting, const std::vector<PlayedCell>& cells);
  const std::vector<PlayedCell>& cells() const { return pairs_.empty() ? episodes_ : pairs_; }
  auto begin() const { return cells().begin(); }
  auto end() const { return cells().end(); }
  std::size_t size() const { return cells().size(); }

 private:
  const std::vector<PlayedCell>& episodes_;
  std::vector<PlayedCell> pairs_;
};

/// In place of an episode's letter: the unit that it is in does not count, and has this letter too.
constexpr char left_out_letter = ' ';

/// "success", "paired success"; and what the latter is, for readers: "" of the former.
std::string success_word(const Setting& setting);
std::string words_of_success(const Setting& setting);

}  // namespace lgabench::leaderboard

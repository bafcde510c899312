#include <lgabench/leaderboard/units.hpp>

#include <algorithm>

namespace lgabench::leaderboard {
namespace {

char joined(char one, char other) {
  if (one == left_out_letter || other == left_out_letter) return left_out_letter;
  return is_success(one) ? other : one;
}

// Of scenes 2k and 2k + 1; a last one is nobody's.
std::string within(const std::string& letters) {
  std::string pairs;
  for (std::size_t i = 1; i < letters.size(); i += 2) pairs += joined(letters[i - 1], letters[i]);
  return pairs;
}

std::string between(const std::string& ones, const std::string& others) {
  std::string pairs;
  for (std::size_t i = 0; i < ones.size(); ++i) pairs += joined(ones[i], others.at(i));
  return pairs;
}

}  // namespace

Units::Units(const Setting& setting, const std::vector<PlayedCell>& cells) : episodes_(cells) {
  if (!setting.paired()) return;
  for (const PlayedCell& cell : cells) {
    Place place = cell.place;
    place.scenario = setting.scenario(place.scenario).pair;
    if (place == cell.place) {
      for (auto& arm : pairs_.emplace_back(cell).outcomes) arm.second = within(arm.second);
      continue;
    }
    const auto other =
        std::find_if(pairs_.begin(), pairs_.end(), [&place](const PlayedCell& one) { return one.place == place; });
    if (other == pairs_.end()) {
      pairs_.push_back(cell);
    } else {
      for (auto& [arm, letters] : other->outcomes) letters = between(letters, cell.outcomes.at(arm));
      if (other->failed.empty()) other->failed = cell.failed;
    }
  }
}

std::string success_word(const Setting& setting) { return setting.paired() ? "paired success" : "success"; }

std::string words_of_success(const Setting& setting) {
  return setting.paired() ? "Paired success: both commands of a pair right on one scene." : "";
}

}  // namespace lgabench::leaderboard

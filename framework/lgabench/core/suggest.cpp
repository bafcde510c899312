#include <lgabench/core/suggest.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace lgabench {
namespace {

// Slips between two words: the optimal string alignment distance.
std::size_t slips(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<std::size_t> cost((a.size() + 1) * width);
  const auto at = [&](std::size_t i, std::size_t j) -> std::size_t& { return cost[i * width + j]; };
  for (std::size_t i = 0; i <= a.size(); ++i) at(i, 0) = i;
  for (std::size_t j = 0; j <= b.size(); ++j) at(0, j) = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      at(i, j) = std::min(
          {at(i - 1, j) + 1, at(i, j - 1) + 1, at(i - 1, j - 1) + static_cast<std::size_t>(a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
    }
  return cost.back();
}

// The length of the longest part that both words have.
std::size_t shared(std::string_view a, std::string_view b) {
  std::size_t longest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    while (i + longest < a.size() && b.find(a.substr(i, longest + 1)) != b.npos) ++longest;
  return longest;
}

}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& known) {
  constexpr std::size_t longest = 100;  // what is longer is no slip, and costs its square
  if (word.empty() || word.size() > longest) return "";
  std::size_t least = (word.size() + 1) / 3 + 1;
  std::string near, longer;
  int longer_ones = 0;
  for (const std::string& name : known) {
    if (name.size() <= longest)
      if (const std::size_t n = slips(word, name); n <= least && n < std::max(word.size(), name.size())) {
        near = n < least ? name : "";  // of two that are equally near neither
        least = n;
      }
    if (name.compare(0, word.size(), word) == 0) ++longer_ones, longer = name;
  }
  return !near.empty() ? near : longer_ones == 1 ? longer : "";
}

std::string suggestion(std::string_view word, const std::vector<std::string>& known) {
  const std::string near = nearest(word, known);
  return near.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", near);
}

std::string none_named(std::string_view what, std::string_view word, const std::vector<std::string>& known) {
  constexpr std::size_t most = 40, examples = 8;  // of a name; more are no help
  const std::string begin = fmt::format("no {} \"{}\"", what, word);
  if (known.empty()) return begin + ", there is none";
  if (const std::string near = suggestion(word, known); !near.empty()) return begin + near;
  const char* const others = what == "scenario" || what == "feature space"
                                 ? "; others are found with --scenario-path or $LGABENCH_SCENARIO_PATH"
                                 : "";
  if (known.size() <= most) return fmt::format("{}, expected one of: {}{}", begin, fmt::join(known, ", "), others);
  std::vector<std::string> similar = known;
  std::stable_sort(similar.begin(), similar.end(),
                   [word](const std::string& a, const std::string& b) { return shared(word, a) > shared(word, b); });
  similar.resize(examples);
  const bool is_listed = what == "scenario" || what == "arm";  // by a command
  return fmt::format("{}, expected one of {}, such as: {}{}{}", begin, known.size(), fmt::join(similar, ", "),
                     is_listed ? fmt::format(" (lgabench list {}s)", what) : "", others);
}

std::string some_of(const std::vector<std::string>& all, std::string_view separator) {
  constexpr std::size_t most = 40, first = 8;
  if (all.size() <= most) return fmt::format("{}", fmt::join(all, separator));
  return fmt::format("{}{}... ({} more)", fmt::join(all.begin(), all.begin() + first, separator), separator,
                     all.size() - first);
}

}  // namespace lgabench

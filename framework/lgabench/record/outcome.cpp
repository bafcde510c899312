#include <lgabench/record/outcome.hpp>

#include <algorithm>
#include <cctype>
#include <iterator>

namespace lgabench {
namespace {

constexpr char success_letter = '.', unknown_letter = '.';
constexpr std::array attribution_letters{'a', 'p', 's', 'r'};  // of `attributions`
static_assert(attribution_letters.size() == attributions.size());

}  // namespace

char outcome_letter(const Episode& episode, const std::vector<std::string>& words) {
  if (episode.success()) return success_letter;
  return static_cast<char>('a' + (std::find(words.begin(), words.end(), episode.failure) - words.begin()));
}

char attribution_letter(const Episode& episode) {
  const auto found = std::find(attributions.begin(), attributions.end(), episode.attribution);
  return found == attributions.end() ? unknown_letter : attribution_letters.at(found - attributions.begin());
}

std::optional<Outcome> read_outcome(char letter, char attribution, const std::vector<std::string>& words) {
  Outcome outcome;
  if (letter != success_letter) {
    if (letter < 'a' || letter > 'z' || static_cast<std::size_t>(letter - 'a') >= words.size()) return {};
    outcome.failure = words[static_cast<std::size_t>(letter - 'a')];
  }
  if (attribution == unknown_letter) return outcome;
  const auto found = std::find(attribution_letters.begin(), attribution_letters.end(), attribution);
  if (found == attribution_letters.end() || letter == success_letter) return {};
  outcome.attribution = attributions.at(found - attribution_letters.begin());
  return outcome;
}

char entry_letter(const Episode& episode, const std::vector<std::string>& words) {
  const char letter = outcome_letter(episode, words);
  return attribution_letter(episode) == 'a' ? static_cast<char>(letter - 'a' + 'A') : letter;
}

std::optional<Outcome> read_entry_letter(char letter, const std::vector<std::string>& words) {
  const bool capital = letter >= 'A' && letter <= 'Z';
  return capital ? read_outcome(static_cast<char>(letter - 'A' + 'a'), 'a', words)
                 : read_outcome(letter, unknown_letter, words);
}

bool is_success(char letter) { return letter == success_letter; }

int successes(const std::string& letters) {
  return static_cast<int>(std::count(letters.begin(), letters.end(), success_letter));
}

}  // namespace lgabench

// Suggests what a person may have meant by an unknown name.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace lgabench {

/// The one of `known` that `word` is a slip away from: letters left out, added, exchanged with another or with their
/// neighbour, one for each three of the word; or the only one that begins with it. "" for none, or for several that are
/// equally near.
std::string nearest(std::string_view word, const std::vector<std::string>& known);

/// " (did you mean "heart"?)", or "" where nothing is near.
std::string suggestion(std::string_view word, const std::vector<std::string>& known);

/// "no scenario "hart" (did you mean "heart"?)"; "no scenario "moon", expected one of: heart, letter" where nothing is
/// near. Of more than 40 it names some that share most letters in a row with the word, and says how to list all.
std::string none_named(std::string_view what, std::string_view word, const std::vector<std::string>& known);

/// "a, b, c": all, or the first few of many and how many more there are.
std::string some_of(const std::vector<std::string>& all, std::string_view separator = ", ");

}  // namespace lgabench

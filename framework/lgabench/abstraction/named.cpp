#include <lgabench/abstraction/named.hpp>

#include <cctype>

namespace lgabench {
namespace {

// In lower case, with a blank for whatever is no letter or digit, and one at both ends.
std::string spaced(const std::string& text) {
  std::string words = " ";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool part = std::isalnum(byte) != 0;
    if (part || words.back() != ' ') words += part ? static_cast<char>(std::tolower(byte)) : ' ';
  }
  if (words.back() != ' ') words += ' ';
  return words;
}

// "apples" names the apple.
bool names(const std::string& said, const std::string& name) {
  const std::string words = spaced(name);
  return said.find(words) != said.npos || said.find(words.substr(0, words.size() - 1) + "s ") != said.npos;
}

std::vector<std::string> named(const std::string& said, const std::vector<std::string>& all) {
  std::vector<std::string> some;
  for (const std::string& name : all)
    if (names(said, name)) some.push_back(name);
  return some.empty() ? all : some;
}

}  // namespace

Selection select_named(const Command& command, const FeatureSpace& space) {
  const std::string said = spaced(command.utterance);
  const FeatureSet product{named(said, space.object_types), named(said, space.textures)};
  Selection selection;
  selection.target = product;
  if (command.second) selection.second = SecondSet{product, command.second->id};
  selection.provenance = Provenance::rule;
  selection.source = "names in the command";
  selection.asked_as = command.utterance;
  return selection;
}

}  // namespace lgabench

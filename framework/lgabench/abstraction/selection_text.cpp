#include <lgabench/abstraction/selection_text.hpp>

#include <fmt/format.h>

namespace lgabench {
namespace {

std::string text(const std::vector<std::string>& names, const std::vector<std::string>& all) {
  if (names.empty()) return "none";
  return names == all ? "any" : fmt::format("{}", fmt::join(names, ", "));
}

std::string text(const FeatureSet& set, const FeatureSpace& space) {
  return text(set.object_types, space.object_types) + "; " + text(set.textures, space.textures);
}

}  // namespace

std::string selection_text(const Selection& selection, const FeatureSpace& space) {
  std::string words = "target: " + text(selection.target, space);
  if (selection.second) words += fmt::format(". {}: {}", selection.second->role, text(*selection.second, space));
  return words;
}

}  // namespace lgabench

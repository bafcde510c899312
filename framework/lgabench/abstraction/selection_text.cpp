#include <lgabench/abstraction/selection_text.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace lgabench {
namespace {

std::string text(const std::vector<std::string>& names, const std::vector<std::string>& all) {
  if (names.empty()) return "none";
  return names == all ? "any" : fmt::format("{}", fmt::join(names, ", "));
}

std::string text(const FeatureSet& set, const FeatureSpace& space) {
  return text(set.object_types, space.object_types) + "; " + text(set.textures, space.textures);
}

// A reference: its types alone where any texture will do.
std::string which_of(const FeatureSet& set, const FeatureSpace& space) {
  return set.textures == space.textures ? text(set.object_types, space.object_types) : text(set, space);
}

std::string text(const std::vector<FeatureSet>& all, const FeatureSpace& space) {
  std::vector<std::string> sets;
  for (const FeatureSet& set : all) sets.push_back(text(set, space));
  return fmt::format("{}", fmt::join(sets, " or "));
}

// "2 of apple; any, of the same texture, no two of one object type".
std::string turn_text(const Turn& turn, const FeatureSpace& space) {
  const auto names = [](const std::vector<Part>& parts) {
    std::vector<std::string> words;
    for (const Part part : parts) words.emplace_back(part == Part::object_type ? "object type" : "texture");
    return fmt::format("{}", fmt::join(words, " and "));
  };
  std::string words = (turn.take ? std::to_string(*turn.take) : "all") + " of " + text(turn.sets, space);
  if (!turn.same.empty()) words += ", of the same " + names(turn.same);
  if (!turn.different.empty()) words += ", no two of one " + names(turn.different);
  return words;
}

}  // namespace

std::string meaning_text(const Meaning& meaning, const FeatureSpace& space) {
  if (!meaning.turns.empty()) {
    std::string words;
    for (const Turn& turn : meaning.turns)
      words += (words.empty()          ? ""
                : turn.only_if_nothing ? ", or if there is nothing "
                                       : ", then ") +
               turn_text(turn, space);
    return words;
  }
  const std::string all = text(meaning.sets, space);
  if (!meaning.which) return all;
  const Which& which = *meaning.which;
  const auto one = [&](const char* words) { return fmt::format("{}, the one {}", all, words); };
  const std::string of = which.of ? which_of(*which.of, space) : "";
  switch (which.rule) {
    case Which::Rule::left_of:
      return one("to the left of ") + of;
    case Which::Rule::right_of:
      return one("to the right of ") + of;
    case Which::Rule::nearest_to:
      return one("nearest to ") + of;
    case Which::Rule::farthest_from:
      return one("farthest from ") + of;
    case Which::Rule::leftmost:
      return one("farthest to the left");
    case Which::Rule::rightmost:
      return one("farthest to the right");
    case Which::Rule::first_in:
      break;
  }
  return one("that comes first of ") + fmt::format("{}", fmt::join(which.order, ", "));
}

std::string empty_text(const Selection& selection) {
  if (selection.provenance == Provenance::none || !selection.empty()) return "";
  const bool of_target = selection.target.empty();
  const std::vector<FeatureSet> sets =
      of_target ? selection.target.sets : std::vector<FeatureSet>{static_cast<const FeatureSet&>(*selection.second)};
  const auto none = [&sets](std::vector<std::string> FeatureSet::*kind) {
    return std::all_of(sets.begin(), sets.end(), [kind](const FeatureSet& set) { return (set.*kind).empty(); });
  };
  const bool types = none(&FeatureSet::object_types), textures = none(&FeatureSet::textures);
  return fmt::format("{} has {}", of_target ? "the target" : selection.second->role,
                     types && textures ? "no object type and no texture"
                     : types           ? "no object type"
                     : textures        ? "no texture"
                                       : "no set with both an object type and a texture");
}

std::string selection_text(const Selection& selection, const FeatureSpace& space) {
  std::string words = "target: " + meaning_text(selection.target, space);
  if (selection.second) words += fmt::format(". {}: {}", selection.second->role, text(*selection.second, space));
  return words;
}

}  // namespace lgabench

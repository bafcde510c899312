#include <lgabench/statistics/phi_words.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include <lgabench/abstraction/selection_text.hpp>
#include <lgabench/core/feature_space.hpp>

namespace lgabench::statistics {
namespace {

// Read once: a report asks for every command of every cell. None where it is not installed.
const std::optional<FeatureSpace>& space_of(const std::string& id) {
  static std::map<std::string, std::optional<FeatureSpace>> known;
  const auto [space, is_new] = known.try_emplace(id);
  try {
    if (is_new) space->second = load_feature_space(id);
  } catch (const InputError&) {
  }
  return space->second;
}

// Whether a set, as JSON writes it, holds the name; what is no such set holds none.
bool set_holds(const Json& set, const char* group, const std::string& name) {
  if (!set.is_object() || !set.contains(group)) return false;
  const auto is = [](const Json& text, const std::string& word) {  // without a Json made of the word to compare with
    return text.is_string() && text.get_ref<const std::string&>() == word;
  };
  const Json& names = set.at(group);
  return is(names, "ALL") ||
         (names.is_array() && std::any_of(names.begin(), names.end(), [&](const Json& one) { return is(one, name); }));
}

bool is_more(const Json& meaning) {
  return meaning.is_object() && (meaning.contains("sets") || meaning.contains("turns"));
}

// Likewise of a meaning, of which any set may hold it.
bool holds(const Json& meaning, const char* group, const std::string& name) {
  if (meaning.is_object() && meaning.contains("turns") && meaning.at("turns").is_array()) {
    const Json& turns = meaning.at("turns");
    return std::any_of(turns.begin(), turns.end(), [&](const Json& turn) { return holds(turn, group, name); });
  }
  if (!is_more(meaning) || !meaning.contains("sets") || !meaning.at("sets").is_array())
    return set_holds(meaning, group, name);
  const Json& sets = meaning.at("sets");
  return std::any_of(sets.begin(), sets.end(), [&](const Json& set) { return set_holds(set, group, name); });
}

// A meaning in words; nothing for what cannot be read.
std::optional<std::string> in_words(const Json& meaning, const FeatureSpace& space) {
  try {
    return meaning_text(read_meaning(JsonReader(meaning, ""), space), space);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

// One line for what types and textures alone do not say: which products, and which of several objects.
std::optional<PhiWords> as_a_whole(const std::string& about, const Json& selected, const Json& meant,
                                   const FeatureSpace& space) {
  if (!is_more(selected) && !is_more(meant)) return std::nullopt;
  const auto one = in_words(selected, space), other = in_words(meant, space);
  if (!one || !other) return std::nullopt;
  PhiWords words{about, "meaning", {}, {}, {}, 0};
  if (*one == *other) {
    words.right = {*one};
  } else {
    words.missed = {*other};
    words.wrong = {*one};
  }
  return words;
}

}  // namespace

std::vector<PhiWords> phi_words(const CellResult& cell, const CommandResult& command) {
  if (command.quality.empty()) return {};
  const std::optional<FeatureSpace>& found = space_of(cell.space);
  if (!found) return {};
  const FeatureSpace& space = *found;
  std::vector<PhiWords> all;
  for (const auto& set : command.quality) {
    const std::string& about = set.first;
    if (!command.selection.contains(about) || !command.truth.contains(about)) continue;
    for (const auto& [group, feature, known] :
         {std::tuple{"object_types", "object types", &space.object_types}, {"textures", "textures", &space.textures}}) {
      PhiWords words{about, feature, {}, {}, {}, known->size()};
      for (const std::string& name : *known) {
        const bool selected = holds(command.selection.at(about), group, name),
                   meant = holds(command.truth.at(about), group, name);
        if (selected) (meant ? words.right : words.wrong).push_back(name);
        if (!selected && meant) words.missed.push_back(name);
      }
      all.push_back(std::move(words));
    }
    if (auto whole = as_a_whole(about, command.selection.at(about), command.truth.at(about), space))
      all.push_back(std::move(*whole));
  }
  return all;
}

std::string listed(const std::vector<std::string>& names, std::size_t known) {
  constexpr std::size_t most = 8;
  if (names.empty()) return "–";
  if (names.size() == known) return fmt::format("any of {}", known);
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) text += (i ? ", " : "") + names[i];
  return names.size() > most ? fmt::format("{} and {} more", text, names.size() - most) : text;
}

}  // namespace lgabench::statistics

// Reads the grammar of persons.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/shipped.hpp>
#include <lgabench/drawn/lexicon.hpp>
#include <lgabench/drawn/persons.hpp>

namespace lgabench::drawn {
namespace {

using Place = Which::Rule;
using Names = std::vector<std::string>;
constexpr std::array<Place, 4> all_places{Place::leftmost, Place::rightmost, Place::nearest_to, Place::farthest_from};

Names fitting(const JsonReader& patterns, const Names& space) {
  Names found;
  for (const std::string& name : space)
    for (const JsonReader& pattern : patterns.elements())
      if (fits(pattern.string(), name) && !contains(found, name)) found.push_back(name);
  return found;
}

// Shares by name, which add up to 1.
std::vector<double> read_shares(const JsonReader& reader, const Names& names) {
  reader.only(names);
  std::vector<double> shares;
  double sum = 0;
  for (const std::string& name : names) {
    shares.push_back(reader.at(name).number());
    if (!(shares.back() >= 0)) reader.at(name).fail("a share, 0 or more");
    sum += shares.back();
  }
  if (!(std::abs(sum - 1) < 1e-9)) reader.fail(fmt::format("shares that add up to 1, not {}", sum));
  return shares;
}

// Of a grammar in its own space: looks by name, "not " before it for all other textures. `rules`: of each of its words.
PersonGrammar::Hint read_hint(const JsonReader& entry, const PersonGrammar& grammar,
                              const std::vector<std::vector<PersonRule>>& rules) {
  entry.only({"says", "words", "types", "looks", "places"});
  PersonGrammar::Hint hint;
  hint.says = entry.at("says").string();
  for (const PersonGrammar::Words& words : grammar.words)
    if (!entry.has("words") || contains(entry.at("words").strings(), words.a)) hint.words.push_back(words.a);
  if (entry.has("words") && hint.words.size() != entry.at("words").strings().size())
    entry.at("words").fail("words of the grammar");
  if (entry.has("types"))
    for (const JsonReader& types : entry.at("types").elements()) {
      hint.types.push_back(numbers_of(types.strings(), grammar.space.object_types));
      if (hint.types.back().count() != types.strings().size()) types.fail("object types of the feature space");
    }
  if (entry.has("looks"))
    for (const JsonReader& look : entry.at("looks").elements()) {
      std::bitset<PersonRule::most> found;
      for (const PersonGrammar::Look& one : grammar.looks) {
        const auto numbers = numbers_of(one.textures, grammar.space.textures);
        if (look.string() == one.is) found = numbers;
        if (look.string() == "not " + one.is)
          found = numbers_of(grammar.space.textures, grammar.space.textures) & ~numbers;
      }
      if (found.none()) look.fail("a look of the grammar, or \"not \" and a look");
      hint.textures.push_back(found);
    }
  if (entry.has("places"))
    for (const JsonReader& place : entry.at("places").elements()) {
      const auto named = [&place](Place one) { return place.string() == to_string(one); };
      const auto* const found = std::find_if(all_places.begin(), all_places.end(), named);
      if (found == all_places.end()) place.fail("a place of the grammar");
      hint.places.push_back(*found);
    }
  for (std::size_t i = 0; i < grammar.words.size(); ++i) {
    if (!contains(hint.words, grammar.words[i].a)) continue;
    const auto left =
        std::count_if(rules[i].begin(), rules[i].end(), [&](const PersonRule& rule) { return leaves(hint, rule); });
    if (left == 0 || static_cast<std::size_t>(left) == rules[i].size())
      entry.fail(fmt::format("parts that some rules of \"{}\" have and others have not", grammar.words[i].a));
  }
  return hint;
}

}  // namespace

PersonGrammar read_person_grammar(const Json& json, const FeatureSpace& space, const std::string& file) {
  constexpr std::size_t fewest_types = 3;
  if (std::max(space.object_types.size(), space.textures.size()) > PersonRule::most)
    throw InputError(fmt::format("{}: expected a feature space of at most {} types and textures", file,
                                 static_cast<std::size_t>(PersonRule::most)));
  const JsonReader reader(json, file);
  reader.only({"note", "space", "words", "looks", "prior", "hints"});
  PersonGrammar grammar;
  grammar.space = space;
  const bool own_space = reader.at("space").string() == space.id;
  for (const JsonReader& entry : reader.at("words").elements()) {
    entry.only({"a", "types"});
    Names types;
    for (const JsonReader& name : entry.at("types").elements()) {
      const bool known = contains(space.object_types, name.string());
      if (!known && own_space) name.fail("an object type of the feature space: a rule would fit no object");
      if (known) types.push_back(name.string());
    }
    if (types.size() < fewest_types && own_space) entry.at("types").fail("three object types at least");
    if (types.size() >= fewest_types) grammar.words.push_back({entry.at("a").string(), std::move(types)});
  }
  for (const JsonReader& entry : reader.at("looks").elements()) {
    entry.only({"is", "textures"});
    Names textures = fitting(entry.at("textures"), space.textures);
    if (own_space && (textures.empty() || textures.size() == space.textures.size()))
      entry.at("textures").fail("some textures of the feature space and not all: a rule would fit no object");
    if (!textures.empty()) grammar.looks.push_back({entry.at("is").string(), std::move(textures)});
  }
  if (reader.at("words").json().empty()) reader.at("words").fail("at least one entry");
  if (reader.at("looks").json().empty()) reader.at("looks").fail("at least one entry");
  const JsonReader prior = reader.at("prior");
  prior.only({"types", "looks", "places"});
  const auto types = read_shares(prior.at("types"), {"all", "one", "two"});
  const auto looks = read_shares(prior.at("looks"), {"any", "is", "is_not"});
  Names names{"any"};
  for (const Place rule : all_places) names.push_back(to_string(rule));
  const auto places = read_shares(prior.at("places"), names);
  grammar.all = types[0];
  grammar.one = types[1];
  grammar.two = types[2];
  grammar.any = looks[0];
  grammar.is = looks[1];
  grammar.is_not = looks[2];
  grammar.anywhere = places[0];
  for (std::size_t i = 0; i < all_places.size(); ++i) grammar.places.emplace_back(all_places[i], places[i + 1]);
  if (!own_space || !reader.has("hints")) return grammar;
  std::vector<std::vector<PersonRule>> rules;  // once for all hints
  for (const PersonGrammar::Words& words : grammar.words) rules.push_back(rules_of(grammar, words.types));
  for (const JsonReader& entry : reader.at("hints").elements())
    grammar.hints.push_back(read_hint(entry, grammar, rules));
  return grammar;
}

const PersonGrammar& person_grammar(const FeatureSpace& space) {
  static MadeOnce<PersonGrammar> all;
  const Json key{space.id, space.object_types, space.textures};
  return all.of(canonical(key), [&space] { return read_person_grammar(person_grammar_json(), space, "persons.json"); });
}

}  // namespace lgabench::drawn

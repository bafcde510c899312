#include <lgabench/drawn/persons.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <lgabench/drawn/lexicon.hpp>

namespace lgabench::drawn {
namespace {

using Place = Which::Rule;
using Names = std::vector<std::string>;
constexpr double column_margin = 20, distance_margin = 25;  // pixels

Names fitting(const JsonReader& patterns, const Names& space) {
  Names found;
  for (const std::string& name : space)
    for (const JsonReader& pattern : patterns.elements())
      if (fits(pattern.string(), name) && std::find(found.begin(), found.end(), name) == found.end())
        found.push_back(name);
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

std::bitset<PersonRule::most> numbers_of(const Names& names, const Names& space) {
  std::bitset<PersonRule::most> bits;
  for (const std::string& name : names)
    if (const auto at = std::find(space.begin(), space.end(), name); at != space.end())
      bits.set(static_cast<std::size_t>(at - space.begin()));
  return bits;
}

Names names_of(const std::bitset<PersonRule::most>& bits, const Names& space) {
  Names names;
  for (std::size_t i = 0; i < space.size(); ++i)
    if (bits[i]) names.push_back(space[i]);
  return names;
}

bool belongs(const PersonRule& rule, const Thing& one) { return rule.types[one.type] && rule.textures[one.texture]; }

bool by_column(Place place) { return place == Place::leftmost || place == Place::rightmost; }

// By how much it is the one: the smallest number is.
double number_of(Place place, const Thing& one, const Thing& goal) {
  if (by_column(place)) return place == Place::leftmost ? one.column : -one.column;
  const double away = std::hypot(one.row - goal.row, one.column - goal.column);
  return place == Place::nearest_to ? away : -away;
}

std::size_t any_of(const std::bitset<PersonRule::most>& bits, RandomStream& random) {
  std::size_t left = random.below(static_cast<std::uint32_t>(bits.count()));
  for (std::size_t i = 0;; ++i)
    if (bits[i] && left-- == 0) return i;
}

}  // namespace

PersonGrammar read_person_grammar(const Json& json, const FeatureSpace& space, const std::string& file) {
  constexpr std::size_t fewest_types = 3;
  if (std::max(space.object_types.size(), space.textures.size()) > PersonRule::most)
    throw InputError(fmt::format("{}: expected a feature space of at most {} types and textures", file,
                                 static_cast<std::size_t>(PersonRule::most)));
  const JsonReader reader(json, file);
  reader.only({"note", "space", "words", "looks", "prior"});
  PersonGrammar grammar;
  grammar.space = space;
  const bool own_space = reader.at("space").string() == space.id;
  for (const JsonReader& entry : reader.at("words").elements()) {
    entry.only({"a", "types"});
    Names types;
    for (const JsonReader& name : entry.at("types").elements()) {
      const bool known =
          std::find(space.object_types.begin(), space.object_types.end(), name.string()) != space.object_types.end();
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
  const std::array<Place, 4> rules{Place::leftmost, Place::rightmost, Place::nearest_to, Place::farthest_from};
  Names names{"any"};
  for (const Place rule : rules) names.push_back(to_string(rule));
  const auto places = read_shares(prior.at("places"), names);
  grammar.all = types[0], grammar.one = types[1], grammar.two = types[2];
  grammar.any = looks[0], grammar.is = looks[1], grammar.is_not = looks[2];
  grammar.anywhere = places[0];
  for (std::size_t i = 0; i < rules.size(); ++i) grammar.places.emplace_back(rules[i], places[i + 1]);
  return grammar;
}

PersonGrammar person_grammar(const FeatureSpace& space) {
  return read_person_grammar(person_grammar_json(), space, "persons.json");
}

std::vector<PersonRule> rules_of(const PersonGrammar& grammar, const Names& names) {
  constexpr std::size_t two_of = 4;  // of three types, two are all but one
  const std::bitset<PersonRule::most> all = numbers_of(names, grammar.space.object_types);
  std::bitset<PersonRule::most> textures;
  for (std::size_t i = 0; i < grammar.space.textures.size(); ++i) textures.set(i);
  const std::size_t n = all.count();
  std::vector<PersonRule> types, looks, rules;
  const auto pairs = static_cast<double>(n * (n - 1)) / 2;
  types.push_back({all, textures, {}, grammar.all});
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i] || n < 2) continue;
    types.push_back({{}, textures, {}, grammar.one / static_cast<double>(n)});
    types.back().types.set(i);
    for (std::size_t j = i + 1; j < all.size() && n >= two_of; ++j) {
      if (!all[j]) continue;
      types.push_back({{}, textures, {}, grammar.two / pairs});
      types.back().types.set(i).set(j);
    }
  }
  const auto of_looks = static_cast<double>(grammar.looks.size());
  looks.push_back({all, textures, {}, grammar.any});
  for (const auto& [is, those] : grammar.looks) {
    const auto numbers = numbers_of(those, grammar.space.textures);
    looks.push_back({all, numbers, {}, grammar.is / of_looks});
    looks.push_back({all, textures & ~numbers, {}, grammar.is_not / of_looks});
  }
  double sum = 0;
  const auto add = [&](const PersonRule& type, std::size_t look, std::optional<Place> place, double share) {
    const bool negation = look > 0 && look % 2 == 0;
    if (type.types == all && !place && (look == 0 || negation)) return;  // says nothing, or cannot be shown fairly
    rules.push_back({type.types, looks[look].textures, place, type.prior * looks[look].prior * share});
    sum += rules.back().prior;
  };
  for (const PersonRule& type : types)
    for (std::size_t look = 0; look < looks.size(); ++look) {
      add(type, look, std::nullopt, grammar.anywhere);
      for (const auto& [place, share] : grammar.places) add(type, look, place, share);
    }
  for (PersonRule& rule : rules) rule.prior /= sum;
  return rules;
}

const PersonGrammar::Words* words_in(const PersonGrammar& grammar, const std::string& utterance) {
  for (const PersonGrammar::Words& words : grammar.words) {
    const std::string end = " " + words.a + ".";
    if (utterance.size() > end.size() && utterance.compare(utterance.size() - end.size(), end.size(), end) == 0)
      return &words;
  }
  return nullptr;
}

Meaning meaning_of(const PersonRule& rule, const FeatureSpace& space) {
  Meaning meaning(names_of(rule.types, space.object_types), names_of(rule.textures, space.textures));
  if (!rule.place) return meaning;
  meaning.which = Which{*rule.place, std::nullopt, {}};
  if (!by_column(*rule.place)) {
    FeatureSet goal{{}, space.textures};
    std::copy_if(space.object_types.begin(), space.object_types.end(), std::back_inserter(goal.object_types), is_place);
    meaning.which->of = goal;
  }
  return meaning;
}

std::optional<PersonRule> rule_of(const Meaning& meaning, const FeatureSpace& space) {
  if (meaning.sets.size() != 1) return std::nullopt;
  PersonRule rule{numbers_of(meaning.sets.front().object_types, space.object_types),
                  numbers_of(meaning.sets.front().textures, space.textures),
                  {},
                  0};
  if (meaning.which) rule.place = meaning.which->rule;
  if (!(meaning_of(rule, space) == meaning)) return std::nullopt;
  return rule;
}

bool same(const PersonRule& a, const PersonRule& b) {
  return a.types == b.types && a.textures == b.textures && a.place == b.place;
}

Standing standing(const std::vector<Placed>& visible, const FeatureSpace& space) {
  const auto number_in = [](const Names& names, const std::string& name) {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) throw MethodError(fmt::format("a scene with \"{}\", which the feature space lacks", name));
    return static_cast<std::size_t>(at - names.begin());
  };
  Standing scene;
  bool has_goal = false;
  for (const auto& [instance, row, column] : visible) {
    const Thing thing{number_in(space.object_types, instance.object_type), number_in(space.textures, instance.texture),
                      row, column};
    if (is_place(instance.object_type)) {
      scene.goal = thing;
      has_goal = true;
    } else {
      scene.things.push_back(thing);
      scene.ids.push_back(instance.id);
    }
  }
  if (!has_goal) throw MethodError("a scene without a place that things are brought to");
  return scene;
}

std::vector<std::size_t> taken_by(const PersonRule& rule, const std::vector<Thing>& things, const Thing& goal) {
  constexpr double tie = .5;
  std::vector<std::size_t> taken;
  double least = std::numeric_limits<double>::infinity();
  if (rule.place)
    for (const Thing& one : things)
      if (belongs(rule, one)) least = std::min(least, number_of(*rule.place, one, goal));
  for (std::size_t i = 0; i < things.size(); ++i)
    if (belongs(rule, things[i]) && (!rule.place || number_of(*rule.place, things[i], goal) <= least + tie))
      taken.push_back(i);
  return taken;
}

bool takes_plainly(const PersonRule& rule, const std::vector<Thing>& things, const Thing& goal, std::size_t the_one) {
  if (taken_by(rule, things, goal) != std::vector<std::size_t>{the_one}) return false;
  if (!rule.place) return true;
  const double least = number_of(*rule.place, things[the_one], goal);
  const double margin = by_column(*rule.place) ? column_margin : distance_margin;
  for (std::size_t i = 0; i < things.size(); ++i)
    if (i != the_one && belongs(rule, things[i]) && number_of(*rule.place, things[i], goal) < least + margin)
      return false;
  return true;
}

const PersonRule& draw_rule(const std::vector<PersonRule>& rules, RandomStream& random) {
  double left = random.uniform();
  for (const PersonRule& rule : rules)
    if ((left -= rule.prior) < 0) return rule;
  return rules.back();
}

Thing draw_thing(const PersonRule& rule, RandomStream& random) {
  const std::size_t type = any_of(rule.types, random);
  return {type, any_of(rule.textures, random)};
}

std::optional<RivalScene> draw_rivals(const std::vector<PersonRule>& rules, const PersonRule* first, const Thing& goal,
                                      RandomStream& random, const Places& places, int tries) {
  while (tries-- > 0) {
    RivalScene scene;
    for (int i = 0; i < rivals; ++i) {
      scene.rules.push_back(i == 0 && first ? *first : draw_rule(rules, random));
      scene.things.push_back(draw_thing(scene.rules.back(), random));
    }
    const auto singled_out = [&](bool placed) {
      for (std::size_t i = 0; i < scene.rules.size(); ++i)
        for (std::size_t j = 0; j < scene.things.size(); ++j)
          if (i == j ? placed && !takes_plainly(scene.rules[i], scene.things, goal, i)
                     : !scene.rules[i].place && belongs(scene.rules[i], scene.things[j]))
            return false;
      return true;
    };
    if (singled_out(false) && places(scene.things) && singled_out(true)) return scene;
  }
  return std::nullopt;
}

std::optional<NaturalScene> draw_natural(const PersonGrammar& grammar, const PersonGrammar::Words& words,
                                         const PersonRule& rule, const Thing& goal, RandomStream& random,
                                         const Places& places, int tries) {
  const auto types = numbers_of(words.types, grammar.space.object_types);
  while (tries-- > 0) {
    NaturalScene scene;
    for (int i = 0; i < rivals; ++i) {
      const auto& look = grammar.looks[random.below(static_cast<std::uint32_t>(grammar.looks.size()))];
      const std::size_t type = any_of(types, random);
      scene.things.push_back({type, any_of(numbers_of(look.textures, grammar.space.textures), random)});
    }
    const auto held = [&rule](const Thing& one) { return belongs(rule, one); };
    if (std::none_of(scene.things.begin(), scene.things.end(), held) || !places(scene.things)) continue;
    const std::vector<std::size_t> taken = taken_by(rule, scene.things, goal);
    if (rule.place && !takes_plainly(rule, scene.things, goal, taken.front())) continue;
    scene.taken = taken[random.below(static_cast<std::uint32_t>(taken.size()))];
    return scene;
  }
  return std::nullopt;
}

std::vector<Person> draw_persons(const PersonGrammar& grammar, std::uint64_t seed, int first, int count) {
  std::vector<Person> persons;
  std::vector<std::vector<PersonRule>> rules;
  for (const PersonGrammar::Words& words : grammar.words) rules.push_back(rules_of(grammar, words.types));
  for (int k = first; k < first + count; ++k) {
    RandomStream random(fmt::format("persons/{}/{}", seed, k));
    const std::size_t w = static_cast<std::size_t>(k) % grammar.words.size();
    const auto scene = draw_rivals(
        rules[w], nullptr, plain_goal, random,
        [&random](std::vector<Thing>& things) { return place_plainly(things, random); },
        std::numeric_limits<int>::max());
    persons.push_back({fmt::format("Bring person {} {}.", k + 1, grammar.words[w].a), scene->rules.front()});
  }
  return persons;
}

// In random order, since those that come later stand farther out.
bool place_plainly(std::vector<Thing>& things, RandomStream& random) {
  constexpr double apart = 38, from_goal = 60, from_edge = 15, rows = 128, columns = 256;
  std::vector<const Thing*> placed;
  for (const int i : random.permutation(static_cast<int>(things.size()))) {
    Thing& thing = things[static_cast<std::size_t>(i)];
    const auto near = [&thing](const Thing& other, double least) {
      return std::hypot(thing.row - other.row, thing.column - other.column) < least;
    };
    do {
      thing.row = random.uniform(from_edge, rows - from_edge);
      thing.column = random.uniform(from_edge, columns - from_edge);
    } while (near(plain_goal, from_goal) ||
             std::any_of(placed.begin(), placed.end(), [&](const Thing* other) { return near(*other, apart); }));
    placed.push_back(&thing);
  }
  return true;
}

}  // namespace lgabench::drawn

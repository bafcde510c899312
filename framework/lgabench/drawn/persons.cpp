#include <lgabench/drawn/persons.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <lgabench/core/contains.hpp>

namespace lgabench::drawn {
namespace {

using Place = Which::Rule;
using Names = std::vector<std::string>;
constexpr double column_margin = 20, distance_margin = 25;  // pixels

Names names_of(const std::bitset<PersonRule::most>& bits, const Names& space) {
  Names names;
  for (std::size_t i = 0; i < space.size(); ++i)
    if (bits[i]) names.push_back(space[i]);
  return names;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
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

std::bitset<PersonRule::most> numbers_of(const Names& names, const Names& space) {
  std::bitset<PersonRule::most> bits;
  for (const std::string& name : names)
    if (const auto at = std::find(space.begin(), space.end(), name); at != space.end())
      bits.set(static_cast<std::size_t>(at - space.begin()));
  return bits;
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
  const PersonGrammar::Hint* const hint = hint_in(grammar, utterance);
  for (const PersonGrammar::Words& words : grammar.words)
    if (ends_with(utterance, " " + words.a + "." + (hint ? " " + hint->says : ""))) return &words;
  return nullptr;
}

const PersonGrammar::Hint* hint_in(const PersonGrammar& grammar, const std::string& utterance) {
  for (const PersonGrammar::Hint& hint : grammar.hints)
    for (const std::string& words : hint.words)
      if (ends_with(utterance, " " + words + ". " + hint.says)) return &hint;
  return nullptr;
}

bool leaves(const PersonGrammar::Hint& hint, const PersonRule& rule) {
  return (hint.types.empty() || contains(hint.types, rule.types)) &&
         (hint.textures.empty() || contains(hint.textures, rule.textures)) &&
         (hint.places.empty() || (rule.place && contains(hint.places, *rule.place)));
}

std::vector<PersonRule> left_by(const PersonGrammar::Hint& hint, std::vector<PersonRule> rules) {
  rules.erase(
      std::remove_if(rules.begin(), rules.end(), [&hint](const PersonRule& rule) { return !leaves(hint, rule); }),
      rules.end());
  double sum = 0;
  for (const PersonRule& rule : rules) sum += rule.prior;
  for (PersonRule& rule : rules) rule.prior /= sum;
  return rules;
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
  if (meaning.sets.size() != 1 || !meaning.turns.empty()) return std::nullopt;
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

std::vector<Person> draw_persons(const PersonGrammar& grammar, std::uint64_t seed, int first, int count, bool hinted) {
  std::vector<Person> persons;
  std::vector<std::vector<PersonRule>> rules;
  for (const PersonGrammar::Words& words : grammar.words) rules.push_back(rules_of(grammar, words.types));
  for (int k = first; k < first + count; ++k) {
    RandomStream random(fmt::format("persons{}/{}/{}", hinted ? "_hints" : "", seed, k));
    const std::size_t w = static_cast<std::size_t>(k) % grammar.words.size();
    Person person{fmt::format("Bring person {} {}.", k + 1, grammar.words[w].a), {}};
    Names says;
    do {
      const auto scene = draw_rivals(
          rules[w], nullptr, plain_goal, random,
          [&random](std::vector<Thing>& things) { return place_plainly(things, random); },
          std::numeric_limits<int>::max());
      person.rule = scene->rules.front();
      for (const PersonGrammar::Hint& hint : grammar.hints)
        if (contains(hint.words, grammar.words[w].a) && leaves(hint, person.rule)) says.push_back(hint.says);
    } while (hinted && says.empty());
    if (hinted) person.utterance += " " + says[random.below(static_cast<std::uint32_t>(says.size()))];
    persons.push_back(std::move(person));
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

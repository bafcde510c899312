#include <lgabench/drawn/grammar.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/drawn/phrases.hpp>

namespace lgabench::drawn {
namespace {

// Letters of a compound command: M a look, X an exception, C an exception with an exception of its own (2 parts), U an
// alternative, of which each side has a look (with these 4 parts), R a relation, O an order. The first noun is a part.
const std::vector<std::string>& compound_forms(int parts) {
  static const std::vector<std::string> forms[]{
      {"MX", "MR", "MO", "XX", "XR", "XO", "C"},
      {"U", "MXX", "MXR", "MXO", "XXR", "XXO", "MC", "CR", "CO"},
      {"UR", "UO", "MXXR", "MXXO", "MCR", "MCO"},
  };
  if (parts < fewest_parts || parts > most_parts)
    throw InputError(fmt::format("parts: expected {} to {}, got {}", fewest_parts, most_parts, parts));
  return forms[parts - fewest_parts];
}

constexpr std::uint32_t relations = 6;  // rules before first_in

// Draws one at a time, each in a statement of its own: the order of a call's arguments is the compiler's.
struct Grammar {
  const Lexicon& lexicon;
  RandomStream& random;

  template <class T>
  const T& any(const std::vector<T>& all) {
    return all[random.below(static_cast<std::uint32_t>(all.size()))];
  }
  const Things& name_or_class() { return any(random.coin() ? lexicon.names : lexicon.classes); }
  // Of a type that is drawn first: kinds with many words, such as letters, come no more often than others.
  const Things& class_of_a_type() {
    while (true) {
      const std::string& type = any(lexicon.space.object_types);
      std::vector<const Things*> classes;
      for (const Things& one : lexicon.classes)
        if (std::count(one.types.begin(), one.types.end(), type) > 0) classes.push_back(&one);
      if (!classes.empty()) return *any(classes);
    }
  }
  const Look& look(bool named) {
    while (true)
      if (const Look& one = any(lexicon.looks); one.named == named) return one;
  }
  Phrase of(const Things& things) { return phrase(lexicon.space, things); }
  // A look behind a name; behind a class as a clause of its own, since its words may end in any way.
  Phrase of(const Things& things, const Look& look) {
    const bool is_name = &things >= lexicon.names.data() && &things < lexicon.names.data() + lexicon.names.size();
    return with(lexicon.space, of(things), look, !is_name);
  }
  Exception exception() {
    return random.coin() ? except(lexicon.space, name_or_class()) : except(lexicon.space, look(false));
  }
  Rule described_relation() {
    const auto rule = static_cast<Which::Rule>(random.below(relations));
    return relation(lexicon.space, rule, any(lexicon.classes));
  }

  // One or the other; a careless reading crosses them. Nothing where one holds all of the other.
  std::optional<Phrase> alternative(bool described) {
    const Things& a = described || random.coin() ? class_of_a_type() : any(lexicon.names);
    const Things& b = described || random.coin() ? class_of_a_type() : any(lexicon.names);
    const Look& look_a = look(!described && random.coin());
    const Look& look_b = look(!described && random.coin());
    const Phrase left = of(a, look_a), right = of(b, look_b), a_as_b = of(a, look_b), b_as_a = of(b, look_a);
    if (is_empty(both(left.holds, none_of(right.holds))) || is_empty(both(right.holds, none_of(left.holds)))) return {};
    const auto joined = [](const char* before, const std::string& x, const char* between, const std::string& y) {
      return x.empty() || y.empty() ? "" : before + x + between + y;
    };
    Phrase made{joined("either ", left.a, " or ", right.a),
                joined("", left.many, " and the ", right.many),
                either(left.holds, right.holds),
                {a_as_b.holds, b_as_a.holds},
                left.why};
    made.why.insert(made.why.end(), right.why.begin(), right.why.end());
    return made;
  }
};

// The order's names that things may have which are meant; nothing where these have others, or all the same.
std::optional<std::vector<std::string>> order_within(const std::vector<std::string>& order,
                                                     const std::vector<FeatureSet>& sets, const FeatureSpace& space) {
  const bool textures =
      std::all_of(order.begin(), order.end(), [&](const auto& name) { return contains(space.textures, name); });
  std::vector<std::string> within;
  for (const FeatureSet& set : sets)
    for (const std::string& name : textures ? set.textures : set.object_types)
      if (!contains(order, name)) return {};
  for (const std::string& name : order)
    if (std::any_of(sets.begin(), sets.end(),
                    [&](const FeatureSet& set) { return contains(textures ? set.textures : set.object_types, name); }))
      within.push_back(name);
  if (within.size() < 2) return {};
  return within;
}

// Nothing where a part says nothing, or nobody would say it so.
std::optional<DrawnCommand> command(const FeatureSpace& space, const Phrase& phrase, std::optional<Rule> rule) {
  if ((rule ? phrase.many : phrase.a).empty() || (rule && rule->words.empty())) return {};
  DrawnCommand made;
  made.utterance =
      rule ? fmt::format("Of the {}, bring me {}.", phrase.many, rule->words) : fmt::format("Bring me {}.", phrase.a);
  made.meaning.sets = sets_of(space, phrase.holds, Holds::yes);
  if (made.meaning.sets.empty()) return {};
  made.undecided = sets_of(space, phrase.holds, Holds::undecided);
  made.why = phrase.why;
  const Extent others = where(phrase.holds, Holds::no);
  for (const Extent& near : phrase.near) {
    const Extent wrong = both(where(near, Holds::yes), others);
    if (is_empty(wrong)) return {};
    for (FeatureSet& set : sets_of(space, wrong, Holds::yes))
      if (!contains(made.near_misses, set)) made.near_misses.push_back(std::move(set));
  }
  if (!rule) return made;
  Which& which = rule->which;
  if (which.of) {
    const Extent taken_for_it = of_types(space, which.of->object_types, rule->undecided);
    for (std::size_t i = 0; i < taken_for_it.size(); ++i)
      if (taken_for_it[i] != Holds::no && phrase.holds[i] != Holds::no) return {};
    for (FeatureSet& set : sets_of(space, taken_for_it, Holds::undecided)) made.undecided.push_back(std::move(set));
  }
  if (which.rule == Which::Rule::first_in) {
    auto order = order_within(which.order, made.meaning.sets, space);
    if (!order) return {};
    which.order = std::move(*order);
  }
  made.meaning.which = which;
  made.why.insert(made.why.end(), rule->why.begin(), rule->why.end());
  return made;
}

// A form of the family, of which make() draws one command after the other. What it leaves open is drawn again until
// every part counts, which would favour large classes: so the noun is the form's.
struct Form {
  std::string family, letters;   // letters: of a compound command
  std::uint32_t number = 0;      // which rule, or which of two ways to make one
  const Things* head = nullptr;  // what the command is about; a union draws its own two
};

Form any_form(Grammar& grammar, const std::string& family, int parts) {
  Form form{family, "", grammar.random.below(family == "relation" ? relations : 2), nullptr};
  bool by_name = family == "lookup" || family == "colour" || (family == "superlative" && form.number == 1);
  if (family == "compound") {
    form.letters = grammar.any(compound_forms(parts));
    by_name = grammar.random.below(4) == 0;
  }
  if (family == "relation" || (family == "negation" && form.number == 0)) by_name = grammar.random.coin();
  form.head = by_name ? &grammar.any(grammar.lexicon.names) : &grammar.class_of_a_type();
  return form;
}

std::optional<DrawnCommand> make_compound(Grammar& grammar, const Things& head, const std::string& letters) {
  const auto has = [&letters](char letter) { return letters.find(letter) != std::string::npos; };
  const FeatureSpace& space = grammar.lexicon.space;
  std::optional<Rule> rule;
  if (has('R')) rule = grammar.described_relation();
  if (has('O')) {
    const Order& order = grammar.any(grammar.lexicon.orders);
    rule = comparison(order, grammar.random.coin());
  }
  if (has('U')) {
    const auto phrase = grammar.alternative(true);
    return phrase ? command(space, *phrase, rule) : std::nullopt;
  }
  Phrase phrase = has('M') ? grammar.of(head, grammar.look(false)) : grammar.of(head);
  std::vector<Exception> exceptions;
  for (const char letter : letters) {
    if (letter == 'X') exceptions.push_back(grammar.exception());
    if (letter != 'C') continue;
    const Look& look = grammar.look(false);
    const Things& spared = grammar.name_or_class();
    const Exception one = except(space, look);
    if (is_empty(both(phrase.holds, both(one.holds, of_types(space, spared.types, {}))))) return {};
    exceptions.push_back(unless(space, one, spared));
  }
  if (!exceptions.empty()) phrase = without(std::move(phrase), exceptions, rule.has_value());
  return command(space, phrase, rule);
}

std::optional<DrawnCommand> make(Grammar& grammar, const Form& form) {
  const Lexicon& lexicon = grammar.lexicon;
  const FeatureSpace& space = lexicon.space;
  const Things& head = *form.head;
  if (form.family == "lookup") {
    const Look& look = grammar.look(true);
    Phrase phrase = grammar.of(head, look);
    phrase.near.push_back(
        both(none_of(of_types(space, head.types, head.undecided)), of_textures(space, look.textures, {})));
    return command(space, phrase, {});
  }
  if (form.family == "category") return command(space, grammar.of(head), {});
  if (form.family == "colour") return command(space, grammar.of(head, grammar.look(false)), {});
  if (form.family == "negation") {
    Phrase phrase = grammar.of(head);
    phrase.near.clear();
    const Exception one =
        form.number == 0 ? except(space, grammar.look(false)) : except(space, grammar.name_or_class());
    return command(space, without(std::move(phrase), {one}, false), {});
  }
  if (form.family == "union") {
    const auto phrase = grammar.alternative(false);
    return phrase ? command(space, *phrase, {}) : std::nullopt;
  }
  if (form.family == "compound") return make_compound(grammar, head, form.letters);
  if (form.family == "relation") {
    Phrase phrase = grammar.of(head);
    phrase.near.clear();  // a second thing that belongs is what misleads
    return command(space, phrase, relation(space, static_cast<Which::Rule>(form.number), grammar.name_or_class()));
  }
  const Order& order = grammar.any(lexicon.orders);
  const bool by_colour = form.number == 1;
  if (order.of_textures != by_colour) return {};
  Phrase phrase = by_colour ? grammar.of(head, grammar.look(false)) : grammar.of(head);
  phrase.near.clear();
  return command(space, phrase, comparison(order, grammar.random.coin()));
}

}  // namespace

const std::vector<std::string>& families() {
  static const std::vector<std::string> all{"lookup", "category", "colour",      "negation",
                                            "union",  "relation", "superlative", "compound"};
  return all;
}

std::optional<DrawnCommand> make_command(const Lexicon& lexicon, const std::string& family, int parts,
                                         RandomStream& random) {
  constexpr int forms = 200, draws = 200;
  Grammar grammar{lexicon, random};
  for (int i = 0; i < forms; ++i) {
    const Form form = any_form(grammar, family, parts);
    for (int j = 0; j < draws; ++j)
      if (auto made = make(grammar, form)) {
        made->family = family;
        return made;
      }
  }
  return {};
}

}  // namespace lgabench::drawn

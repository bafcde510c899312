// Persons who do not say all that they want: which rules there are, how likely each is, and what it takes in a scene.
#pragma once
#include <bitset>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/meaning.hpp>
#include <lgabench/core/random.hpp>

namespace lgabench::drawn {

/// A rule's types, its textures and which of several that belong; a value, quick to compare with many scenes.
struct PersonRule {
  static constexpr std::size_t most = 128;  // of a space's types, and of its textures
  std::bitset<most> types, textures;        // by their numbers in the space
  std::optional<Which::Rule> place;         // leftmost, rightmost, or nearest_to and farthest_from the goal
  double prior = 0;                         // all rules of the same words add up to 1
};

/// What a rule tells objects of a scene apart by.
struct Thing {
  std::size_t type = 0, texture = 0;  // numbers in the space
  double row = 0, column = 0;         // of its centre in the picture, in pixels
};

/// Words with the types that they hold, looks that a rule may ask for, and how likely a rule is.
struct PersonGrammar {
  struct Words {
    std::string a;  // "a fruit"
    std::vector<std::string> types;
  };
  struct Look {
    std::string is;  // "striped"
    std::vector<std::string> textures;
  };
  /// What a person may say of their rule: it leaves rules that have one of these parts.
  struct Hint {
    std::string says;                // "I am having soup."
    std::vector<std::string> words;  // beside which it is said
    std::vector<std::bitset<PersonRule::most>> types, textures;
    std::vector<Which::Rule> places;
  };
  FeatureSpace space;
  std::vector<Words> words;
  std::vector<Look> looks;
  std::vector<Hint> hints;
  double all = 0, one = 0, two = 0;    // of types
  double any = 0, is = 0, is_not = 0;  // of looks
  double anywhere = 0;                 // no place; the others' shares:
  std::vector<std::pair<Which::Rule, double>> places;
};

/// A grammar's file (persons.json). @throws InputError with file and place, also for names that fit nothing, words with
/// fewer than three types, shares of a prior that do not add up to 1, and hints that leave no rule of their words.
PersonGrammar read_person_grammar(const Json& json, const FeatureSpace& space, const std::string& file);
/// The shipped one, which is part of this library: a method's process reads no files.
const Json& person_grammar_json();
/// The shipped one, in that space, of which other names are left out. Made once for each space.
const PersonGrammar& person_grammar(const FeatureSpace& space);

/// Numbers in the space of those of the names that it has.
std::bitset<PersonRule::most> numbers_of(const std::vector<std::string>& names, const std::vector<std::string>& space);
/// All rules of words that hold these types, with their priors.
std::vector<PersonRule> rules_of(const PersonGrammar& grammar, const std::vector<std::string>& types);
/// "Bring me a fruit." in the grammar: the first words that the utterance ends with, or has before a hint; nothing
/// where none are.
const PersonGrammar::Words* words_in(const PersonGrammar& grammar, const std::string& utterance);
/// The hint that the utterance ends with; nothing where it has none.
const PersonGrammar::Hint* hint_in(const PersonGrammar& grammar, const std::string& utterance);
bool leaves(const PersonGrammar::Hint& hint, const PersonRule& rule);
/// The rules that the hint leaves; their priors add up to 1 again.
std::vector<PersonRule> left_by(const PersonGrammar::Hint& hint, std::vector<PersonRule> rules);
/// The rule as a scenario or a Selection has it, and back; nothing for what is not such a rule.
Meaning meaning_of(const PersonRule& rule, const FeatureSpace& space);
std::optional<PersonRule> rule_of(const Meaning& meaning, const FeatureSpace& space);
/// Whether both rules take the same objects by the same place; the prior does not count.
bool same(const PersonRule& a, const PersonRule& b);

/// Objects of a scene as rules see them, with what they are brought to.
struct Standing {
  std::vector<Thing> things;
  Thing goal;
  std::vector<std::uint8_t> ids;  // of the things
};
/// @throws MethodError for an object that the space lacks, or a scene without a goal.
Standing standing(const std::vector<Placed>& visible, const FeatureSpace& space);

/// Numbers of the things that the rule takes, as grounded() has it: all that belong or, with a place, the one, and
/// those within half a pixel of it. `goal` is where things are brought to.
std::vector<std::size_t> taken_by(const PersonRule& rule, const std::vector<Thing>& things, const Thing& goal);
/// Whether the rule takes the thing `the_one` alone, and no other that belongs is so near to it that a reader
/// could doubt it (20 pixels of columns, 25 of distances; protocol, section 3).
bool takes_plainly(const PersonRule& rule, const std::vector<Thing>& things, const Thing& goal, std::size_t the_one);

/// One of the rules, as likely as its prior says.
const PersonRule& draw_rule(const std::vector<PersonRule>& rules, RandomStream& random);
/// Any object that the rule lets belong, type and texture with equal odds.
Thing draw_thing(const PersonRule& rule, RandomStream& random);

inline constexpr int rivals = 5;  // objects of a scene
/// Gives things their places in the picture; false where it finds no room.
using Places = std::function<bool(std::vector<Thing>& things)>;
/// Places things on a table of 128 x 256 pixels, as far apart as wide objects must stand, with the goal at plain_goal.
bool place_plainly(std::vector<Thing>& things, RandomStream& random);
inline constexpr Thing plain_goal{0, 0, 64, 205};

/// Things of which number i is plainly the one that rule i takes, and no other rule of them.
struct RivalScene {
  std::vector<PersonRule> rules;
  std::vector<Thing> things;
};
/// All rules are drawn, but the first where it is given; nothing after so many tries.
std::optional<RivalScene> draw_rivals(const std::vector<PersonRule>& rules, const PersonRule* first, const Thing& goal,
                                      RandomStream& random, const Places& places, int tries);

/// Things that the words hold, in looks with equal odds, of which someone takes one.
struct NaturalScene {
  std::vector<Thing> things;
  std::size_t taken = 0;  // any of those that the rule takes
};
/// Drawn until the rule takes one, plainly where it is one by its place; nothing after so many tries.
std::optional<NaturalScene> draw_natural(const PersonGrammar& grammar, const PersonGrammar::Words& words,
                                         const PersonRule& rule, const Thing& goal, RandomStream& random,
                                         const Places& places, int tries);

/// Someone with words and a rule.
struct Person {
  std::string utterance;
  PersonRule rule;
};
/// The seed's persons number `first` to `first + count - 1`, words in turn. Each is the first of the rules in a scene
/// of rivals, so that in such scenes no rule is likelier the person's than its rivals are. Hinted: each has a rule that
/// a hint leaves, and says one of these hints after the words.
std::vector<Person> draw_persons(const PersonGrammar& grammar, std::uint64_t seed, int first, int count,
                                 bool hinted = false);

}  // namespace lgabench::drawn

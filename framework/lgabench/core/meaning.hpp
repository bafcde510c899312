// The meaning of a command's words, or of a Selection: sets of objects, and which of several is meant.
#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/feature_space.hpp>
#include <lgabench/core/observation.hpp>

namespace lgabench {

/// Which one is meant of several visible objects that belong to a meaning.
struct Which {
  enum class Rule {
    left_of,        // of those whose centre lies in a smaller column than a reference's, the nearest to it
    right_of,       // likewise, in a larger column
    nearest_to,     // the least distance between its centre and a reference's
    farthest_from,  // the greatest
    leftmost,       // the smallest column
    rightmost,      // the largest
    first_in        // whose object type, or texture, comes first in `order`
  };
  Rule rule = Rule::leftmost;
  std::optional<FeatureSet> of;    // the references; for the first four rules alone
  std::vector<std::string> order;  // object types or textures of the space, each once; for first_in alone

  bool needs_reference() const { return rule <= Rule::farthest_from; }
};
bool operator==(const Which& a, const Which& b);
std::string to_string(Which::Rule rule);

/// One of an object's two names.
enum class Part { object_type, texture };
std::string to_string(Part part);

/// One of the things that a command wants done, one after the other: which objects are taken, and how many of them.
struct Turn {
  std::vector<FeatureSet> sets;       // one at least
  std::optional<int> take;            // so many, 1 at least; none: until no other object on the table could join
  std::vector<Part> same, different;  // in what all that the turn takes are alike, in what each two differ
  bool only_if_nothing = false;       // left out if the turn before found something; never in the first
};
bool operator==(const Turn& a, const Turn& b);

/// A union of products of object types and textures and, where the words say so, which of several objects is meant, or
/// how they are used in turn (core/turns.hpp). One product without either is a meaning of the paper (section 3.1).
struct Meaning {
  std::vector<FeatureSet> sets{1};  // one at least; with turns, those of all turns, each once
  std::optional<Which> which;
  std::vector<Turn> turns = {};  // empty: nothing is said of it; never together with `which`

  Meaning() = default;
  Meaning(FeatureSet product) : sets{std::move(product)} {}
  Meaning(std::vector<std::string> object_types, std::vector<std::string> textures)
      : sets{{std::move(object_types), std::move(textures)}} {}

  bool is_product() const { return sets.size() == 1 && !which && turns.empty(); }
  /// The one product. @throws MethodError where there is more to the meaning.
  FeatureSet& product();
  const FeatureSet& product() const;
  /// Whether the object is in any of the sets. Which of several is meant depends on the scene, and with turns on what
  /// was brought: grounded().
  bool belongs(const std::string& object_type, const std::string& texture) const;
  /// Whether no object can belong.
  bool empty() const;
};
bool operator==(const Meaning& a, const Meaning& b);
/// The meaning of those turns, one at least.
Meaning in_turns(std::vector<Turn> turns);
/// The meaning with each of its sets changed, in its turns too; `change` is also told the set's number in `sets`.
Meaning with_each_set(Meaning meaning, const std::function<FeatureSet(const FeatureSet&, std::size_t)>& change);

/// The object's place in the order of `which`, from 0, or the order's length for an object that it does not name. A
/// name may be both an object type and a texture: the order is of the kind of which the sets hold more of its names.
/// @pre the rule is first_in
std::size_t place_in_order(const Meaning& meaning, const std::string& object_type, const std::string& texture);

/// A visible instance and the mean row and column of its visible pixels.
struct Placed {
  Instance instance;
  double row = 0, column = 0;
};
/// All visible instances of an observation, in the table's order.
std::vector<Placed> placed(const Observation& observation);

/// Ids of the visible instances that are meant, in the table's order. Without `which`, all that belong are meant. With
/// it, the one that the rule names is meant, and those within half a pixel of it or of the same place in `order`. A
/// centre is the mean row and column of an instance's visible pixels. Instances that match `of` are references and no
/// candidates; each candidate counts from its nearest reference. Where a rule has no reference in view, nothing is
/// meant. Place types (`is_place`) are no candidates of a rule. With turns, those are meant that are wanted() now: of
/// what is visible and what was brought, as they are named.
std::vector<std::uint8_t> grounded(const Meaning& meaning, const Observation& observation);
std::vector<std::uint8_t> grounded(const Meaning& meaning, const std::vector<Placed>& visible,
                                   const std::vector<Named>& brought = {});

/// Whether the object type is that of the place which things are brought to. A rule never means a place.
bool is_place(const std::string& object_type);

/// One product is written as a FeatureSet, a meaning with turns as {"turns": [{"sets", "take", "same", "different",
/// "only_if_nothing"}, ...]}, any other as {"sets": [...], "which": {"rule", "of", "order"}}.
Json to_json(const Meaning& meaning);

/// Reads what to_json() writes; in lists also "ALL" and {"except": [...]}. @throws InputError with file and place for
/// a name that the space lacks or that is given twice, an unknown rule, a rule without what it needs or with more, an
/// order of object types and textures both, more than 100 sets, no turn or more than 10, a number below 1, a first turn
/// that needs one before it, or objects that are both alike and not in a part.
Meaning read_meaning(const JsonReader& reader, const FeatureSpace& space);

/// Refuses turns that ask for more than there can be: more objects, all of different types, than the sets have types.
/// `reader` is where the meaning was read. @throws InputError with file and place.
void expect_possible(const Meaning& meaning, const JsonReader& reader);

/// Reads a method's meaning, whose names nobody has checked against a space.
Meaning read_unchecked_meaning(const JsonReader& reader);

}  // namespace lgabench

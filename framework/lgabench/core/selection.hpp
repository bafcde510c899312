// The Selection: which features matter, who said so, and what asking them cost.
#pragma once
#include <optional>
#include <string>

#include <lgabench/core/meaning.hpp>

namespace lgabench {

/// Where a Selection comes from.
enum class Provenance {
  none,            // the method selects nothing (GCBC)
  rule,            // the method's own computation: nobody was asked
  recorded,        // a language model's published or recorded answers
  live,            // a language model asked during this run
  cassette,        // a live model's replies, replayed
  truth,           // the true distribution: an upper bound, no human data
  simulated_edit,  // a language model's answers corrected by rule: no human data
  human            // a person's answers
};
std::string to_string(Provenance provenance);
/// @throws InputError for an unknown word.
Provenance provenance_from(const std::string& word);

/// What making a Selection cost. Seconds of a recorded answer are unknown and stay 0.
struct SelectionCost {
  int lm_queries = 0;
  long long lm_tokens = 0;
  double lm_seconds = 0;
  double human_seconds = 0;
  int human_queries = 0;  // objects that a person was shown, to say whether they would take it
};
SelectionCost& operator+=(SelectionCost& cost, const SelectionCost& more);
SelectionCost operator-(const SelectionCost& all, const SelectionCost& before);

/// A second set of objects that a task's commands speak of beside the target: what must be avoided, what to put it on.
struct SecondRole {
  std::string id;      // "avoid": its name in JSON, in questions and in a Selection's text
  std::string phrase;  // "the object to be avoided": its name in prompts
};

/// What a method is told of the task: the words, and the kind of motion that is wanted.
struct Command {
  std::string utterance;
  std::string task;                                 // an id of the environment's list
  std::optional<SecondRole> second = std::nullopt;  // what it speaks of beside the target; none for most tasks
  bool may_stop = false;  // whether it may say how objects are used in turn (Scenario::may_stop)
};

/// The features of a task's second set.
struct SecondSet : FeatureSet {
  std::string role;  // SecondRole::id
};
bool operator==(const SecondSet& a, const SecondSet& b);

/// Feature abstraction phi -> phi-hat (paper, section 3.1). `second` describes the task's second set of objects; absent
/// for tasks that have none.
struct Selection {
  Meaning target;
  std::optional<SecondSet> second;
  Provenance provenance = Provenance::none;
  std::string source;    // model, participant or file
  std::string asked_as;  // the wording that was answered
  SelectionCost cost;

  /// Whether nothing can be shown: the target is empty, or the task's second set is. Such a cell is not trained.
  bool empty() const { return target.empty() || (second && second->empty()); }
  /// Whether the target, or the second set, names both of the object's features. With `target.which`, and
  /// with its turns, the objects that a goal mask keeps depend on the scene as well: see grounded().
  bool belongs(const std::string& object_type, const std::string& texture) const {
    return target.belongs(object_type, texture) || (second && second->contains(object_type, texture));
  }
};

Json to_json(const Selection& selection);

/// The distribution alone, which is what scenes depend on: {"target": meaning}, and the second set under its role's id.
Json distribution_json(const Selection& selection);
/// The distribution of a Selection that to_json() wrote.
Json distribution_of(Json selection);

/// Reads a distribution whose second set, if it has one, is named as `second` says; provenance and cost are left at
/// their defaults. @throws InputError for another member.
Selection read_distribution(const JsonReader& reader, const FeatureSpace& space,
                            const std::optional<SecondRole>& second);

}  // namespace lgabench

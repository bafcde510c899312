// The Selection: which features matter, by whom it was said, and what that cost.
#pragma once
#include <optional>
#include <string>

#include <lgabench/core/feature_space.hpp>

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
};
SelectionCost& operator+=(SelectionCost& cost, const SelectionCost& more);
SelectionCost operator-(const SelectionCost& all, const SelectionCost& before);

/// Feature abstraction phi -> phi-hat (paper, section 3.1). For sweep, `avoid` describes the obstacle.
struct Selection {
  FeatureSet target;
  std::optional<FeatureSet> avoid;
  Provenance provenance = Provenance::none;
  std::string source;    // model, participant or file
  std::string asked_as;  // the wording that was answered
  SelectionCost cost;

  /// Nothing can be shown: no target, or an obstacle asked for and none selected. Such a cell is not trained.
  bool empty() const { return target.empty() || (avoid && avoid->empty()); }
  /// The object is kept in the goal mask. Types and textures of target and avoid are never crossed.
  bool keeps(const std::string& object_type, const std::string& texture) const {
    return target.contains(object_type, texture) || (avoid && avoid->contains(object_type, texture));
  }
};

Json to_json(const Selection& selection);

/// The distribution alone (target and avoid), which is what scenes depend on.
Json distribution_json(const Selection& selection);

/// Reads {"target": set, "avoid": set?}; provenance and cost are left at their defaults.
Selection read_distribution(const JsonReader& reader, const FeatureSpace& space);

}  // namespace lgabench

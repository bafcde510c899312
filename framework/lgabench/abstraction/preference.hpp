// Learns what a person prefers and did not say from what they take (after Peng et al., HRI 2024).
#pragma once
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/method.hpp>

namespace lgabench {

/// What the words say and what could stand behind them, weighed by what the person took. The words have the prior of a
/// hypothesis of mean weight, and hypotheses are as likely beside each other as their weights say.
class Preference {
 public:
  /// A candidate with the same objects as an earlier one is left out, and adds to that one's prior. `unlisted` are
  /// candidates that nobody named; together they have a share of the prior.
  Preference(const Meaning& words, const std::vector<Hypothesis>& hypotheses, const FeatureSpace& space,
             const std::vector<Hypothesis>& unlisted = {}, double share = 0);

  /// The person took that instance. P = .95 / number of visible objects that a candidate holds if it is one of them,
  /// else .05 / number of visible objects. Place types are neither.
  void took(const Observation& seen, std::uint8_t instance);
  /// The person said of an object whether they would take it: P = .95 where the candidate says so too, else .05.
  void said(const std::string& object_type, const std::string& texture, bool accepts);

  /// The words first, then the hypotheses in their order.
  const std::vector<Hypothesis>& candidates() const { return candidates_; }
  /// The probability of each candidate; all add up to 1.
  std::vector<double> probabilities() const;
  /// Candidates by number: the likeliest first, of equals the one that holds fewer pairs of the space.
  std::vector<std::size_t> ranked() const;

 private:
  std::vector<Hypothesis> candidates_;
  std::vector<std::ptrdiff_t> pairs_;  // how many of the space each holds
  std::vector<double> logs_;           // of what is proportional to the probabilities
};

/// What preferred() weighs beside the hypotheses of a language model, and how much it asks.
struct Asking {
  int questions = 0;  // at most, to the person
  std::vector<Hypothesis> unlisted{};
  double share = 0;  // of `unlisted`; 1: the model is not asked
};

/// plga: the Selection with the target that explains best what was taken in the command's demonstrations; the Selection
/// itself where their targets are not the person's (Services::shows_truth) or no hypotheses are known, which the log
/// says. At each question the person is shown that visible object of the demonstrations of which it is least certain
/// whether they take it (maximum entropy sampling), until all are certain to 1 in 100. No look is asked about twice.
Selection preferred(const Command& command, const Selection& selected, const FeatureSpace& space,
                    const std::vector<Demonstration>& demonstrations, Services& services, const Asking& asking);

}  // namespace lgabench

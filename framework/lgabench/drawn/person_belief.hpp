// The exact belief about a person's rule: a grammar's rules, weighed by what the person took and said.
#pragma once
#include <optional>
#include <vector>

#include <lgabench/drawn/persons.hpp>

namespace lgabench::drawn {

/// Probabilities of rules. What a person takes is one of those that the rule takes, with equal odds; what they say is
/// wrong with the given probability, any of the other answers with equal odds.
class Belief {
 public:
  explicit Belief(std::vector<PersonRule> rules);

  void took(const Standing& scene, std::size_t one);
  void said(const Standing& scene, std::size_t one, bool would_take, double errs);
  /// "Which of these, or none": one of those, or none.
  void said(const Standing& scene, std::optional<std::size_t> one, double errs);

  const std::vector<PersonRule>& rules() const { return rules_; }
  const std::vector<double>& probabilities() const { return probabilities_; }
  /// The likeliest rule; of equals (1e-9) the narrower, with fewer pairs of type and texture, then the first.
  std::size_t likeliest() const;
  /// How likely the person takes each thing, where one of those that a rule takes is taken with equal odds.
  std::vector<double> takes(const Standing& scene) const;
  /// Bits that an answer is expected to tell of the rule.
  double expected_bits(const Standing& scene, const std::optional<std::size_t>& one, double errs) const;

 private:
  void weigh(const std::vector<double>& likelihoods);

  std::vector<PersonRule> rules_;
  std::vector<double> probabilities_;
};

}  // namespace lgabench::drawn

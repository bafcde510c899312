#include <lgabench/drawn/person_belief.hpp>

#include <cmath>
#include <numeric>
#include <utility>

#include <lgabench/core/contains.hpp>

namespace lgabench::drawn {
namespace {

// Of each answer, how likely the rule makes it: no and yes; or each thing, then none.
std::vector<double> answers(const PersonRule& rule, const Standing& scene, const std::optional<std::size_t>& one,
                            double errs) {
  const std::vector<std::size_t> taken = taken_by(rule, scene.things, scene.goal);
  if (one) return contains(taken, *one) ? std::vector<double>{errs, 1 - errs} : std::vector<double>{1 - errs, errs};
  const std::size_t count = scene.things.size() + 1;
  std::vector<double> all(count, 0);
  const double right = taken.empty() ? 1 : 1 / static_cast<double>(taken.size());
  const auto add = [&](std::size_t said) {
    for (std::size_t i = 0; i < count; ++i)
      all[i] += right * (i == said ? 1 - errs : errs / static_cast<double>(count - 1));
  };
  for (const std::size_t i : taken) add(i);
  if (taken.empty()) add(count - 1);
  return all;
}

double bits(const std::vector<double>& probabilities) {
  double sum = 0;
  for (const double p : probabilities)
    if (p > 0) sum -= p * std::log2(p);
  return sum;
}

}  // namespace

Belief::Belief(std::vector<PersonRule> rules) : rules_(std::move(rules)) {
  for (const PersonRule& rule : rules_) probabilities_.push_back(rule.prior);
}

// What no rule makes possible changes nothing: a person may want what the grammar lacks.
void Belief::weigh(const std::vector<double>& likelihoods) {
  double sum = 0;
  for (std::size_t i = 0; i < rules_.size(); ++i) sum += probabilities_[i] * likelihoods[i];
  if (!(sum > 0)) return;
  for (std::size_t i = 0; i < rules_.size(); ++i) probabilities_[i] *= likelihoods[i] / sum;
}

void Belief::took(const Standing& scene, std::size_t one) {
  std::vector<double> likelihoods;
  for (const PersonRule& rule : rules_) {
    const std::vector<std::size_t> taken = taken_by(rule, scene.things, scene.goal);
    likelihoods.push_back(contains(taken, one) ? 1 / static_cast<double>(taken.size()) : 0);
  }
  weigh(likelihoods);
}

void Belief::said(const Standing& scene, std::size_t one, bool would_take, double errs) {
  std::vector<double> likelihoods;
  for (const PersonRule& rule : rules_) likelihoods.push_back(answers(rule, scene, one, errs)[would_take ? 1 : 0]);
  weigh(likelihoods);
}

void Belief::said(const Standing& scene, std::optional<std::size_t> one, double errs) {
  std::vector<double> likelihoods;
  for (const PersonRule& rule : rules_)
    likelihoods.push_back(answers(rule, scene, std::nullopt, errs)[one.value_or(scene.things.size())]);
  weigh(likelihoods);
}

std::size_t Belief::likeliest() const {
  std::size_t best = 0;
  const auto pairs = [this](std::size_t i) { return rules_[i].types.count() * rules_[i].textures.count(); };
  for (std::size_t i = 1; i < rules_.size(); ++i) {
    const double more = probabilities_[i] - probabilities_[best];
    if (more > 1e-9 || (more > -1e-9 && pairs(i) < pairs(best))) best = i;
  }
  return best;
}

std::vector<double> Belief::takes(const Standing& scene) const {
  std::vector<double> all(scene.things.size(), 0);
  for (std::size_t r = 0; r < rules_.size(); ++r) {
    const std::vector<std::size_t> taken = taken_by(rules_[r], scene.things, scene.goal);
    for (const std::size_t i : taken) all[i] += probabilities_[r] / static_cast<double>(taken.size());
  }
  return all;
}

double Belief::expected_bits(const Standing& scene, const std::optional<std::size_t>& one, double errs) const {
  std::vector<double> all(one ? 2 : scene.things.size() + 1, 0);
  double of_answer = 0;
  for (std::size_t r = 0; r < rules_.size(); ++r) {
    const std::vector<double> said = answers(rules_[r], scene, one, errs);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] += probabilities_[r] * said[i];
    of_answer += probabilities_[r] * bits(said);
  }
  return bits(all) - of_answer;
}

}  // namespace lgabench::drawn

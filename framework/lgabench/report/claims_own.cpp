// A suite's own claims.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <lgabench/core/parallel.hpp>
#include <lgabench/report/about_suite.hpp>
#include <lgabench/report/claims_field.hpp>

namespace lgabench::report {
namespace {

Field only(const Field& field, const std::vector<std::string>& scenarios) {
  if (scenarios.empty()) return field;
  Field some;
  for (const CellResult* cell : field.cells())
    if (std::find(scenarios.begin(), scenarios.end(), cell->scenario) != scenarios.end()) some.add(*cell);
  some.layout = field.layout, some.engine = field.engine;
  return some;
}

Claim measured_claim(const SuiteClaim& own, const Field& all) {
  const Field field = only(all, own.scenarios);
  Claim claim;
  claim.id = own.id, claim.statement = own.statement, claim.refuted_if = own.refuted_if;
  claim.layout = all.layout, claim.engine = all.engine;
  const std::vector<int> every(field.demonstrations.begin(), field.demonstrations.end());
  for (const std::string& arm : own.arms.empty() ? field.arms : own.arms)
    for (const int n : own.demonstrations.empty() ? every : own.demonstrations) {
      if (std::find(field.arms.begin(), field.arms.end(), arm) == field.arms.end()) {
        ClaimedDifference missing;
        missing.above = own.above, missing.below = own.below, missing.arm = arm, missing.demonstrations = n;
        missing.these.reason = missing.alike.reason = "no arm " + arm;
        claim.differences.push_back(missing);
      } else {
        claim.differences.push_back(
            own.test == SuiteClaim::Test::slope
                ? measured_slope(field, own, arm, n)
                : measured(field, own.id, claimed_method(own.above), claimed_method(own.below), arm, n));
      }
    }
  return claim;
}

// By how much a difference is on the claim's side, and its two-sided p that it is on neither: from the interval's width
// where a margin shifts it, as if it were a normal distribution's.
std::pair<double, double> side_of(const SuiteClaim& own, const Change& change) {
  using Test = SuiteClaim::Test;
  if (own.test == Test::ordering || own.test == Test::slope) {
    const Interval& i = change.interval;
    return {i.low > 0 ? i.low : std::min(i.high, 0.0), change.p};
  }
  const double ahead = own.margin - (own.test == Test::equivalence ? std::abs(change.difference) : change.difference);
  const double error = (change.interval.high - change.interval.low) / (2 * z_95);
  if (error <= 0) return {ahead, ahead == 0 ? 1 : 0};
  return {ahead, std::erfc(std::abs(ahead) / error / std::sqrt(2.0))};
}

}  // namespace

std::vector<SuiteClaim> own_claims(const RunResults& run) {
  if (!run.record.claims.is_null()) return read_suite_claims(run.record.claims, "run.json: /claims");
  const fs::path file = installed_suite(run.suite);
  const Json installed = file.empty() ? Json() : claims_beside(file);
  return installed.is_null() ? std::vector<SuiteClaim>() : read_suite_claims(installed, file.string());
}

std::vector<Claim> test_own(const std::vector<SuiteClaim>& own, const Field& field) {
  std::vector<Claim> claims(own.size());
  in_parallel(own.size(), [&](std::size_t i) { claims[i] = measured_claim(own[i], field); });
  for (const auto test : {&ClaimedDifference::these, &ClaimedDifference::alike}) {
    std::vector<double> p;
    std::vector<std::pair<Tested*, double>> tested;
    for (std::size_t i = 0; i < own.size(); ++i)
      for (ClaimedDifference& d : claims[i].differences)
        if (Tested& t = d.*test; t.change) {
          const auto [ahead, p_of_it] = side_of(own[i], *t.change);
          tested.emplace_back(&t, ahead);
          p.push_back(p_of_it);
        }
    const std::vector<double> adjusted = holm(p);
    for (std::size_t k = 0; k < tested.size(); ++k) {
      auto& [t, ahead] = tested[k];
      t->p_holm = adjusted[k];
      t->verdict = adjusted[k] > alpha || ahead == 0 ? Verdict::undecided
                   : ahead > 0                       ? Verdict::held
                                                     : Verdict::reversed;
    }
  }
  for (Claim& claim : claims) conclude(claim, field);
  return claims;
}

}  // namespace lgabench::report

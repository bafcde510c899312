#include <lgabench/statistics/curves.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/environment.hpp>
#include <lgabench/core/parallel.hpp>
#include <lgabench/statistics/pairs.hpp>
#include <lgabench/statistics/summary.hpp>

namespace lgabench::statistics {
namespace {

constexpr double per = .1;  // of p, a slope's

ErrorCurve::Point point_of(const Row& row, double p) {
  const auto empty = row.failures.find(failure::abstraction_empty);
  const double share = empty == row.failures.end() || row.episodes == 0
                           ? 0
                           : static_cast<double>(empty->second) / static_cast<double>(row.episodes);
  return {p, *row.success, row.interval.low, row.interval.high, share, row.index};
}

// A policy's cells, by p.
using Levels = std::map<double, const CellResult*>;
using Policy = std::tuple<std::string, long long, std::string>;  // scenario, training seed, participant

std::map<Policy, Levels> policies_of(const ErrorCurve& curve, const RunResults& run) {
  std::map<Policy, Levels> all;
  for (const CellResult& cell : run.cells) {
    const SelectionErrors& errors = cell.configuration.selection_errors;
    const bool other_kind = (curve.kind == "missing" ? errors.added : errors.missing) != 0;
    if (cell.is_reference() || other_kind || cell.method != curve.method + errors.suffix() ||
        std::tie(cell.layout, cell.engine, cell.demonstrations) !=
            std::tie(curve.layout, curve.engine, curve.demonstrations) ||
        !contains(cell.arms, curve.arm) || cell.ambiguous.count(curve.arm) != 0)
      continue;
    all[{cell.scenario, cell.training_seed, cell.participant}][errors.missing + errors.added] = &cell;
  }
  return all;
}

// Scene by scene the slope of a policy's successes, as paired differences are resampled.
std::optional<Interval> slope_interval(const ErrorCurve& curve, const std::vector<double>& weights,
                                       const RunResults& run) {
  double reach = 0;  // the most that a scene can change it by
  for (const double weight : weights) reach += std::abs(weight);
  PairedRow rows;
  for (const auto& [policy, levels] : policies_of(curve, run)) {
    PolicyPair slopes;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const auto first = levels.find(curve.points.front().p), level = levels.find(curve.points[i].p);
      if (first == levels.end() || level == levels.end() || first->second->failed || level->second->failed) return {};
      PolicyPair pair = pair_policies(*first->second, *level->second, curve.arm);
      if (i == 0) {
        slopes = pair;
        slopes.first.assign(pair.second.size(), 0);
        slopes.second = slopes.first;
      }
      for (std::size_t scene = 0; scene < pair.second.size(); ++scene)
        slopes.second[scene] += weights[i] * pair.second[scene] / reach;
    }
    rows.add(std::get<0>(policy), slopes, std::get<2>(policy));
  }
  if (rows.policies() < 2) return {};
  const Interval interval = rows.change(fmt::format("error_curves/{}/{}/{}/{}/{}/{}", curve.layout, curve.engine,
                                                    curve.arm, curve.method, curve.kind, curve.demonstrations))
                                .interval;
  return Interval{per * reach * interval.low, per * reach * interval.high};
}

}  // namespace

std::vector<ErrorCurve> error_curves(const RunResults& run, const std::vector<Table>& tables) {
  std::vector<ErrorCurve> curves;
  for (const Table& table : tables) {
    const std::size_t first = curves.size();
    for (const Row& row : table.rows) {
      const SelectionErrors& errors = row.errors;
      if (!row.is_mean() || !row.success || errors.none() || (errors.missing != 0 && errors.added != 0)) continue;
      const std::string kind = errors.missing != 0 ? "missing" : "added", method = row.without_errors();
      const auto same = [&](const ErrorCurve& c) {
        return std::tie(c.arm, c.method, c.kind, c.demonstrations) ==
               std::tie(row.arm, method, kind, row.demonstrations);
      };
      auto curve = std::find_if(curves.begin() + static_cast<std::ptrdiff_t>(first), curves.end(), same);
      if (curve == curves.end()) {
        curves.push_back({row.layout, row.engine, row.arm, method, kind, row.demonstrations, {}, 0, {}});
        curve = curves.end() - 1;
        const Row* right = table.find(row.arm, row.scenario, method, row.demonstrations);
        if (right && right->success) curve->points.push_back(point_of(*right, 0));
      }
      curve->points.push_back(point_of(row, errors.missing + errors.added));
    }
  }
  curves.erase(std::remove_if(curves.begin(), curves.end(), [](const auto& c) { return c.points.size() < 2; }),
               curves.end());
  in_parallel(curves.size(), [&](std::size_t i) {
    ErrorCurve& curve = curves[i];
    std::sort(curve.points.begin(), curve.points.end(), [](const auto& a, const auto& b) { return a.p < b.p; });
    std::vector<double> at;
    for (const ErrorCurve::Point& point : curve.points) at.push_back(point.p);
    const std::vector<double> weights = slope_weights(at);
    for (std::size_t k = 0; k < at.size(); ++k) curve.slope += per * weights[k] * curve.points[k].success;
    curve.interval = slope_interval(curve, weights, run);
  });
  return curves;
}

Json to_json(const ErrorCurve& curve) {
  Json points = Json::array();
  for (const auto& [p, success, low, high, empty, row] : curve.points)
    points.push_back({{"p", p}, {"success", success}, {"low", low}, {"high", high}, {"empty", empty}, {"row", row}});
  Json json{{"layout", curve.layout}, {"engine", curve.engine}, {"arm", curve.arm},
            {"method", curve.method}, {"errors", curve.kind},   {"demonstrations", curve.demonstrations},
            {"points", points},       {"slope", curve.slope}};
  if (curve.interval) {
    json["low"] = curve.interval->low;
    json["high"] = curve.interval->high;
  }
  return json;
}

}  // namespace lgabench::statistics

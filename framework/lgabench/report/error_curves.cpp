#include <lgabench/report/error_curves.hpp>

#include <algorithm>
#include <map>
#include <tuple>

#include <lgabench/core/environment.hpp>

namespace lgabench::report {
namespace {

struct Named {
  std::string method;  // without its errors
  SelectionErrors errors;
};

// What rows with errors are rows of, by name.
std::map<std::string, Named> erring_rows(const RunResults& run) {
  std::map<std::string, Named> all;
  for (const CellResult& cell : run.cells) {
    const SelectionErrors& errors = cell.configuration.selection_errors;
    const std::string end = errors.suffix(), &name = cell.method;
    if (errors.none() || name.size() <= end.size() || name.substr(name.size() - end.size()) != end) continue;
    all[name] = {name.substr(0, name.size() - end.size()), errors};
  }
  return all;
}

ErrorCurve::Point point_of(const Row& row, double p) {
  const auto empty = row.failures.find(failure::abstraction_empty);
  const double share = empty == row.failures.end() || row.episodes == 0
                           ? 0
                           : static_cast<double>(empty->second) / static_cast<double>(row.episodes);
  return {p, *row.success, row.interval.low, row.interval.high, share, row.index};
}

double slope_per_tenth(const std::vector<ErrorCurve::Point>& points) {
  const auto n = static_cast<double>(points.size());
  double p = 0, success = 0, both = 0, squares = 0;
  for (const ErrorCurve::Point& point : points) {
    p += point.p / n;
    success += point.success / n;
  }
  for (const ErrorCurve::Point& point : points) {
    both += (point.p - p) * (point.success - success);
    squares += (point.p - p) * (point.p - p);
  }
  return .1 * both / squares;
}

}  // namespace

std::vector<ErrorCurve> error_curves(const RunResults& run, const std::vector<Table>& tables) {
  const std::map<std::string, Named> erring = erring_rows(run);
  std::vector<ErrorCurve> curves;
  for (const Table& table : tables) {
    const std::size_t first = curves.size();
    for (const Row& row : table.rows) {
      const auto named = erring.find(row.method);
      if (!row.is_mean() || !row.success || named == erring.end()) continue;
      const auto& [method, errors] = named->second;
      if (errors.missing != 0 && errors.added != 0) continue;
      const std::string kind = errors.missing != 0 ? "missing" : "added";
      const auto same = [&, &of = method](const ErrorCurve& c) {
        return std::tie(c.arm, c.method, c.kind, c.demonstrations) == std::tie(row.arm, of, kind, row.demonstrations);
      };
      auto curve = std::find_if(curves.begin() + static_cast<std::ptrdiff_t>(first), curves.end(), same);
      if (curve == curves.end()) {
        curves.push_back({row.layout, row.engine, row.arm, method, kind, row.demonstrations, {}, 0});
        curve = curves.end() - 1;
        const Row* right = table.find(row.arm, row.scenario, method, row.demonstrations);
        if (right && right->success) curve->points.push_back(point_of(*right, 0));
      }
      curve->points.push_back(point_of(row, errors.missing + errors.added));
    }
  }
  curves.erase(std::remove_if(curves.begin(), curves.end(), [](const auto& c) { return c.points.size() < 2; }),
               curves.end());
  for (ErrorCurve& curve : curves) {
    std::sort(curve.points.begin(), curve.points.end(), [](const auto& a, const auto& b) { return a.p < b.p; });
    curve.slope = slope_per_tenth(curve.points);
  }
  return curves;
}

Json to_json(const ErrorCurve& curve) {
  Json points = Json::array();
  for (const auto& [p, success, low, high, empty, row] : curve.points)
    points.push_back({{"p", p}, {"success", success}, {"low", low}, {"high", high}, {"empty", empty}, {"row", row}});
  return {{"layout", curve.layout}, {"engine", curve.engine}, {"arm", curve.arm},
          {"method", curve.method}, {"errors", curve.kind},   {"demonstrations", curve.demonstrations},
          {"points", points},       {"slope", curve.slope}};
}

}  // namespace lgabench::report

// Success against a level: of errors that were made in what was selected (abstraction/selection_errors.hpp), and of
// perturbation axes (core/perturbations.hpp).
#pragma once
#include <array>
#include <vector>

#include <lgabench/statistics/results.hpp>
#include <lgabench/statistics/summary.hpp>

namespace lgabench::report {

/// Curves of the mean rows of all tables, those of two points or more: of errors of one kind alone. A point at 0 is the
/// row without errors. In the order of the tables' rows.
std::vector<ErrorCurve> error_curves(const RunResults& run, const std::vector<Table>& tables);

/// Reference rows that have a curve: what could be done at a level.
inline constexpr std::array bound_rows{"oracle", "bound"};

/// Curves of the mean rows of all tables, of methods and of bound_rows: by table, method, demonstrations, then axes as
/// the arms have them.
std::vector<PerturbationCurve> perturbation_curves(const RunResults& run, const std::vector<Table>& tables);

/// What the success in the control, and then at each of these levels, counts in an area: the trapezoids' sides, as
/// shares of the whole. @pre levels grow, from 1 on
std::vector<double> trapezoids(const std::vector<int>& levels);

/// As summary.json has them.
Json to_json(const ErrorCurve& curve);
Json to_json(const PerturbationCurve& curve);

}  // namespace lgabench::report

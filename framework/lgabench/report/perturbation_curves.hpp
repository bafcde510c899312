// Success against the levels of perturbation axes (core/perturbations.hpp): how a policy breaks.
#pragma once
#include <string>
#include <vector>

#include <lgabench/report/results.hpp>
#include <lgabench/report/summary.hpp>

namespace lgabench::report {

/// Reference rows that have a curve: what could be done at a level.
inline constexpr std::array bound_rows{"oracle", "bound"};

/// Curves of the mean rows of all tables, of methods and of bound_rows: by table, method, demonstrations, then axes as
/// the arms have them.
std::vector<PerturbationCurve> perturbation_curves(const RunResults& run, const std::vector<Table>& tables);

/// What the success in the control, and then at each of these levels, counts in an area: the trapezoids' sides, as
/// shares of the whole. @pre levels grow, from 1 on
std::vector<double> trapezoids(const std::vector<int>& levels);

/// As summary.json has it.
Json to_json(const PerturbationCurve& curve);

}  // namespace lgabench::report

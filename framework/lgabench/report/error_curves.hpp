// Success against errors that were made in what was selected (abstraction/selection_errors.hpp): dose and response.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/report/results.hpp>
#include <lgabench/report/summary.hpp>

namespace lgabench::report {

/// Curves of the mean rows of all tables, those of two points or more: of errors of one kind alone. A point at 0 is the
/// row without errors. In the order of the tables' rows.
std::vector<ErrorCurve> error_curves(const RunResults& run, const std::vector<Table>& tables);

/// As summary.json has it.
Json to_json(const ErrorCurve& curve);

}  // namespace lgabench::report

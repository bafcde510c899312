// The sections of a report, and the cells that they share.
#pragma once
#include <array>
#include <string>
#include <vector>

#include <lgabench/core/rounding.hpp>
#include <lgabench/report/report_document.hpp>

namespace lgabench::report {
using namespace document;
using namespace statistics;

// Cells.

/// The method's name, with its mark.
TableCell named(const Material& material, const std::string& method, Emphasis emphasis = Emphasis::none);
/// The JSON pointer to a member of a row, e.g. "/rows/12/shift/low".
std::string place_of(const Row& row, const std::string& member);
/// A count of the row, with its place.
TableCell count_cell(const Row& row, const std::string& member, int count);
/// "0.85 [0.64, 0.95]" as `set` writes each; `place` is the JSON pointer to the object of which these are the members.
TableCell with_interval(double value, const Interval& interval, const std::string& place,
                        const std::array<const char*, 3>& members, std::string (*set)(double),
                        Emphasis emphasis = Emphasis::none);
/// The row's marks, each with its meaning; with "=" where it acted exactly as in the first arm.
Spans marks_spans(const Row& row);
/// A rate and a difference of two as they are set everywhere: "0.85", "+0.10".
inline std::string rate_text(double x) { return fixed(x); }
inline std::string signed_rate(double x) { return signed_text(x); }
/// Letters, digits and dashes of an id, for a file's name.
std::string slug(const std::string& text);

/// What the run's tables of success are of: "Success under covariate shift".
std::string success_title(const Material& material);

// Sections; one without blocks is left out.

Section what_was_run(const Material& material);
std::vector<Section> success(const Material& material);  // one for each table of the summary
Section steps(const Material& material);
Section pairs(const Material& material);
Section regret(const Material& material);
Section perturbations(const Material& material);
Section learning_curves(const Material& material);
Section phi(const Material& material);
Section selection_errors(const Material& material);
Section failures(const Material& material);
Section attribution(const Material& material);
Section engines(const Material& material);
Section times(const Material& material);
Section failed_cells(const Material& material);
Section provenance(const Material& material);

}  // namespace lgabench::report

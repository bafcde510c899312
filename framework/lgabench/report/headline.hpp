// The first sentences of a report: what its suite asks, and what the run answers.
#pragma once
#include <lgabench/report/report_document.hpp>
#include <lgabench/statistics/about_suite.hpp>
#include <lgabench/statistics/tables.hpp>

namespace lgabench::report {

/// Of a table's methods the `most` that a reader would compare the first one with: those that the paper does not have,
/// then its baselines.
std::vector<std::string> most_compared(const std::vector<std::string>& methods, std::size_t most);

/// "Mean over 13 scenarios, 50 demonstrations: LGA succeeds in 0.57 of the episodes, 0.41 [0.32, 0.50] more than
/// GCBC-SEG, ...": paired differences of the first method of the first table to others and to the random visible
/// object, in the suite's main arm; "The paper's claims: C1 held". Empty where no method has finished.
Spans headline(const Material& material, const AboutSuite& about);

/// The arms of the run, what their test scenes are, and one of these scenes.
std::vector<ArmLine> arm_lines(const Material& material, const AboutSuite& about);

/// "All rows: policy=heat_map, ...": what all rows share beside the plugins' defaults; empty where that is nothing.
Spans setting_line(const RunResults& run);

}  // namespace lgabench::report

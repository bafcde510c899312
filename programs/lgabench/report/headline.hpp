// The first sentences of a report: what its suite asks, and what the run answers; and their numbers for a terminal.
#pragma once
#include <string>
#include <vector>

#include <lgabench/report/report_document.hpp>
#include <lgabench/statistics/about_suite.hpp>
#include <lgabench/statistics/tables.hpp>

namespace lgabench::report {
using namespace document;
using namespace statistics;

/// "Mean over 13 scenarios, 50 demonstrations: LGA succeeds in 0.57 of the episodes, 0.41 [0.32, 0.50] more than
/// GCBC-SEG, ...": paired differences of the first method of the first table to others and to the random visible
/// object, in the suite's main arm; "The paper's claims: C1 held". Empty where no method has finished.
Spans headline(const Material& material, const AboutSuite& about);

/// The arms of the run, what their test scenes are, and one of these scenes.
std::vector<ArmLine> arm_lines(const Material& material, const AboutSuite& about);

/// "All rows: policy=heat_map, ...": what all rows share beside the plugins' defaults; empty where that is nothing.
Spans setting_line(const RunResults& run);

/// What a run ends with in a terminal, beside its headline.
struct Brief {
  /// Success on the mean over scenarios, in at most 12 lines of 80 columns: two references, and eight methods, the
  /// headline's among them; the numbers of demonstrations where there is one arm, else the arms, else the main one and
  /// the mean over all. Empty where nothing was played.
  Grid means;
  std::vector<std::string> notes;  // its marks, what it leaves out, what the run lacks, errors of methods
};

/// The brief of the run's first table.
Brief brief(const Material& material);

}  // namespace lgabench::report

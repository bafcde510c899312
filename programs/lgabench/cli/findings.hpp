// How check-plugin and check-scenario show what they found.
#pragma once
#include <lgabench/job/check_report.hpp>

namespace lgabench::cli {

bool has_problem(const CheckReport& report);

/// A line for the finding, and one for what to do about it, to stdout.
void print(const Finding& finding);
/// The findings from number `first` on, and the verdict on all.
void print(const CheckReport& report, std::size_t first = 0);

}  // namespace lgabench::cli

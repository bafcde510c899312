// How check-plugin and check-scenario show what they found.
#pragma once
#include <lgabench/job/check_report.hpp>

namespace lgabench::cli {

bool has_problem(const CheckReport& report);

/// A line for each finding, one for what to do about it, and the verdict, to stdout.
void print(const CheckReport& report);

}  // namespace lgabench::cli

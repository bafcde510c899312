// What the paper published, to stand beside what we measure.
#pragma once
#include <map>
#include <string>

namespace lgabench::report {

/// Success on the mean over the paper's scenarios: display name -> demonstrations -> rate.
using PaperValues = std::map<std::string, std::map<int, double>>;

/// Figure 3a from the installed paper/reference_results.json for suite q1; empty for another suite.
/// @throws InputError where the file is missing or not as expected.
PaperValues paper_values(const std::string& suite);

}  // namespace lgabench::report

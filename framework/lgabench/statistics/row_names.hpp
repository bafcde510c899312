// What a run's rows are called for readers: no option that tells two of them apart is hidden.
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/statistics/results.hpp>

namespace lgabench::report {

/// A row's name -> the name with every option that readers must know, as display_name() takes it: options in which two
/// rows of the run differ, at each row that has them, and options beside the plugin's default that neither the suite's
/// own design sets nor all rows share. "lga" -> "lga+policy=heat_map".
std::map<std::string, std::string> told_names(const RunResults& run);

/// The same for rows that stand in one table with those of other runs: with the options in which two rows of one method
/// differ, of whichever run. One map for each run.
std::vector<std::map<std::string, std::string>> told_names(const std::vector<const RunResults*>& runs);

/// Options beside the plugins' defaults that all methods of the run share: ("policy", "heat_map").
std::vector<std::pair<std::string, std::string>> shared_options(const RunResults& run);

}  // namespace lgabench::report

// A run's settings beyond its tables, and the names of rows that these need: no option that tells two rows apart is
// hidden.
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/statistics/results.hpp>

namespace lgabench::statistics {

/// Whether a description in methods.json, {"id"?, "options"?, ...}, is one of the cell's row.
bool fits(const CellResult& cell, const JsonReader& description);

/// The axis through which methods saw their demonstrations: "sensor_noise, level 2"; "" if none.
std::string seen_through(const RunResults& run);

/// A line each: the preset, rows whose options differ from their plugins' defaults (rows with the same ones together),
/// test scenes that each training seed has to itself, seen_through(), rows that are no reading of the paper or of its
/// code, rows that are one method under two names. For the head of a report.
std::vector<std::string> settings(const RunResults& run);

/// A row's name -> the name with every option that readers must know, as display_name() takes it: options in which two
/// rows of the run differ, at each row that has them, and options beside the plugin's default that neither the suite's
/// own design sets nor all rows share. "lga" -> "lga+policy=heat_map".
std::map<std::string, std::string> told_names(const RunResults& run);

/// told_names() of rows that stand in one table with those of other runs: with the options in which two rows of one
/// method differ, of whichever run. One map for each run.
std::vector<std::map<std::string, std::string>> told_names(const std::vector<const RunResults*>& runs);

/// Options beside the plugins' defaults that all methods of the run share: ("policy", "heat_map").
std::vector<std::pair<std::string, std::string>> shared_options(const RunResults& run);

}  // namespace lgabench::statistics

// How a run was set, beyond what its tables say.
#pragma once
#include <string>
#include <vector>

#include <lgabench/statistics/results.hpp>

namespace lgabench::report {

/// Whether a description in methods.json, {"id"?, "options"?, ...}, is one of the cell's row.
bool fits(const CellResult& cell, const JsonReader& description);

/// What methods saw their demonstrations through: "sensor_noise, level 2"; "" where they saw them as they are.
std::string seen_through(const RunResults& run);

/// A line each: the preset, rows whose options differ from their plugins' defaults (rows with the same ones together),
/// test scenes that each training seed has to itself, seen_through(), rows that are no reading of the paper or of its
/// code, rows that are one method under two names. For the head of a report.
std::vector<std::string> settings(const RunResults& run);

}  // namespace lgabench::report

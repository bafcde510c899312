// Where scenarios are: the shipped ones, and a researcher's own.
#pragma once
#include <filesystem>
#include <map>
#include <string>

namespace lgabench {

/// Adds a directory to $LGABENCH_SCENARIO_PATH (colon-separated), where scenarios are looked for beside the shipped
/// ones; programs that this one starts look there too. Before any thread. @throws InputError if it is no directory.
void add_scenario_path(const std::filesystem::path& directory);

/// @throws InputError for a directory with a colon in its path, which would be two on the scenario path.
void expect_scenario_path(const std::filesystem::path& directory);

/// Every scenario's id and file: the data directory's scenarios/, then those on the scenario path. There, a .json file
/// that can be read and describes no task, such as a suite, is passed over.
/// @throws InputError for an id that two files have.
std::map<std::string, std::filesystem::path> scenario_files();

/// The file of one scenario, without listing the others; "" if there is none. @throws InputError if two files have the
/// id.
std::filesystem::path scenario_file(const std::string& id);

}  // namespace lgabench

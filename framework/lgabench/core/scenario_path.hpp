// $LGABENCH_SCENARIO_PATH, where files of a researcher's own lie: scenarios, and what they name.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace lgabench {

/// Its directories.
std::vector<std::filesystem::path> scenario_path();
/// @throws InputError where one of them is no directory: what lies there is missing everywhere.
void expect_scenario_directories();

/// Of the .json files there that can be read, those with a member that tells what they are, by id; the first of an id.
std::map<std::string, std::filesystem::path> files_on_scenario_path(const std::string& member);

}  // namespace lgabench

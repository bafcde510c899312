#include <lgabench/core/scenario_files.hpp>

#include <fmt/format.h>

#include <cstdlib>
#include <sstream>

#include <lgabench/core/directories.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/core/scenario_path.hpp>
#include <lgabench/core/shipped.hpp>

namespace lgabench {
namespace {

constexpr const char* variable = "LGABENCH_SCENARIO_PATH";

// Whether a file's JSON has the member; `unreadable` where it cannot be read.
bool has_member(const fs::path& file, const std::string& member, bool unreadable) {
  try {
    const Json json = read_json(file);
    return json.is_object() && json.contains(member);
  } catch (const InputError&) {
    return unreadable;
  }
}

// A file that cannot be read counts: whoever names it is told why it cannot.
bool may_be_scenario(const fs::path& file) { return has_member(file, "task", true); }

fs::path shipped() { return data_directory() / "scenarios"; }

fs::path file_in(const fs::path& directory, const std::string& id) { return directory / (id + ".json"); }

// A file on the scenario path, which may be no scenario.
void add_own(std::map<std::string, fs::path>& files, const std::string& id, const fs::path& file) {
  if (!may_be_scenario(file)) return;
  const auto [there, is_new] = files.emplace(id, file);
  std::error_code none_to_compare;
  if (!is_new && !fs::equivalent(there->second, file, none_to_compare))
    throw InputError(
        fmt::format("{}: expected another id, since {} has this one", file.string(), there->second.string()));
}

}  // namespace

std::vector<fs::path> scenario_path() {
  std::vector<fs::path> directories;
  const char* listed = std::getenv(variable);
  std::istringstream words(listed ? listed : "");
  for (std::string word; std::getline(words, word, ':');)
    if (!word.empty()) directories.emplace_back(word);
  return directories;
}

void expect_scenario_directories() {
  for (const fs::path& one : scenario_path()) expect_directory(variable, one);
}

std::map<std::string, fs::path> files_on_scenario_path(const std::string& member) {
  std::map<std::string, fs::path> files;
  std::error_code none_to_list;
  for (const fs::path& directory : scenario_path())
    for (const std::string& id : json_names(directory, none_to_list))
      if (const fs::path file = file_in(directory, id); has_member(file, member, false)) files.emplace(id, file);
  return files;
}

void add_scenario_path(const fs::path& directory) {
  std::error_code error;
  const fs::path canonical = fs::canonical(directory, error);
  if (error || !fs::is_directory(canonical))
    throw InputError(fmt::format("--scenario-path {}: expected a directory", directory.string()));
  expect_scenario_path(canonical);
  std::string all = canonical.string();
  for (const fs::path& other : scenario_path()) {
    if (other == canonical) return;
    all.insert(0, other.string() + ":");
  }
  ::setenv(variable, all.c_str(), 1);
}

void expect_scenario_path(const fs::path& directory) {
  const std::string path = fs::weakly_canonical(fs::absolute(directory)).string();
  if (path.find(':') != path.npos)
    throw InputError(
        fmt::format("{}: expected a path without a colon, which separates directories in {}", path, variable));
}

std::map<std::string, fs::path> scenario_files() {
  std::map<std::string, fs::path> files;
  std::error_code none_to_list;
  for (const std::string& id : shipped_names("scenarios")) files[id] = file_in(shipped(), id);
  for (const fs::path& directory : scenario_path())
    for (const std::string& id : json_names(directory, none_to_list)) add_own(files, id, file_in(directory, id));
  return files;
}

fs::path scenario_file(const std::string& id) {
  std::map<std::string, fs::path> files;
  if (fs::path(id).filename() == id) {
    if (fs::exists(file_in(shipped(), id))) files[id] = file_in(shipped(), id);
    for (const fs::path& directory : scenario_path())
      if (fs::exists(file_in(directory, id))) add_own(files, id, file_in(directory, id));
  }
  return files[id];
}

}  // namespace lgabench

// Where a process that runs a method, or reads a method's file, may read.
#pragma once
#include <filesystem>
#include <optional>

#include <lgabench/core/json.hpp>
#include <lgabench/host/confine.hpp>

namespace lgabench {

/// The files that a library or an interpreter starts with: the system's and lgabench's own libraries, and nothing of a
/// person.
Reach system_reach();

/// lgabench_method, which comes with lgabench's data: no installed interpreter has it.
std::filesystem::path python_package();

/// The user's home directory, where it is that folder or lies below it.
std::optional<std::filesystem::path> home_in(const std::filesystem::path& folder);

/// Says on stderr that a plugin in that folder can read the user's files, where home_in() is one.
void warn_of_home(const std::filesystem::path& folder);

/// Adds the package, the interpreter and where it finds others: members of PluginInfo::python.
void add_python(Reach& reach, const Json& python);

}  // namespace lgabench

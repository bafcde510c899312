// Methods of installed Python packages: the entry-point group lgabench.methods, read without running a package's code.
#pragma once
#include <filesystem>
#include <string>

#include <lgabench/plugin/loader.hpp>

namespace lgabench {

/// Adds what each *.dist-info/entry_points.txt of the folder declares as `id = package.module:Class`; the class is
/// described as one of a file is (describe_python). What cannot be, and an id that is taken, is refused in the
/// catalogue.
void add_installed_methods(const std::filesystem::path& site, const std::string& interpreter, Catalogue& catalogue);

}  // namespace lgabench

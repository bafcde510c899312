// A temporary directory.
#pragma once
#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/tree.hpp>

namespace lgabench {

/// A directory lgabench-NAME-XXXXXX among the system's temporary ones, which is gone when this is.
struct Scratch {
  fs::path path;
  explicit Scratch(const std::string& name) {
    std::string pattern = (fs::temp_directory_path() / ("lgabench-" + name + "-XXXXXX")).string();
    if (!::mkdtemp(pattern.data())) throw InputError(fmt::format("{}: {}", pattern, std::strerror(errno)));
    path = pattern;
  }
  ~Scratch() { remove_tree(path); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
};

}  // namespace lgabench

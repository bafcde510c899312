// A temporary directory.
#pragma once
#include <string>

#include <lgabench/core/files.hpp>
#include <lgabench/core/tree.hpp>

namespace lgabench {

/// A directory lgabench-NAME.XXXXXX among the system's temporary ones, deleted with this object. Making one deletes
/// those of that name that a killed process left: a directory is in use as long as its lock is held.
class Scratch {
 public:
  /// @throws InputError where none can be made.
  explicit Scratch(const std::string& name);
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  fs::path path;

 private:
  int lock_ = -1;
};

}  // namespace lgabench

// A method's own files, which the worker reads by descriptor (core/files.cpp).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include <lgabench/core/files.hpp>

namespace lgabench {

/// A directory that another process may change at any time. It is opened once, and no path leads out of it.
class PlainDirectory {
 public:
  /// A link, a missing directory or what is no directory counts as empty.
  explicit PlainDirectory(const fs::path& path);
  ~PlainDirectory();
  PlainDirectory(const PlainDirectory&) = delete;
  PlainDirectory& operator=(const PlainDirectory&) = delete;

  /// Sorted names of at most 100 regular files whose names are letters, digits, "_", "-" and ".", which is not first.
  /// Other entries are passed over.
  std::vector<std::string> kept_names() const;
  /// The bytes of the regular file of that name. @throws InputError as lgabench::read_file().
  std::string read_file(const std::string& name, std::uintmax_t most = std::uintmax_t{1} << 30) const;

 private:
  fs::path path_;
  int descriptor_;
};

}  // namespace lgabench

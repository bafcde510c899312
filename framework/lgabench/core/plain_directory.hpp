// A method's own files, as the worker takes them: read by descriptor (core/files.cpp).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include <lgabench/core/files.hpp>

namespace lgabench {

/// A directory that somebody else may change at any time: opened once, and read by no way that leads out of it.
class PlainDirectory {
 public:
  /// A link, like what is no directory or not there, holds nothing.
  explicit PlainDirectory(const fs::path& path);
  ~PlainDirectory();
  PlainDirectory(const PlainDirectory&) = delete;
  PlainDirectory& operator=(const PlainDirectory&) = delete;

  /// Names of what is kept of it: sorted, of at most 100 regular files whose names are letters, digits, "_", "-" and
  /// ".", the last not first. What else it holds is passed over.
  std::vector<std::string> kept_names() const;
  /// The bytes of the regular file of that name. @throws InputError as lgabench::read_file().
  std::string read_file(const std::string& name, std::uintmax_t most = std::uintmax_t{1} << 30) const;

 private:
  fs::path path_;
  int descriptor_;
};

}  // namespace lgabench

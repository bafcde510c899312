#include <lgabench/core/scratch.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <lgabench/core/directories.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/file_lock.hpp>

namespace lgabench {
namespace {

// The user's own directory, opened; -1 for anything else, a link among it.
int open_own(const fs::path& path) {
  const int directory = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  struct stat found {};
  if (directory >= 0 && ::fstat(directory, &found) == 0 && found.st_uid == ::geteuid()) return directory;
  if (directory >= 0) ::close(directory);
  return -1;
}

void remove_abandoned(const fs::path& prefix) {
  std::error_code ignored;
  for (fs::directory_iterator entry(prefix.parent_path(), ignored), end; entry != end; entry.increment(ignored)) {
    if (entry->path().filename().string().rfind(prefix.filename().string(), 0) != 0) continue;
    const int directory = open_own(entry->path());
    if (directory < 0) continue;
    // Without locks nobody can tell that it is abandoned.
    if (::flock(directory, LOCK_EX | LOCK_NB) == 0) fs::remove_all(entry->path(), ignored);
    ::close(directory);
  }
}

}  // namespace

Scratch::Scratch(const std::string& name) {
  const fs::path prefix = temporary_directory() / ("lgabench-" + name + ".");
  remove_abandoned(prefix);
  while (lock_ < 0) {
    std::string made = prefix.string() + "XXXXXX";
    if (!::mkdtemp(made.data()))
      throw InputError(fmt::format("{}: cannot be made: {}; set TMPDIR to a directory that can be written", made,
                                   std::strerror(errno)));
    path = made;
    // Another process may take it for abandoned before it is locked, or before it is opened.
    if ((lock_ = open_own(made)) < 0) {
      if (errno != ENOENT) throw InputError(fmt::format("{}: {}", made, std::strerror(errno)));
      continue;
    }
    try {
      wait_for_lock(lock_, Lock::exclusive, made);
    } catch (...) {
      fs::remove_all(made);
      ::close(lock_);
      throw;
    }
    struct stat locked {};
    if (::fstat(lock_, &locked) == 0 && locked.st_nlink > 0) break;
    ::close(std::exchange(lock_, -1));
  }
}

Scratch::~Scratch() {
  std::error_code ignored;
  fs::remove_all(path, ignored);
  ::close(lock_);
}

}  // namespace lgabench

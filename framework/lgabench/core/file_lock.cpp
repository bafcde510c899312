#include <lgabench/core/file_lock.hpp>

#include <fmt/format.h>
#include <sys/file.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

constexpr const char* no_locks = "LGABENCH_NO_LOCKS";

int operation(Lock lock) { return lock == Lock::shared ? LOCK_SH : LOCK_EX; }

int locked(int descriptor, int how) {
  int result = 0;
  while ((result = ::flock(descriptor, how)) != 0 && errno == EINTR) {
  }
  return result;
}

// Of a flock() that failed, but not for another process's lock.
void expect_unlocked_is_wanted(const fs::path& file) {
  const int reason = errno;
  if (const char* value = std::getenv(no_locks); value && std::string_view(value) == "1") return;
  throw InputError(
      fmt::format("{}: cannot be locked: this file system has no locks ({}); take another directory, or set {}=1 where "
                  "no other lgabench writes there",
                  file.string(), std::strerror(reason), no_locks));
}

}  // namespace

bool try_lock(int descriptor, Lock lock, const fs::path& file) {
  if (locked(descriptor, operation(lock) | LOCK_NB) == 0) return true;
  if (errno == EWOULDBLOCK) return false;
  expect_unlocked_is_wanted(file);
  return true;
}

void wait_for_lock(int descriptor, Lock lock, const fs::path& file) {
  if (locked(descriptor, operation(lock)) != 0) expect_unlocked_is_wanted(file);
}

bool is_locked(int descriptor) { return locked(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK; }

}  // namespace lgabench

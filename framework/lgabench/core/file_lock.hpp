// Locks of files and directories, which tell a file system without locks from a lock that another process holds.
#pragma once
#include <lgabench/core/files.hpp>

namespace lgabench {

/// How flock() locks.
enum class Lock { shared, exclusive };

/// Locks an open file or directory until its descriptor is closed. Returns false where another process's lock is in the
/// way. `file`: what a message calls it. Where the file system has no locks, true with the variable
/// LGABENCH_NO_LOCKS=1.
/// @throws InputError for everything else: it has errno's words and the variable.
bool try_lock(int descriptor, Lock lock, const fs::path& file);

/// Takes the lock as try_lock() does; waits while another process's lock is in the way.
void wait_for_lock(int descriptor, Lock lock, const fs::path& file);

/// Whether another process holds a lock that excludes ours; false where that cannot be told.
bool is_locked(int descriptor);

}  // namespace lgabench

// Directories that are made, and those that variables name.
#pragma once
#include <string>

#include <lgabench/core/files.hpp>

namespace lgabench {

/// Makes the directory and those above it; one that is there stays. Returns what is in the way, or "": a link that
/// leads nowhere, a file, what the system refuses.
std::string try_make_directories(const fs::path& directory);
/// Makes the directory as try_make_directories() does. @throws InputError with what is in the way
void make_directories(const fs::path& directory);

/// @throws InputError with the variable and its value where that is no directory.
void expect_directory(const char* variable, const fs::path& value);

/// The directory for temporary files: that of TMPDIR (else TMP, TEMP, TEMPDIR), else /tmp. @throws InputError with the
/// variable and its value where that is no directory.
fs::path temporary_directory();

}  // namespace lgabench

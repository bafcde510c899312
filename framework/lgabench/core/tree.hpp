// A directory that a stranger's process filled: measured while it runs, removed afterwards, by no way that leads out.
#pragma once
#include <cstdint>

#include <lgabench/core/files.hpp>

namespace lgabench {

struct TreeSize {
  std::uintmax_t bytes = 0;  // on the disk
  std::uintmax_t files = 0;  // directories among them
};

/// Measures what lies below the directory that the descriptor is open on; files that come meanwhile may be missed.
/// Looks at no more than `most_files`, 100 directories deep: what is deeper counts as one file more than that. A
/// directory that may not be listed is made so that it may.
TreeSize tree_size(int directory, std::uintmax_t most_files);

/// The directory with all below it, however deep and whatever its modes. No other process changes it by now. What
/// the system refuses stays.
void remove_tree(const fs::path& directory);

}  // namespace lgabench

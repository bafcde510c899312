// What earlier runs left near a method: scenes, truth, and what the oracle did.
#pragma once
#include <filesystem>
#include <vector>

namespace lgabench {

/// Directories below that hold a run or demonstrations of the cache, and those that cannot be looked into in time: of
/// 100,000 entries, the nearest first. Virtual environments and links are passed over.
std::vector<std::filesystem::path> runs_below(const std::filesystem::path& directory);

}  // namespace lgabench

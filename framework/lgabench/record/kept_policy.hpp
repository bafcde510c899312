// policy.bin of a cell: what was learned, as a line of JSON and the method's own bytes. No result depends on it.
#pragma once
#include <filesystem>
#include <string>

namespace lgabench {

/// A policy, and whose it is.
struct KeptPolicy {
  std::string method, version;  // of the plugin that learned and acts
  std::string bytes;            // Policy::saved()
};

std::string to_text(const KeptPolicy& policy);

/// The policy kept in a cell's directory. No link is followed. @throws InputError naming the file where it is not
/// there, or is not as it was written.
KeptPolicy read_kept_policy(const std::filesystem::path& cell);

}  // namespace lgabench

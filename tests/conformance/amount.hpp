// How much is played.
#pragma once
#include <cstdlib>
#include <string>

namespace lgabench {

/// `full` in `./test --full`; else what the environment variable `name` says, if it is given and set, or `by_default`.
inline int amount(int by_default, int full, const char* name = nullptr) {
  const char *all = std::getenv("LGABENCH_FULL"), *wanted = name ? std::getenv(name) : nullptr;
  if (all && std::string(all) == "1") return full;
  return wanted ? std::atoi(wanted) : by_default;
}

}  // namespace lgabench

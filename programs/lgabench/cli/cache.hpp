// Where demonstrations are kept for later runs.
#pragma once
#include <lgabench/core/files.hpp>

namespace lgabench::cli {

/// $LGABENCH_CACHE, else lgabench/ below $XDG_CACHE_HOME or ~/.cache.
fs::path default_cache();

}  // namespace lgabench::cli

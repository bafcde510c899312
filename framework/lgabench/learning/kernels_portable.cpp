#define LGABENCH_LANES 4
#define LGABENCH_TILE_ROWS 4
#include <lgabench/learning/kernels_simd.hpp>

namespace lgabench {
extern const Kernels portable_kernels;
const Kernels portable_kernels = kernels_of("portable");
}  // namespace lgabench

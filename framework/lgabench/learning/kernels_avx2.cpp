#define LGABENCH_LANES 8
#define LGABENCH_TILE_ROWS 6
#include <lgabench/learning/kernels_simd.hpp>

namespace lgabench {
extern const Kernels avx2_kernels;
const Kernels avx2_kernels = kernels_of("avx2");
}  // namespace lgabench

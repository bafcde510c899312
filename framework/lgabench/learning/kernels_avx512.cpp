#define LGABENCH_LANES 16
#define LGABENCH_TILE_ROWS 12
#include <lgabench/learning/kernels_simd.hpp>

namespace lgabench {
extern const Kernels avx512_kernels;
const Kernels avx512_kernels = kernels_of("avx512");
}  // namespace lgabench

// The kernels of so many lanes, whatever this processor's own width is.
#include "kernels_lanes.hpp"

#include <lgabench/learning/kernels_simd.hpp>

namespace lgabench {

template <>
const Kernels& kernels_of_lanes<LGABENCH_LANES>() {
  static constexpr Kernels kernels = kernels_of("lanes");
  return kernels;
}

}  // namespace lgabench

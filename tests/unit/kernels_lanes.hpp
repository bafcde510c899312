// Kernels with vectors of 4, 8 and 16 numbers, all compiled for AVX2 with FMA.
#pragma once
#include <lgabench/learning/kernels.hpp>

namespace lgabench {

template <int Lanes>
const Kernels& kernels_of_lanes();
template <>
const Kernels& kernels_of_lanes<4>();
template <>
const Kernels& kernels_of_lanes<8>();
template <>
const Kernels& kernels_of_lanes<16>();

}  // namespace lgabench

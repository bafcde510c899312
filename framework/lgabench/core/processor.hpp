// The vector instructions of this processor, by which the kernels of training are chosen and a run's record is marked.
#pragma once

namespace lgabench {

inline bool has_avx512() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx512f");
#else
  return false;
#endif
}

/// Whether the processor has AVX2 with fused multiply-add.
inline bool has_avx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

}  // namespace lgabench

#include <lgabench/learning/kernels.hpp>

namespace lgabench {

extern const Kernels portable_kernels;
#if defined(LGABENCH_X86)
extern const Kernels avx2_kernels, avx512_kernels;
#endif

const std::vector<const Kernels*>& available_kernels() {
  static const std::vector<const Kernels*> found = [] {
    std::vector<const Kernels*> kernels;
#if defined(LGABENCH_X86)
    if (__builtin_cpu_supports("avx512f")) kernels.push_back(&avx512_kernels);
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) kernels.push_back(&avx2_kernels);
#endif
    kernels.push_back(&portable_kernels);
    return kernels;
  }();
  return found;
}

}  // namespace lgabench

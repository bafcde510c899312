#include <lgabench/learning/kernels.hpp>

#include <iterator>
#include <numeric>

#include <lgabench/core/processor.hpp>

namespace lgabench {

extern const Kernels portable_kernels;
#if defined(LGABENCH_X86)
extern const Kernels avx2_kernels, avx512_kernels;
#endif

const int* const every_channel = [] {
  static int all[padded_wide];
  std::iota(std::begin(all), std::end(all), 0);
  return all;
}();

const std::vector<const Kernels*>& available_kernels() {
  static const std::vector<const Kernels*> found = [] {
    std::vector<const Kernels*> kernels;
#if defined(LGABENCH_X86)
    if (has_avx512()) kernels.push_back(&avx512_kernels);
    if (has_avx2()) kernels.push_back(&avx2_kernels);
#endif
    kernels.push_back(&portable_kernels);
    return kernels;
  }();
  return found;
}

}  // namespace lgabench

// Random numbers that are the same everywhere: a counter-based generator, and sampling written out by hand.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace lgabench {

/// Philox4x32-10 (Salmon et al., SC 2011). A stream is named, not advanced to: two streams with different
/// names never share numbers, and nothing that one draws changes another.
class RandomStream {
 public:
  /// `name` says what the numbers are for, e.g. "scene/heart/cells/test/0/17/layout".
  explicit RandomStream(std::string_view name);

  /// 32 uniform bits.
  std::uint32_t next();
  /// Uniform in [0, 1), 53 bits.
  double uniform();
  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform in [0, n), without bias. @pre n > 0
  std::uint32_t below(std::uint32_t n);
  /// true or false with equal odds.
  bool coin() { return below(2) == 0; }
  /// Standard normal (Box-Muller).
  double gaussian();
  /// Uniformly random order of 0..n-1 (Fisher-Yates).
  std::vector<int> permutation(int n);

 private:
  std::array<std::uint32_t, 2> key_;
  std::uint64_t counter_ = 0;
  std::array<std::uint32_t, 4> block_{};
  int used_ = 4;
};

/// Philox4x32-10 itself, for the known-answer test.
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

}  // namespace lgabench

// Arrays of numbers as kernels want them. Private to learning/.
#pragma once
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>

namespace lgabench {

/// A count or a place, as an array takes it.
inline std::size_t size(int count) { return static_cast<std::size_t>(count); }

/// Numbers that begin at a cache line, all 0 at first.
class Numbers {
 public:
  /// None.
  Numbers() = default;
  /// @throws std::bad_alloc
  explicit Numbers(std::size_t count)
      : values_(static_cast<float*>(std::aligned_alloc(64, (count * sizeof(float) + 63) / 64 * 64))) {
    if (!values_) throw std::bad_alloc();
    std::memset(values_.get(), 0, count * sizeof(float));
  }
  /// Pointer to the first number; owned by this. Null if there are none.
  operator float*() { return values_.get(); }
  /// Pointer to the first number, read only; owned by this. Null if there are none.
  operator const float*() const { return values_.get(); }

 private:
  struct Free {
    void operator()(float* values) const { std::free(values); }
  };
  std::unique_ptr<float[], Free> values_;
};

}  // namespace lgabench

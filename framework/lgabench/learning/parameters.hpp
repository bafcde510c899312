// The trainable numbers of a network. Private to learning/.
#pragma once
#include <cstdint>
#include <vector>

#include <lgabench/core/random.hpp>
#include <lgabench/learning/archive.hpp>
#include <lgabench/learning/kernels.hpp>
#include <lgabench/learning/numbers.hpp>

namespace lgabench {

/// All of them in one array, each layer's from a whole vector on; beside it the gradients and Adam's moments. A layer
/// first takes its room, then says in which order PyTorch has its numbers and how they begin; after the last layer
/// follows one finish().
class Parameters {
 public:
  explicit Parameters(std::uint64_t seed);

  /// Takes room for so many numbers side by side, and returns its place. They are 0 unless named below.
  std::size_t take(int numbers);
  /// Names the next numbers in PyTorch's order, at these places. They begin uniform between two numbers (or at one).
  void uniform(const std::vector<std::size_t>& places, double low, double high);
  /// The next ones in PyTorch's order are a matrix, row by row, that begins with orthonormal rows (columns, if they are
  /// fewer), uniformly distributed (Saxe et al. 2014; torch.nn.init.orthogonal_).
  void orthogonal(const std::vector<std::size_t>& places, int rows, int columns);
  /// Makes the arrays.
  void finish();

  const float* operator[](std::size_t place) const { return values_ + static_cast<std::ptrdiff_t>(place); }
  /// Called before layers add to the gradients.
  void clear_gradients();
  float* gradient(std::size_t place) { return gradients_ + static_cast<std::ptrdiff_t>(place); }

  std::vector<float> values() const { return in_pytorchs_order(values_); }
  std::vector<float> gradients() const { return in_pytorchs_order(gradients_); }
  /// Sets all values, given in PyTorch's order. @throws InputError for another number of them.
  void set(const std::vector<float>& values);
  /// Writes all values to the archive, or sets them from it, in PyTorch's order. @throws as set().
  void learned(Archive& archive) {
    std::vector<float> all = values();
    archive(all);
    if (archive.reads()) set(all);
  }

  /// One step of Adam along the gradients (betas .9 and .999, epsilon 1e-8).
  void update(const Kernels& kernels, double learning_rate);

 private:
  std::vector<float> in_pytorchs_order(const float* values) const;

  RandomStream random_;
  std::size_t count_ = 0;            // padding included
  std::vector<std::size_t> places_;  // of each number, in PyTorch's order
  std::vector<float> first_;         // what they begin with, likewise
  Numbers values_, gradients_, mean_, variance_;
  long long steps_ = 0;
};

}  // namespace lgabench

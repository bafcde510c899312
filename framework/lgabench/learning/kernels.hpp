// The arithmetic of a training step, compiled for several instruction sets; the processor's best is chosen at run time.
// No kernel adds across the numbers of a vector, and every width of vectors adds in the same order: so every set with
// fused multiply-add gives the same bits. A processor without it gives others, and a run's record says that.
#pragma once
#include <cstddef>
#include <vector>

#include <lgabench/learning/layers.hpp>

namespace lgabench {

/// Adam at step t (Kingma and Ba 2015, algorithm 1), each number rounded once.
struct AdamCoefficients {
  float beta1, beta2, epsilon;
  float rest1, rest2;  // 1 - beta, which single precision would round
  float rate;          // learning rate / (1 - beta1^t)
  float root;          // 1 / sqrt(1 - beta2^t)
};

/// Where a gradient is known to be 0 in some channels: outside the columns `whole` of each row of `out`, only these
/// channels, in ascending order, may hold anything.
struct OpenChannels {
  const Span* whole;
  const int* channels;
  int count;
};
/// 0, 1, 2 ...: all channels that a layer may have.
extern const int* const every_channel;

/// All arrays are the caller's; any alignment is right, 64 bytes is fast. A layer may be narrower than in `layers`,
/// with 16 out channels at least; for input_gradient(), one row of its kernel is a multiple of 16 numbers.
struct Kernels {
  const char* name;  // "avx512", "avx2" or "portable"
  /// out = in * weights + bias of one picture, its negative numbers replaced by 0 if `relu`; where `spans` is not null,
  /// of these columns of each row of `out` alone.
  void (*forward)(const Layer& layer, const float* in, const float* weights, const float* bias, float* out, bool relu,
                  const Span* spans);
  /// d loss / d weights, summed over pictures, whose `gradient`s (d loss / d out) lie one after the other; where
  /// `spans` is not null, over these columns of each row of the gradient alone.
  void (*weight_gradient)(const Layer& layer, const float* const* in, const float* gradient, float* weight_gradient,
                          int pictures, const Span* spans);
  /// Adds d loss / d in of one picture; `transposed` weights are kernel x out_channels x (kernel x channels). Where
  /// `open` is not null, the channels that it leaves out are passed over: the same bits in less time.
  void (*input_gradient)(const Layer& layer, const float* gradient, const float* transposed, float* in_gradient,
                         const OpenChannels* open);
  /// Zeroes the gradient where `out` was cut off at 0.
  void (*relu_gradient)(const float* out, float* gradient, std::size_t count);
  /// Sums `rows` x `channels` numbers over rows; channels is at least 16.
  void (*sum_rows)(const float* values, float* sums, int rows, int channels);
  /// Mean of each channel over `rows`, and the sum of its squared distances from it; channels as above.
  void (*moments)(const float* values, int rows, int channels, float* mean, float* squares);
  /// out = (values - mean) * factor + shift of each channel, its negative numbers replaced by 0 if `relu`.
  void (*normalise)(const float* values, const float* mean, const float* factor, const float* shift, float* out,
                    int rows, int channels, bool relu);
  /// Back through out = (values - mean) * inverse * scale + shift, where mean and inverse are the values' own; `out` is
  /// null, or what a ReLU made of it. Replaces d loss / d out by d loss / d values.
  void (*norm_gradient)(const float* values, const float* mean, const float* inverse, const float* scale,
                        const float* out, float* gradient, int rows, int channels, float* scale_gradient,
                        float* shift_gradient);
  /// Adam in place (Kingma and Ba 2015, algorithm 1).
  void (*adam)(const AdamCoefficients& c, const float* gradients, float* mean, float* variance, float* parameters,
               std::size_t count);
};

/// Kernels that this processor can run, the fastest first. Thread-safe.
const std::vector<const Kernels*>& available_kernels();

}  // namespace lgabench

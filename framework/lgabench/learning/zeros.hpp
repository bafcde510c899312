// What a training step leaves out because it is multiplied by zero: adding x + 0 w changes no bit of x. Private to
// learning/.
#pragma once
#include <vector>

#include <lgabench/learning/layers.hpp>

namespace lgabench {

/// Channels of a convolution's output, ascending.
using Channels = std::vector<int>;

/// 0 .. count - 1.
Channels all_channels(int count);
/// Those whose sum, of numbers of which none is negative, is not 0, and as many others as bring their number to a
/// multiple of `multiple`, at least 16. Allocates nothing where `channels` has the capacity.
void live_channels(const float* sums, int count, int multiple, Channels& channels);
/// Moves `channels` of each position together, in place; each had `count`.
void pack(float* values, int positions, int count, const Channels& channels);

/// Weights of `layer` from the channels `in` alone: kernel x kernel x in x out_channels.
void gather_weights(const Layer& layer, const float* weights, const Channels& in, float* narrow);
/// Weights between the channels `in` and `out` alone, kernel x out x kernel x in, as the input's gradient takes them.
void transpose_weights(const Layer& layer, const float* weights, const Channels& in, const Channels& out,
                       float* transposed);
/// A gradient from kernel x kernel x in x out to all of `layer`'s weights: that of the others is 0.
void scatter_weights(const Layer& layer, const float* narrow, const Channels& in, const Channels& out, float* weights);

}  // namespace lgabench

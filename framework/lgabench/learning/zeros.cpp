#include <lgabench/learning/zeros.hpp>

#include <algorithm>
#include <numeric>

namespace lgabench {

Channels all_channels(int count) {
  Channels channels(static_cast<std::size_t>(count));
  std::iota(channels.begin(), channels.end(), 0);
  return channels;
}

void live_channels(const float* sums, int count, int multiple, Channels& channels) {
  const int live = count - static_cast<int>(std::count(sums, sums + count, 0.f));
  int spare = std::max(16, (live + multiple - 1) / multiple * multiple) - live;
  channels.clear();
  for (int c = 0; c < count; ++c)
    if (sums[c] != 0 || spare-- > 0) channels.push_back(c);
}

void pack(float* values, int positions, int count, const Channels& channels) {
  float* to = values;
  for (int p = 0; p < positions; ++p, values += count)
    for (const int c : channels) *to++ = values[c];
}

void gather_weights(const Layer& layer, const float* weights, const Channels& in, float* narrow) {
  for (int k = 0; k < layer.kernel * layer.kernel; ++k, weights += layer.channels * layer.out_channels)
    for (const int i : in) narrow = std::copy_n(weights + i * layer.out_channels, layer.out_channels, narrow);
}

void transpose_weights(const Layer& layer, const float* weights, const Channels& in, const Channels& out,
                       float* transposed) {
  for (int k = 0; k < layer.kernel; ++k, weights += layer.segment() * layer.out_channels)
    for (const int o : out)
      for (int x = 0; x < layer.kernel; ++x)
        for (const int i : in) *transposed++ = weights[(x * layer.channels + i) * layer.out_channels + o];
}

void scatter_weights(const Layer& layer, const float* narrow, const Channels& in, const Channels& out, float* weights) {
  std::fill_n(weights, layer.weights(), 0.f);
  for (int k = 0; k < layer.kernel * layer.kernel; ++k, weights += layer.channels * layer.out_channels)
    for (const int i : in)
      for (const int o : out) weights[i * layer.out_channels + o] = *narrow++;
}

}  // namespace lgabench

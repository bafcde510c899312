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

void append_patches(const Layer& layer, const float* picture, int first, float* patches, std::vector<int>& places) {
  const int size = layer.kernel * layer.kernel, stride = layer.stride;
  float* to = patches + places.size() * static_cast<std::size_t>(size);
  for (int y = 0; y < layer.out_rows(); ++y) {
    // A patch is two strips wide, which it shares with its neighbours.
    const auto any = [&](int column) {
      bool found = false;
      for (int k = 0; k < layer.kernel; ++k)
        for (int j = 0; j < stride; ++j) found |= picture[(y * stride + k) * layer.columns + column * stride + j] != 0;
      return found;
    };
    bool left = any(0);
    for (int x = 0; x < layer.out_columns(); ++x) {
      const bool right = any(x + 1);
      if (left || right) {
        places.push_back(first + y * layer.out_columns() + x);
        for (int k = 0; k < layer.kernel; ++k)
          to = std::copy_n(picture + (y * stride + k) * layer.columns + x * stride, layer.kernel, to);
      }
      left = right;
    }
  }
}

void spread_rows(float* values, int count, int channels, const std::vector<int>& places, const float* other) {
  auto from = static_cast<int>(places.size());
  for (int to = count; to-- > 0;) {
    const bool moved = from > 0 && places[static_cast<std::size_t>(from - 1)] == to;
    if (moved) --from;
    std::copy_n(moved ? values + from * channels : other, channels, values + to * channels);
  }
}

void gather_rows(float* values, int channels, const std::vector<int>& places) {
  float* to = values;
  for (const int place : places) to = std::copy_n(values + place * channels, channels, to);
}

}  // namespace lgabench

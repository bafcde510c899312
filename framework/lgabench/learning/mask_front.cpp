#include <lgabench/learning/mask_front.hpp>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace lgabench {

MaskFront::MaskFront(const Kernels& kernels) : kernels_(kernels), weights_(size(second_.weights() / groups)) {}

void MaskFront::make_room(int rows) {
  const int positions = rows * first_.out_rows() * first_.out_columns(), channels = first_.out_channels;
  patches_ = Numbers(size((positions + 1) * first_.kernel * first_.kernel));
  for (Numbers* array : {&outputs_, &gradients_}) *array = Numbers(size((positions + 1) * channels));
  differences_ = Numbers(size((positions + groups) * channels));
  const int most = rows * ((first_.out_rows() + 1) / 2) * ((first_.out_columns() + 1) / 2);  // members of one group
  seen_ = Numbers(size((most + 1) * taps * second_.out_channels));
  in_gradients_ = Numbers(size((most + 1) * channels));
  places_.reserve(size(positions));
  for (std::vector<int>& members : members_) members.reserve(size(most));
}

Layer MaskFront::on_patches() const {
  return {1, static_cast<int>(places_.size()) + 1, first_.kernel * first_.kernel, 1, 1, first_.out_channels};
}

Layer MaskFront::of_group(int group, int channels) const {
  return {1, static_cast<int>(members_[group].size()) + 1, second_.channels, 1, 1, taps * channels};
}

// Those of one picture that are not all 0.
void MaskFront::append_patches(const float* picture, int first_place) {
  constexpr int kernel = first_.kernel, stride = first_.stride, columns = first_.out_columns();
  static_assert(kernel == 2 * stride && stride * sizeof(float) == 2 * sizeof(std::uint64_t));
  float* to = patches_ + static_cast<int>(places_.size()) * kernel * kernel;
  for (int y = 0; y < first_.out_rows(); ++y) {
    const float* const top = picture + y * stride * first_.columns;
    // A patch is two strips wide, which it shares with its neighbours.
    const auto any = [&](int strip) {
      std::uint64_t bits = 0;
      for (int k = 0; k < kernel; ++k) {
        std::uint64_t pair[2];
        std::memcpy(pair, top + k * first_.columns + strip * stride, sizeof pair);
        bits |= pair[0] | pair[1];
      }
      return bits != 0;
    };
    bool left = any(0);
    for (int x = 0; x < columns; ++x) {
      const bool right = any(x + 1);
      if (left || right) {
        places_.push_back(first_place + y * columns + x);
        for (int k = 0; k < kernel; ++k) to = std::copy_n(top + k * first_.columns + x * stride, kernel, to);
      }
      left = right;
    }
  }
}

bool MaskFront::find(const std::vector<const float*>& pictures, int rows) {
  places_.clear();
  constexpr int columns = first_.out_columns(), positions = first_.out_rows() * columns;
  for (int row = 0; row < rows; ++row) append_patches(pictures[size(row)], row * positions);
  constexpr int numbers = first_.kernel * first_.kernel;
  std::fill_n(patches_ + static_cast<int>(places_.size()) * numbers, numbers, 0.f);
  for (std::vector<int>& members : members_) members.clear();
  for (std::size_t n = 0; n < places_.size(); ++n) {
    const int y = places_[n] % positions / columns, x = places_[n] % columns;
    members_[y % 2 * 2 + x % 2].push_back(static_cast<int>(n));
  }
  for (int group = 1; group < groups; ++group)
    offsets_[group] = offsets_[group - 1] + static_cast<int>(members_[group - 1].size()) + 1;
  return 2 * static_cast<int>(places_.size()) <= rows * positions;
}

template <class Use>
void MaskFront::for_taps(int group, const Use& use) const {
  constexpr int columns = first_.out_columns(), positions = first_.out_rows() * columns;
  constexpr int out_rows = second_.out_rows(), out_columns = second_.out_columns();
  for (int i = 0; i < static_cast<int>(members_[group].size()); ++i) {
    const int place = places_[size(members_[group][size(i)])], row = place / positions;
    for (int tap = 0; tap < taps; ++tap) {
      const int y = place % positions / columns / 2 - tap / 2, x = place % positions % columns / 2 - tap % 2;
      const bool is_there = y >= 0 && y < out_rows && x >= 0 && x < out_columns;
      use(i, tap, is_there ? (row * out_rows + y) * out_columns + x : -1);
    }
  }
}

template <class Use>
void MaskFront::for_weights(int group, const Use& use) const {
  for (int tap = 0; tap < taps; ++tap) {
    const int y = group / 2 + tap / 2 * 2, x = group % 2 + tap % 2 * 2;
    use(tap, (y * second_.kernel + x) * second_.channels);
  }
}

void MaskFront::forward(int rows, const float* weights1, const float* bias1, const float* weights2, const float* bias2,
                        float* out) {
  kernels_.forward(on_patches(), patches_, weights1, bias1, outputs_, true);

  constexpr int in_channels = second_.channels, channels = second_.out_channels, wide = taps * channels;
  const int positions = rows * second_.out_rows() * second_.out_columns();
  const float* const background = outputs_ + static_cast<int>(places_.size()) * in_channels;
  std::fill_n(out, positions * channels, 0.f);
  float everywhere[most_channels];
  std::copy_n(bias2, channels, everywhere);
  for (int group = 0; group < groups; ++group) {
    const std::vector<int>& members = members_[group];
    const int count = static_cast<int>(members.size());
    float* to = differences(group);
    for (const int n : members)
      for (int c = 0; c < in_channels; ++c) *to++ = outputs_[n * in_channels + c] - background[c];
    std::copy_n(background, in_channels, to);
    for_weights(group, [&](int tap, int first) {
      for (int c = 0; c < in_channels; ++c)
        std::copy_n(weights2 + (first + c) * channels, channels, weights_ + c * wide + tap * channels);
    });
    static const float no_bias[taps * most_channels] = {};
    kernels_.forward(of_group(group, channels), differences(group), weights_, no_bias, seen_, false);
    for_taps(group, [&](int i, int tap, int o) {
      if (o < 0) return;
      const float* const from = seen_ + i * wide + tap * channels;
      for (int c = 0; c < channels; ++c) out[o * channels + c] += from[c];
    });
    for (int k = 0; k < wide; ++k) everywhere[k % channels] += seen_[count * wide + k];
  }
  for (int o = 0; o < positions; ++o)
    for (int c = 0; c < channels; ++c) out[o * channels + c] = std::max(out[o * channels + c] + everywhere[c], 0.f);
}

void MaskFront::backward(const float* weights2, const Channels& live, const float* gradient, const float* sums,
                         float* weight_gradient1, float* bias_gradient1, float* weight_gradient2) {
  constexpr int in_channels = second_.channels;
  const int channels = static_cast<int>(live.size()), wide = taps * channels;
  float* const background = gradients_ + static_cast<int>(places_.size()) * in_channels;
  std::fill_n(background, in_channels, 0.f);
  std::fill_n(weight_gradient2, second_.weights(), 0.f);
  for (int group = 0; group < groups; ++group) {
    const std::vector<int>& members = members_[group];
    const int count = static_cast<int>(members.size());
    const Layer layer = of_group(group, channels);
    for_taps(group, [&](int i, int tap, int o) {
      float* const to = seen_ + i * wide + tap * channels;
      if (o < 0)
        std::fill_n(to, channels, 0.f);
      else
        std::copy_n(gradient + o * channels, channels, to);
    });
    for (int tap = 0; tap < taps; ++tap)  // the background is seen by every output through every weight
      std::copy_n(sums, channels, seen_ + count * wide + tap * channels);

    const float* const in = differences(group);
    kernels_.weight_gradient(layer, &in, seen_, weights_, 1);
    for_weights(group, [&](int tap, int first) {
      for (int c = 0; c < in_channels; ++c)
        for (int k = 0; k < channels; ++k)
          weight_gradient2[(first + c) * second_.out_channels + live[size(k)]] =
              weights_[c * wide + tap * channels + k];
    });

    for_weights(group, [&](int tap, int first) {
      for (int k = 0; k < channels; ++k)
        for (int c = 0; c < in_channels; ++c)
          weights_[(tap * channels + k) * in_channels + c] =
              weights2[(first + c) * second_.out_channels + live[size(k)]];
    });
    float* const in_gradients = in_gradients_;
    std::fill_n(in_gradients, (count + 1) * in_channels, 0.f);
    kernels_.input_gradient(layer, seen_, weights_, in_gradients);
    // The background stands wherever no member does.
    for (int c = 0; c < in_channels; ++c) background[c] += in_gradients[count * in_channels + c];
    for (int i = 0; i < count; ++i)
      for (int c = 0; c < in_channels; ++c) {
        const float value = in_gradients[i * in_channels + c];
        background[c] -= value;
        gradients_[members[size(i)] * in_channels + c] = value;
      }
  }
  const int places = static_cast<int>(places_.size()) + 1;
  kernels_.relu_gradient(outputs_, gradients_, size(places * in_channels));
  kernels_.sum_rows(gradients_, bias_gradient1, places, in_channels);
  const float* const patches = patches_;
  kernels_.weight_gradient(on_patches(), &patches, gradients_, weight_gradient1, 1);
}

}  // namespace lgabench

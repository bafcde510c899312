#include <lgabench/learning/first_convolution.hpp>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace lgabench {

FirstConvolution::FirstConvolution(const Layer& layer, const Kernels& kernels)
    : layer_(layer),
      kernels_(kernels),
      positions_(layer.out_rows() * layer.out_columns()),
      whole_(size(layer.outputs())),
      usual_gradient_(size(layer.weights())) {}

void FirstConvolution::make_room(int rows) {
  const int most = rows * positions_ / 2 + positions_;  // find() stops at a picture's end
  places_.reserve(size(most));
  patches_ = Numbers(size(most * layer_.kernel * layer_.segment()));
  numbers_ = Numbers(size(most * layer_.out_channels));
}

Layer FirstConvolution::on_patches() const {
  return {1, static_cast<int>(places_.size()), layer_.kernel * layer_.segment(), 1, 1, layer_.out_channels};
}

// Appends the patches of one picture that differ.
void FirstConvolution::gather(const float* picture, int first_place) {
  // A patch is two blocks high and wide, which it shares with its neighbours.
  constexpr int most_blocks = 18;
  const int width = layer_.stride * layer_.channels, columns = layer_.out_columns(),
            line = layer_.columns * layer_.channels;
  bool differs[2][most_blocks];  // of the upper and the lower row of blocks
  const auto compare = [&](int block_row) {
    for (int block = 0; block <= columns; ++block) {
      std::uint64_t bits = 0;
      for (int y = 0; y < layer_.stride; ++y) {
        const int begin = (block_row * layer_.stride + y) * line + block * width;
        for (int k = 0; k < width; k += 2) {
          std::uint64_t ours, other;
          std::memcpy(&ours, picture + begin + k, sizeof ours);
          std::memcpy(&other, usual_ + begin + k, sizeof other);
          bits |= ours ^ other;
        }
      }
      differs[block_row % 2][block] = bits != 0;
    }
  };
  compare(0);
  float* to = patches_ + static_cast<int>(places_.size()) * layer_.kernel * layer_.segment();
  for (int y = 0; y < layer_.out_rows(); ++y) {
    compare(y + 1);
    for (int x = 0; x < columns; ++x) {
      if (!differs[0][x] && !differs[0][x + 1] && !differs[1][x] && !differs[1][x + 1]) continue;
      places_.push_back(first_place + y * columns + x);
      for (int k = 0; k < layer_.kernel; ++k, to += layer_.segment()) {
        const int begin = (y * layer_.stride + k) * line + x * width;
        for (int i = 0; i < layer_.segment(); ++i) to[i] = picture[begin + i] - usual_[begin + i];
      }
    }
  }
}

bool FirstConvolution::find(const std::vector<const float*>& pictures, const float* usual, int rows) {
  usual_ = usual;
  rows_ = rows;
  places_.clear();
  for (int row = 0; row < rows; ++row) {
    gather(pictures[size(row)], row * positions_);
    if (2 * static_cast<int>(places_.size()) > rows * positions_) return false;
  }
  return true;
}

void FirstConvolution::forward(const float* weights, const float* bias, bool relu, float* out) {
  static const float no_bias[most_channels] = {};
  kernels_.forward(layer_, usual_, weights, bias, whole_, false, nullptr);
  kernels_.forward(on_patches(), patches_, weights, no_bias, numbers_, false, nullptr);
  for (int row = 0; row < rows_; ++row)
    std::copy_n(static_cast<const float*>(whole_), layer_.outputs(), out + row * layer_.outputs());
  const float* from = numbers_;
  for (const int place : places_)
    for (int c = 0; c < layer_.out_channels; ++c) out[place * layer_.out_channels + c] += *from++;
  if (!relu) return;
  for (int i = 0; i < rows_ * layer_.outputs(); ++i) out[i] = std::max(out[i], 0.f);
}

void FirstConvolution::weight_gradient(const float* gradient, float* weight_gradient) {
  const int channels = layer_.out_channels;
  float* to = numbers_;
  for (const int place : places_) to = std::copy_n(gradient + place * channels, channels, to);
  const float* const patches = patches_;
  kernels_.weight_gradient(on_patches(), &patches, numbers_, weight_gradient, 1, nullptr);
  kernels_.sum_rows(gradient, whole_, rows_, layer_.outputs());
  kernels_.weight_gradient(layer_, &usual_, whole_, usual_gradient_, 1, nullptr);
  for (int i = 0; i < layer_.weights(); ++i) weight_gradient[i] += usual_gradient_[i];
}

}  // namespace lgabench

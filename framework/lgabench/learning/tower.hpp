// The three convolutions through which a network sees a picture. Private to learning/.
#pragma once
#include <optional>
#include <vector>

#include <lgabench/learning/batch_norm.hpp>
#include <lgabench/learning/first_convolution.hpp>
#include <lgabench/learning/network_shape.hpp>
#include <lgabench/learning/parameters.hpp>

namespace lgabench {

/// Numbers of a tower's output.
constexpr int tower_features = 160;

/// One thread at a time; a call allocates nothing where make_room() was for as many rows.
class Tower {
 public:
  /// Takes its parameters: of each convolution weight (out, in, row, column) and bias, uniform within 1/sqrt(fan in) as
  /// PyTorch's default, and with batch normalisation scale and shift. @pre both references outlive this.
  /// @throws InputError if `channels` is none of 1, 3 and 4.
  Tower(int channels, Architecture architecture, Parameters& parameters, const Kernels& kernels);
  /// Makes room for batches of up to `rows`.
  void make_room(int rows);

  /// Features of the pictures, rows x 160, channels last: valid until the next call. What the pictures share with
  /// `usual` (usual_picture()) costs less.
  const float* forward(const std::vector<const float*>& pictures, const float* usual, bool training);
  /// Where to write the gradient of the features before backward().
  float* feature_gradients() { return convolutions_.back().gradients; }
  /// Leaves the gradients of the parameters of the last forward() in training, whose pictures are still there.
  void backward(const std::vector<const float*>& pictures);
  /// What is learned beside the parameters.
  void learned(Archive& archive) {
    for (Convolution& c : convolutions_)
      if (c.norm) c.norm->learned(archive);
  }

 private:
  struct Convolution {
    Layer layer;
    std::size_t weights, bias;
    std::optional<BatchNorm> norm{};
    Numbers values{};                // what is normalised, as the outputs
    Numbers outputs{}, gradients{};  // batch x out rows x out columns x channels

    int positions(int rows) const { return rows * layer.out_rows() * layer.out_columns(); }
  };

  bool is_last(std::size_t i) const { return i + 1 == convolutions_.size(); }
  const float* input(std::size_t i, const std::vector<const float*>& pictures, int row) const;
  void add_convolution(const Layer& layer);
  void convolve(std::size_t i, const std::vector<const float*>& pictures, float* out);
  void backward(std::size_t i, const std::vector<const float*>& pictures);

  const Architecture architecture_;
  Parameters& parameters_;
  const Kernels& kernels_;
  std::vector<Convolution> convolutions_;
  std::optional<FirstConvolution> first_;
  bool mostly_usual_ = false;
  int rows_ = 0;                  // of the last batch
  Numbers transposed_;            // one layer's weights
  std::vector<const float*> in_;  // pictures that a convolution sees
};

}  // namespace lgabench

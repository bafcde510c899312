// The layers that a policy network is made of, and how their numbers lie in memory. Private to learning/.
#pragma once

namespace lgabench {

/// A convolution without padding, channels last: weights are kernel x kernel x channels x out_channels. A linear layer
/// is a 1 x 1 convolution on a picture one row high, with the batch along its columns; there columns is 0, as not
/// known.
struct Layer {
  int rows, columns, channels, kernel, stride, out_channels;

  constexpr int out_rows() const { return (rows - kernel) / stride + 1; }        ///< of its output
  constexpr int out_columns() const { return (columns - kernel) / stride + 1; }  ///< likewise
  /// Numbers of one kernel row, which lie side by side in the picture as in the weights.
  constexpr int segment() const { return kernel * channels; }
  constexpr int weights() const { return kernel * segment() * out_channels; }          ///< without the bias
  constexpr int inputs() const { return rows * columns * channels; }                   ///< of one picture
  constexpr int outputs() const { return out_rows() * out_columns() * out_channels; }  ///< of one picture
};

/// Columns begin .. end of one row.
struct Span {
  int begin, end;
};

/// Outputs of a linear layer are padded with zeros to whole vectors: 100 features to 112, 1000 to 1008, the numbers of
/// an action to 16. So is a state.
constexpr int hidden_features = 100, padded_hidden = 112, wide_features = 1000, padded_wide = 1008, padded_action = 16,
              padded_state = 16;

/// Every layer that a network may have, in the order of `layers`.
enum LayerKind {
  mask_convolution,
  rgb_convolution,
  fused_convolution,
  convolution2,
  convolution3,
  text_linear,
  tower_head,
  text_head,
  tower_linear,
  features_linear,
  wide_linear,
  wide_head,
  state_linear
};

constexpr Layer layers[] = {{36, 72, 1, 8, 4, 32},
                            {36, 72, 3, 8, 4, 32},
                            {36, 72, 4, 8, 4, 32},
                            {8, 17, 32, 4, 2, 64},
                            {3, 7, 64, 3, 1, 32},
                            {1, 0, 384, 1, 1, padded_hidden},
                            {1, 0, 160, 1, 1, padded_action},
                            {1, 0, padded_hidden, 1, 1, padded_action},
                            {1, 0, 160, 1, 1, padded_hidden},
                            {1, 0, padded_hidden, 1, 1, padded_hidden},
                            {1, 0, 160, 1, 1, padded_wide},
                            {1, 0, padded_wide, 1, 1, padded_action},
                            {1, 0, padded_state, 1, 1, padded_hidden}};
constexpr int most_channels = 64;  // of a convolution's output

/// Weights as Kernels::input_gradient() takes them: kernel x out_channels x (kernel x channels).
inline void transpose_weights(const Layer& layer, const float* weights, float* transposed) {
  for (int k = 0; k < layer.kernel; ++k, weights += layer.segment() * layer.out_channels)
    for (int out = 0; out < layer.out_channels; ++out)
      for (int i = 0; i < layer.segment(); ++i) *transposed++ = weights[i * layer.out_channels + out];
}

}  // namespace lgabench

// What a network learns from.
#pragma once
#include <vector>

#include <lgabench/learning/inputs.hpp>
#include <lgabench/learning/loss.hpp>

namespace lgabench {

/// What follows each convolution, and how text joins the pictures.
enum class Architecture {
  text,      // the paper's appendix: batch normalisation, ReLU; the text through a linear layer to 100
  released,  // the released code: ReLU (leaky after the last), batch normalisation; all joined in a hidden layer
  plain      // ReLU alone; text as in the first
};

/// One tower for each picture: Conv 8x8/4 to 32, 4x4/2 to 64, 3x3/1 to 32 channels, flattened to 160. A last linear
/// layer maps all of it to the action: text, plain: with a text's 384 numbers through a linear layer to 100. released,
/// with text: each tower through a linear layer to 100, joined with the 384, to 100, ReLU.
struct NetworkShape {
  std::vector<int> channels;  // of each tower's picture: 1 or 3
  bool text = false;
  Architecture architecture = Architecture::text;
};

/// Numbers of a sentence embedding.
constexpr int text_size = 384;

/// Rows of input and label, each array row-major.
struct Samples {
  /// All zeros.
  explicit Samples(const NetworkShape& shape, int count);

  /// Sets `usual` to the value that more than half of the rows have, number by number; any where there is none.
  void find_usual();

  int rows;
  std::vector<std::vector<float>> pictures;  // for each tower rows x 36 x 72 x channels
  std::vector<std::vector<float>> usual;     // for each tower 36 x 72 x channels: makes a step faster, changes rounding
  std::vector<float> text;                   // rows x 384, or empty
  std::vector<float> labels;                 // rows x 12
};

}  // namespace lgabench

// Which of the paper's networks: what it sees and how its layers follow each other.
#pragma once
#include <vector>

#include <lgabench/learning/samples.hpp>

namespace lgabench {

/// What follows each convolution, and how text joins the pictures.
enum class Architecture {
  text,      // the paper's appendix: batch normalisation, ReLU; the text through a linear layer to 100
  released,  // the released code: ReLU (leaky after the last), batch normalisation; all joined in a hidden layer
  plain      // ReLU alone; text as in the first
};

/// One tower for each picture of 36 x 72: Conv 8x8/4 to 32, 4x4/2 to 64, 3x3/1 to 32 channels, flattened to 160. A last
/// linear layer maps all of it to the action: text, plain: with a text's 384 numbers through a linear layer to 100.
/// released, with text: each tower through a linear layer to 100, joined with the 384, to 100, ReLU.
struct NetworkShape {
  std::vector<int> channels;  // of each tower's picture: 1, 3 or 4
  bool text = false;
  Architecture architecture = Architecture::text;
  int actions = 12;   // numbers of an action, at most 16
  bool wide = false;  // of plain ones: each tower's features pass a linear layer to 1000 first, without an activation
  int state = 0;      // numbers of a state, at most 16: through a linear layer to 100, beside the text

  /// What its samples hold.
  SampleShape samples() const;
};

}  // namespace lgabench

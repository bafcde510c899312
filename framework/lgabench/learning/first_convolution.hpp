// The first convolution of a tower. Most patches of a mask are empty, and most of a picture is the table that every
// sample shows. By linearity, only what differs from the usual picture is multiplied, picture by picture. Private to
// learning/.
#pragma once
#include <vector>

#include <lgabench/learning/kernels.hpp>
#include <lgabench/learning/numbers.hpp>

namespace lgabench {

/// One thread at a time; a call allocates nothing where make_room() was for as many rows.
class FirstConvolution {
 public:
  /// @pre `kernels` outlives this.
  FirstConvolution(const Layer& layer, const Kernels& kernels);
  /// Makes room for batches of up to `rows`.
  void make_room(int rows);

  /// Looks for the patches that differ from those of the picture `usual`. Both are the caller's, and are read until the
  /// last call for this batch. False if more than half do: then it is no gain.
  bool find(const std::vector<const float*>& pictures, const float* usual, int rows);
  /// Outputs for the pictures that find() took: rows x out rows x out columns x out channels.
  void forward(const float* weights, const float* bias, bool relu, float* out);
  /// Gradient of the last forward(), from that of its outputs.
  void weight_gradient(const float* gradient, float* weight_gradient);

 private:
  Layer on_patches() const;  // as a linear layer
  void gather(const float* picture, int first_place);

  const Layer layer_;
  const Kernels& kernels_;
  const int positions_;
  const float* usual_ = nullptr;
  int rows_ = 0;
  std::vector<int> places_;  // positions in the batch of the patches that differ
  Numbers patches_;          // of each its difference, row by row
  Numbers numbers_;          // of each its outputs or their gradient
  Numbers whole_;            // of the usual picture's: its outputs or their gradient
  Numbers usual_gradient_;   // of the weights, from the usual picture
};

}  // namespace lgabench

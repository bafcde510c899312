// What a learner learns from and acts on.
#pragma once
#include <memory>
#include <vector>

#include <lgabench/core/action.hpp>
#include <lgabench/learning/inputs.hpp>

namespace lgabench {

/// Numbers of a sentence embedding.
constexpr int text_size = 384;

/// What one row has: its pictures, channels last, whether there is a text, and what its label's numbers are.
struct SampleShape {
  struct Picture {
    PictureSize size;
    int channels;
    int numbers() const { return size.rows * size.columns * channels; }
  };
  std::vector<Picture> pictures;
  bool text = false;
  ActionSpace actions{};
  std::vector<StateNumber> state{};  // what an observation says beside its picture
};

/// Rows of input and label, each array row-major. Copying copies all numbers but those of `stops`.
struct Samples {
  /// Makes `count` rows of zeros.
  Samples(SampleShape of_a_row, int count);

  /// The numbers of one row's picture; owned by this.
  const float* picture(std::size_t which, int row) const {
    return pictures[which].data() + std::ptrdiff_t{row} * shape.pictures[which].numbers();
  }
  float* picture(std::size_t which, int row) {
    return pictures[which].data() + std::ptrdiff_t{row} * shape.pictures[which].numbers();
  }

  /// One row's label.
  Action label(int row) const;

  SampleShape shape;
  int rows;
  int unaltered;  // how many rows, the first ones, are demonstrations as they are; the others are altered copies
  std::vector<std::vector<float>> pictures;  // each: rows x the picture's rows x columns x channels
  std::vector<float> text;                   // rows x 384, or empty
  std::vector<float> state;                  // rows x numbers of the state, each within -1 and 1
  std::vector<float> labels;                 // rows x numbers of an action: the oracle's, as_stored()
  /// Rows of input at which the demonstrations say that nothing is left to do; their labels are zeros, which are no
  /// action. None of them is a row of this, so that no loss and no mean has them. Null where there is none.
  std::shared_ptr<const Samples> stops{};
};

/// Picture number `which` as most rows have it: for each of its numbers, the value of more than half of the unaltered
/// rows, or any value where there is none.
std::vector<float> usual_picture(const Samples& samples, std::size_t which);

}  // namespace lgabench

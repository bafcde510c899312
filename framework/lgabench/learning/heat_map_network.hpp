// The network of policy=heat_map: where to take hold, as a probability of each cell of the table. Private to learning/.
#pragma once
#include <vector>

#include <lgabench/learning/parameters.hpp>
#include <lgabench/learning/places.hpp>

namespace lgabench {

/// Three convolutions, 5x5, 3x3 and 3x3, each with ReLU, to 16 features of a cell, all linear in place: what is learned
/// in one place holds in all. A cell's heat is linear in its features, plus a prior; the map is the softmax of heats. A
/// group's score is linear in where each feature's centroid lies from the taken point (Levine et al. 2016 call such
/// centroids feature points). A text adds a linear function of it to the first convolution's bias.
///
/// Gradients are of one picture after the other, added up. One thread at a time.
class HeatMapNetwork {
 public:
  /// Cells of the map, and of the planes that it is made of: four cells more on every side, which are 0.
  static constexpr PictureSize grid{32, 64}, padded{40, 72};
  static constexpr int border = 4, cells = grid.rows * grid.columns;

  /// Convolutions begin uniform within the root of 6/fan in (He et al. 2015), all else 0: the map begins as the prior,
  /// and groups equally likely. A function of the seed. @pre `kernels` outlives this.
  /// `field`: what the map shows.
  HeatMapNetwork(const Field& field, int planes, bool text, std::size_t groups, std::uint64_t seed,
                 const Kernels& kernels);

  Vec2 middle_of_cell(int cell) const { return field_.middle_of(grid, cell / grid.columns, cell % grid.columns); }

  /// The map of a picture: `padded` x planes, channels last; `prior` of each cell or null; 384 numbers of text or null.
  /// Valid until the next call, as is the picture needed by teach().
  const std::vector<float>& map(const float* planes, const float* prior, const float* text);
  /// Each group's probability after the last map(), given the taken point.
  const std::vector<float>& groups(Vec2 taken_m);

  /// Of the last map(): the highest of each feature in all cells, then the mean of each.
  std::vector<float> highest_and_mean() const;

  /// Called before the first teach() of a batch.
  void clear_gradients();
  /// Cross entropy of the last map() to `wanted`, a probability of each cell, and of the groups to `group`; where there
  /// is a `like`, of each cell too, `penalty` times the cross entropy to that. Adds `weight` times its gradients.
  double teach(const std::vector<float>& wanted, Vec2 taken_m, std::size_t group, double weight,
               const std::vector<float>& like = {}, double penalty = 0);
  /// One step of Adam (betas .9 and .999, epsilon 1e-8).
  void update(double learning_rate) { parameters_.update(kernels_, learning_rate); }

  Parameters& parameters() { return parameters_; }

 private:
  static constexpr int features = 16;
  struct Convolution {
    Layer layer;
    std::size_t weights, bias;
    Numbers outputs, gradients, transposed;
    Numbers empty_patch, of_empty;  // a patch of the input where the picture is empty, and its outputs
    std::vector<Span> seen{};       // of each row of outputs: where the picture is not empty
  };
  struct Centroid {
    double x, y, mass;  // from the taken point, in units of .1 m
  };

  void add_convolution(PictureSize size, int channels, int kernel);
  const float* input(std::size_t i) const { return i == 0 ? planes_ : convolutions_[i - 1].outputs; }
  void find_seen();
  void convolve(std::size_t i);
  double teach_groups(Vec2 taken_m, std::size_t group, double weight);
  void backward();

  const Field field_;
  const Kernels& kernels_;
  Parameters parameters_;
  std::vector<Convolution> convolutions_;
  std::size_t text_ = 0, heat_ = 0, scores_ = 0, score_biases_ = 0;
  // The last picture, and what was computed of it:
  const float* planes_ = nullptr;
  const float* embedding_ = nullptr;
  std::vector<float> map_, groups_;
  std::vector<Centroid> centroids_;
  Numbers first_bias_, scratch_;
  std::vector<Span> rows_shown_;  // of each row of the planes: what is not 0
};

}  // namespace lgabench

// Reads what a picture shows: segments by difference from the empty place, their object types and textures by forests
// of trees that were grown on drawn pictures.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <lgabench/core/feature_space.hpp>
#include <lgabench/core/observation.hpp>
#include <lgabench/core/random.hpp>
#include <readers/forest.hpp>

namespace lgabench::seeing {

/// What was learned from pictures of one environment.
struct Model {
  Forest object_types, textures;

  std::string bytes() const;
  /// @throws InputError for other bytes than bytes() gives.
  static Model of(std::string_view bytes);
};

/// Medians of red, green and blue over all that belongs to no segment, each at least 1.
std::array<double, 3> colour_of_table(const Observation& seen);

/// The picture with each colour divided by what the light made of the empty place's, which is `usual`. Ids and names
/// stay.
Observation balanced(Observation seen, const std::array<double, 3>& usual);

/// Fills `ids`: what differs from the empty place and is not its shadow, each connected piece one segment. `random`
/// permutes the ids. `balances`: as balanced(), first. Names and shadows are left empty.
Observation segments_by_difference(Observation seen, const Observation& empty, bool balances, RandomStream random);

/// The picture, enlarged, with the number 1, 2, ... beside the segment of each of `ids`, where it hides least of any.
/// Ids and names are left out. @pre `seen` shows each of them.
Observation marked(const Observation& seen, const std::vector<std::uint8_t>& ids);

/// A model for one feature space. A value that never changes.
class Reader {
 public:
  /// @throws InputError where the model learned no type or no texture of the space.
  Reader(Model model, const FeatureSpace& space);

  /// The segments of `ids` in the order of their ids, each with the type and the texture of the space that most trees
  /// say; of two with as many, the first.
  std::vector<Instance> names(const Observation& seen) const;

 private:
  Model model_;
  std::vector<bool> types_, textures_;  // whether the space has each of the model's
};

}  // namespace lgabench::seeing

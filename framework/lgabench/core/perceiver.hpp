// The interface of what reads names from pictures: a plugin's, or the shipped reader. Its process is told the picture,
// the segments and the names that there are; never the scene, the command, the truth or what the simulator says.
#pragma once
#include <lgabench/core/feature_space.hpp>
#include <lgabench/core/observation.hpp>

namespace lgabench {

/// What a perceiver plugin implements. The host calls it from one thread. What it throws fails the cell.
class Perceiver {
 public:
  virtual ~Perceiver() = default;

  /// `seen` with its instances filled in: object types and textures of the space for ids that its `ids` have. `seen`
  /// has none; `ids` are the segments that the run gives, which may be changed. The picture's colours stay what they
  /// are: others are not looked at. How many pixels an instance has is counted by the host. The same arguments give the
  /// same bytes, whatever was asked before.
  virtual Observation read(Observation seen, const FeatureSpace& space) = 0;
};

}  // namespace lgabench

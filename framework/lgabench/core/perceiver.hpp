// The interface of a perceiver, which reads names from pictures. Its process is told the picture, the segments and the
// names that the space has; never the scene, the command, the truth or what the simulator says.
#pragma once
#include <lgabench/core/feature_space.hpp>
#include <lgabench/core/observation.hpp>

namespace lgabench {

/// What a perceiver plugin implements. The host calls it from one thread. What it throws fails the cell.
class Perceiver {
 public:
  virtual ~Perceiver() = default;

  /// Returns `seen`, which comes without instances, with those that the perceiver reads: object types and textures of
  /// the space, for ids that `ids` has. `ids` are the run's segments, and may be changed. The host ignores changed
  /// colours, and counts each instance's pixels itself. The same arguments must give the same bytes, whatever was asked
  /// before.
  virtual Observation read(Observation seen, const FeatureSpace& space) = 0;
};

}  // namespace lgabench

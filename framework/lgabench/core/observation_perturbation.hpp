// The interface of a perturbation axis that a plugin adds: it changes what is perceived, and nothing else. The plugin's
// process is told the observation, the level and a stream; never the scene, the command or the truth.
#pragma once
#include <lgabench/core/observation.hpp>
#include <lgabench/core/random.hpp>

namespace lgabench {

/// What a perturbation plugin implements. The host calls it from one thread. What it throws fails the cell.
class ObservationPerturbation {
 public:
  virtual ~ObservationPerturbation() = default;

  /// Returns what is perceived at that level, 1 or more, in place of `seen`: a picture of the same size, ids of listed
  /// instances alone, and names of object types and textures that the feature space has. The host counts each
  /// instance's pixels itself. `stream` is the scene's and the same at every level: draw the direction of a change from
  /// it, and let the level give the size. The same arguments must give the same bytes, whatever was asked before.
  virtual Observation perceive(Observation seen, int level, RandomStream stream) = 0;
};

}  // namespace lgabench

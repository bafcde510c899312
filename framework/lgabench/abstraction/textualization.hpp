// Imperfect textualization s -> phi: the simulator's table with the errors of a perception (docs/protocol.md, section
// 3).
#pragma once
#include <lgabench/core/feature_space.hpp>
#include <lgabench/core/observation.hpp>
#include <lgabench/core/random.hpp>

namespace lgabench {

/// Probabilities, each within [0, 1].
struct TextualizationNoise {
  double label_noise = 0;     // an instance is given another object type, and independently another texture
  double missed_segment = 0;  // an instance is not seen
};

/// The observation with the noise's errors: a wrong label is uniform over the others of `space`; a missed instance
/// leaves the table, its pixels become 0 in ids, and its shadow belongs to no instance. rgb stays. With both
/// probabilities 0 nothing changes. For equal streams, an error at one probability is the same error at every higher
/// one.
/// @throws InputError for a probability outside [0, 1].
Observation imperfect_textualization(Observation observation, const FeatureSpace& space,
                                     const TextualizationNoise& noise, RandomStream stream);

}  // namespace lgabench

// Noise that is added to finished demonstrations: DART as the authors' released code has it.
#pragma once
#include <cstdint>

#include <lgabench/learning/samples.hpp>

namespace lgabench {

/// What the noise is measured in. deviations: the population standard deviation over all values of that one picture,
/// and over the numbers of that one label. ranges: 1 for pictures, each number's range between its bounds for labels,
/// whose numbers may have different units.
enum class CopyNoise { deviations, ranges };

/// Returns each row of `clean`, followed by `copies` of it with Gaussian noise on pictures and label. The noise has a
/// standard deviation of `scale` times what `of` says.
/// Nothing is clipped, no quaternion is normalised, and text and state stay as they were. The noise comes from a random
/// stream per row and copy, named by `seed`, so that further rows leave those before them as they are. Source: released
/// code (gen_trajs.py, whose defaults are 5 copies and .05, and which adds the noise to the picture of 36 x 72 that its
/// network sees).
Samples with_noisy_copies(const Samples& clean, int copies, double scale, std::uint64_t seed,
                          CopyNoise of = CopyNoise::deviations);

}  // namespace lgabench

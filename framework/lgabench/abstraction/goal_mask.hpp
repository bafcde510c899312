// Instantiation phi-hat -> s-hat: the Selection as a picture (paper, section 3.1).
#pragma once
#include <cstdint>
#include <vector>

#include <lgabench/core/observation.hpp>
#include <lgabench/core/selection.hpp>

namespace lgabench {

/// Observation::rows x columns of 0 and 1, row-major: 1 on the visible pixels of every instance that `selection` keeps.
/// All 0 where nothing in view is kept.
/// @throws InputError if the ids are not rows x columns, or name an instance that the table lacks.
std::vector<std::uint8_t> goal_mask(const Observation& observation, const Selection& selection);

/// Likewise, into `mask`, which is resized: nothing is allocated where it has the capacity.
void goal_mask(const Observation& observation, const Selection& selection, std::vector<std::uint8_t>& mask);

/// 1 on any object: what a segmentation without language gives.
std::vector<std::uint8_t> object_mask(const Observation& observation);
void object_mask(const Observation& observation, std::vector<std::uint8_t>& mask);

}  // namespace lgabench

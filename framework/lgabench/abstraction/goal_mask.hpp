// Instantiation phi-hat -> s-hat: the Selection as a picture (paper, section 3.1).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include <lgabench/core/observation.hpp>
#include <lgabench/core/selection.hpp>

namespace lgabench {

/// Which stay of several visible instances that match one role, the target's or the second set's.
enum class Instances {
  all,
  first  // the one whose first pixel comes first, row by row: "an unambiguous abstract state" (paper, section 3.2)
};

/// The goal mask: rows x columns of 0 and 1, row-major. It is 1 on the visible pixels of every instance that is meant
/// as the target (grounded()) or that the second set holds, and all 0 if none of these is in view.
/// @throws InputError if the ids are not as many as the size says, or name an instance that the table lacks.
std::vector<std::uint8_t> goal_mask(const Observation& observation, const Selection& selection,
                                    Instances instances = Instances::all);

/// Writes the goal mask into `mask`, which is resized: nothing is allocated if it has the capacity.
void goal_mask(const Observation& observation, const Selection& selection, std::vector<std::uint8_t>& mask,
               Instances instances = Instances::all);

/// The goal mask with the roles told apart: 1 on what matches the target, 2 on what matches the second set alone.
void role_mask(const Observation& observation, const Selection& selection, std::vector<std::uint8_t>& mask,
               Instances instances = Instances::all);
constexpr std::uint8_t target_role = 1, second_role = 2;

/// The mask that a segmentation without language gives: 1 on any object. Objects of the type `left_out` stay 0, "" for
/// none.
std::vector<std::uint8_t> object_mask(const Observation& observation, const std::string& left_out = "");
void object_mask(const Observation& observation, std::vector<std::uint8_t>& mask, const std::string& left_out = "");

}  // namespace lgabench

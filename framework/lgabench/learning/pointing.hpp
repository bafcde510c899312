// Acts without a learned policy, so that the abstraction alone decides.
#pragma once
#include <cstdint>
#include <memory>

#include <lgabench/core/method.hpp>

namespace lgabench {

/// Takes the instance at its visible pixel nearest to its middle, and brings its middle to the place in view. Without a
/// turn; every other number is in the middle of its bounds. @throws MethodError where the action has fewer than two
/// places, the instance is hidden, or no place is in view.
Action pointed_at(const Observation& observation, std::uint8_t instance, const ActionSpace& actions);

/// Chooses one of those instances, by a hash of all that is in view. @pre there is one.
std::uint8_t any_in_view(const std::vector<std::uint8_t>& ids, const Observation& observation);

/// policy=point: points at what the Selection keeps, at any of several. Where it keeps nothing, it says that nothing is
/// left to do if it may, else it points at anything in view.
std::unique_ptr<Policy> pointing_policy(const ActionSpace& actions, bool may_stop = false);

}  // namespace lgabench

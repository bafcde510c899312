// What carrying out a plan does to the bodies, once something is taken.
#pragma once
#include <common/motions.hpp>
#include <mobile/mobile.hpp>
#include <mobile/plan.hpp>

namespace lgabench::mobile {

/// Set down from where the robot stands then, without looking: within reach of the waypoint and of its heading.
bool within_reach(const Plan& plan);

/// Lifts `body`, taken at `grasp`, to carrying height and above the robot, drives straight to the waypoint, holds it
/// over the drop and lowers it until its underside is .05 above the goal's rim or it touches something, lets go and
/// waits until all bodies rest. @pre `plan` is executable(), not blocked(), within_reach().
/// @returns false where the limit in simulation steps was reached.
bool carry(const Bodies& bodies, int body, Vec3 grasp, const Plan& plan, const Vessel& goal);

}  // namespace lgabench::mobile

// Success by pose: whether an action is the oracle's but for a tolerance, whatever physics made of it.
#pragma once
#include <lgabench/core/environments.hpp>
#include <lgabench/statistics/results.hpp>

namespace lgabench::statistics {

/// How far an action may lie from the oracle's. The paper counts "the correct action on the target object within
/// radius ε of the goal" (section 5) and does not give ε.
struct PoseTolerance {
  double begin_m = .07, end_m = .10;  // grasp and place; a sweep's beginning and end
  double turn_deg = 15;               // where the task asks for a turn
};

bool is_within(const ActionDistance& distance, const PoseTolerance& tolerance);

/// The environment's task. @throws InputError where the environment does not compare actions by pose (mobile).
const TaskInfo& task_judged_by_pose(const std::string& environment, const std::string& task);

/// Judges every episode of the run by pose: a success where its action is within the tolerance of the oracle's for any
/// object that the scene counts as right. An episode without an action stays a failure. Attributions and what was told
/// of training inputs stay. Scenes are made again, and refused where their hash is not the episode's.
/// @throws InputError for a scenario whose environment does not compare actions by pose (mobile), for a version that
/// samples other scenes, or where lgabench-worker is missing.
void judge_by_pose(RunResults& run, const PoseTolerance& tolerance);

}  // namespace lgabench::statistics

// Processes of a cell's plugins, those of perturbation axes among them.
#pragma once
#include <lgabench/abstraction/reading.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/host/host_session.hpp>
#include <lgabench/job/job.hpp>

namespace lgabench {

/// What the process of one of the cell's plugins is started with: `scratch` is its own, other cells' data are hidden.
HostJob host_job(const CellJob& job, const PluginInfo& plugin, const Json& options, const fs::path& scratch);

/// Starts a process for each axis of a plugin that the scenario has, below the job's scratch directory, and makes the
/// axis perceive through it. The process ends with the scenario. What is wrong with what it perceives (an id of no
/// instance, a name that the feature space lacks), and what it throws, is a MethodError that names plugin and level.
/// @throws PluginError where a plugin is refused, or its axis is another than the scenario says; MethodGone.
void host_axes(const Scenario& scenario, const CellJob& job);

/// What the cell's method is given in place of what is seen (reading_of()); null: that. A perceiver plugin gets a
/// process, as an axis does; what it reads of the same picture must be the same whenever it is asked, or it is a
/// MethodError that names the plugin.
ReadPicture reading_in(const Scenario& scenario, const CellJob& job);

/// @throws MethodError where ids and names are not as host_axes() expects them.
void expect_perceived(const Observation& seen, const FeatureSpace& space);

}  // namespace lgabench

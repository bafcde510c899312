// What `lgabench check-plugin` looks at. A method runs in a process of its own, as in a run; an engine in this one.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include <lgabench/host/host_session.hpp>
#include <lgabench/job/check_report.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench {

/// Told before each step, so that whoever waits knows where a crash happened, and what was found before it.
using CheckPhase = std::function<void(const std::string& phase, const CheckReport& so_far)>;

/// Uses the method twice from loading to acting, on small but real cells of the job's environment: its first task's
/// example, and a scenario with commands that are only tested, where it has one; examples with a second set are
/// selected for only, and one for which nothing can be shown is not learned from, as in a run. "" is the first
/// environment that has such commands. With a `scenario`, else null, it plays that one alone. The seed is not the
/// job's. Returns all findings; one thread.
/// @throws PluginError if it cannot be loaded, MethodGone where its process ends; whatever else it throws is a finding.
/// EngineError for the engine's fault.
CheckReport check_method(HostJob job, const std::optional<PluginInfo>& engine, const Json& scenario,
                         const CheckPhase& phase);

/// Lets the oracle play scenes of every task of the environment ("": of all) on the engine, forwards and backwards,
/// likewise.
CheckReport check_engine(const PluginInfo& engine, const std::string& environment, const CheckPhase& phase);

/// Samples, draws and lets the oracle play scenes of every task of the environment, likewise. `engine` is for those
/// that use one. @throws PluginError if it cannot be loaded.
CheckReport check_environment(const PluginInfo& plugin, const std::optional<PluginInfo>& engine,
                              const CheckPhase& phase);

/// Lets the perturbation perceive scenes of the environment ("": of all) at each level, forwards and backwards,
/// likewise.
/// @throws PluginError, MethodGone likewise.
CheckReport check_perturbation(HostJob job, const CheckPhase& phase);
/// Lets the perceiver read scenes, forwards and backwards, likewise.
CheckReport check_perceiver(HostJob job, const CheckPhase& phase);

/// Which of the threads or processes `now` are still there after half a second.
std::vector<std::string> left_behind(const std::function<std::vector<std::string>()>& now);

/// Adds a finding on the processor's arithmetic, as the plugin left it after its calls.
void judge_arithmetic(CheckReport& report, const ProcessState& state);

/// Adds a finding on what the plugin leaves behind: `now` is what the process holds beyond what it held before the
/// plugin came.
void judge_leftovers(CheckReport& report, const std::function<ProcessState()>& now);

}  // namespace lgabench

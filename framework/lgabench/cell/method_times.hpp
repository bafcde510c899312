// How long a method takes, and how much memory: `lgabench bench`.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/environment.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/host/host_session.hpp>

namespace lgabench {

/// One use of a method, from the start of its process to its end.
struct MethodTimes {
  struct Phase {
    std::string name;              // start, select, learn, act, save
    double wall_s = 0, cpu_s = 0;  // as the worker waits; of all threads of the method's process
  };
  std::vector<Phase> phases;    // select: all commands of the scenario; act: the mean call, the channel included
  std::size_t saved_bytes = 0;  // of the policy; 0 where the method cannot save it, which leaves out `save`
  long long peak_bytes = 0;     // the most memory that the process had in use, as the system counts it (VmHWM)
};

/// A scenario with what methods see in it: demonstrations in its first layout, and a test scene of each arm.
class MethodBench {
 public:
  /// @throws EngineError
  MethodBench(Scenario scenario, const std::optional<PluginInfo>& engine, int demonstrations);

  /// Uses the method as a cell does, once, confined; its environment is the scenario's. Demonstrations are made while
  /// no clock runs. @throws PluginError, MethodError, MethodGone, EngineError; InputError where what it selects leaves
  /// nothing to learn from.
  MethodTimes use(HostJob job);

 private:
  const Scenario scenario_;
  const int demonstrations_;
  std::unique_ptr<Environment> environment_;
  std::vector<std::pair<Scene, Observation>> tests_;
};

}  // namespace lgabench

// How long a method takes, and how much memory: `lgabench bench`.
#pragma once
#include <string>
#include <vector>

#include <lgabench/cell/bench.hpp>
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

/// Uses the method as a cell does, once, confined, with so many demonstrations of each command; its environment is the
/// bench's. Demonstrations are made while no clock runs. @throws PluginError, MethodError, MethodGone, EngineError;
/// InputError where what it selects leaves nothing to learn from.
MethodTimes time_of_use(HostJob job, Bench& bench, int demonstrations);

}  // namespace lgabench

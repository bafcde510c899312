// An environment in Python (python/lgabench_environment): what it is, is data that was read without running it; what it
// does, it does in a process of its own.
#pragma once
#include <lgabench/plugin/loader.hpp>

namespace lgabench {

/// Checks what describe.py says of an environment's class. @throws InputError with the attribute and what was expected.
void expect_environment(const PluginInfo& plugin);

/// From now on environments in Python may start their processes in this one. Until then they throw InputError: planning
/// and reports run no simulator. One thread.
void let_environments_start();

/// The interpreter of plugins in Python where nobody names one: $LGABENCH_PYTHON, or python3.
std::string usual_python();

/// From now on add_environment() takes plugins in Python, and find_environment() looks for them where plugins are. One
/// thread, before the others.
void know_python_environments();

}  // namespace lgabench

// All that the author of an environment includes. Derive from EnvironmentType and from Environment, and name the first
// in one macro at file scope, outside any namespace:
//
//   #include <lgabench/plugin/environment.hpp>
//   class Reach : public lgabench::EnvironmentType { ... };
//   LGABENCH_ENVIRONMENT("reach", "0.1", "a point that is steered to what the command means", Reach)
#pragma once
#include <lgabench/core/environment.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/plugin/plugin.hpp>

/// Declares an environment, once in a library. `Class` derives from lgabench::EnvironmentType, has a default
/// constructor, and its id() is that id. One object of it is made in each program that needs it, and lives as long as
/// the program.
#define LGABENCH_ENVIRONMENT(id, version, summary, Class) \
  LGABENCH_PLUGIN_("environment", "", id, version, summary, ::lgabench::EnvironmentType, Class, "{}")

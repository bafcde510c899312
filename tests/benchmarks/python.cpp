// An episode from Python, against the same calls in C++; threads against Gymnasium's SyncVectorEnv
// (python_episodes.py).
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <sys/wait.h>

#include <cstdio>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/flush_denormals.hpp>
#include <mujoco/mujoco_world.hpp>

#include "benchmarks.hpp"

namespace lgabench {
namespace {

void loop(benchmark::State& state) {
  flush_denormals();
  const Scenario scenario = load_scenario("heart");
  const auto environment = make_environment(scenario, std::make_unique<MujocoWorld>());
  int index = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(environment->reset(test_scene(scenario, "cells", "test", 0, index++ % 100)));
    benchmark::DoNotOptimize(environment->step(environment->expert_action()));
  }
}

// Seconds an episode, as the child says: processor time, or with threads the clock's.
void in_python(benchmark::State& state, const char* how) {
  const std::string command =
      fmt::format("PYTHONPATH='{}' python3 '{}' {}", LGABENCH_PYTHONPATH, LGABENCH_PYTHON_EPISODES, how);
  double seconds = 0;
  FILE* child = popen(command.c_str(), "r");
  const bool answered = child && std::fscanf(child, "%lf", &seconds) == 1;
  const int status = child ? pclose(child) : -1;
  if (!answered)
    return state.SkipWithError(status == -1 || WEXITSTATUS(status) < 77 ? "python_episodes.py failed"
                                                                        : "built without LGABENCH_PYTHON");
  for (auto _ : state) state.SetIterationTime(seconds);
}

}  // namespace

void register_python() {
  benchmark::RegisterBenchmark("python/loop", loop);
  for (const char* how : {"binding", "threads", "sync"})
    benchmark::RegisterBenchmark(fmt::format("python/{}", how).c_str(), in_python, how)->UseManualTime();
}

}  // namespace lgabench

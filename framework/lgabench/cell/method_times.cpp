#include <lgabench/cell/method_times.hpp>

#include <fmt/format.h>

#include <chrono>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/answering.hpp>
#include <lgabench/cell/demonstrations.hpp>
#include <lgabench/cell/evaluator.hpp>
#include <lgabench/cell/runs_below.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/host/hosted_method.hpp>
#include <lgabench/plugin/guarded.hpp>

namespace lgabench {
namespace {

constexpr int calls = 50;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Adds a phase: what the call takes, divided by `times`.
template <class Call>
auto timed(MethodTimes& times, const HostedMethod& method, const char* name, Call&& call, int divided_by = 1) {
  const double cpu_s = method.used().cpu_s;
  const Clock::time_point start = Clock::now();
  auto result = call();
  const double wall_s = seconds_since(start);
  times.phases.push_back({name, wall_s / divided_by, (method.used().cpu_s - cpu_s) / divided_by});
  return result;
}

}  // namespace

MethodTimes time_of_use(HostJob job, Bench& bench, int demonstrations) {
  const Scenario& scenario = bench.scenario;
  job.environment = scenario.environment->id();
  job.task = scenario.task;
  job.may_stop = scenario.may_stop;
  job.hidden = runs_below(job.plugin.file.parent_path());
  const std::string& id = job.plugin.id;
  MethodTimes times;
  Answering asked(scenario, job, demonstrations);
  const Clock::time_point start = Clock::now();
  HostedMethod method(job);
  method.needs(job.options);  // the process answers: it has loaded its libraries
  times.phases.push_back({"start", seconds_since(start), method.used().cpu_s});

  Selected selected = timed(times, method, "select", [&] { return select(&method, id, scenario, asked.services); });
  if (selected.nothing_to_learn_from(scenario))
    throw InputError(fmt::format("{} selects nothing in {}: expected a scenario where it does", id, scenario.id));
  const std::vector<Scene> scenes =
      sample(scenario, bench.layout, selected, job.seed, scenario.training_scenes(demonstrations));
  bench.look_again(selected.needs);
  std::vector<Demonstration> shown =
      instructed(demonstrate(*bench.environment, scenes, selected.needs, scenario.utterances()), scenes, selected);
  const auto policy = timed(times, method, "learn", [&] {
    revise(method, id, scenario, shown, scenes, asked.services, selected);
    return learn(method, id, shown, asked.services, selected);
  });
  const Actor actor = policy_actor(*policy, selected.instructions, id);
  timed(
      times, method, "act",
      [&] {
        for (int i = 0; i < calls; ++i) {
          const auto& [scene, seen] = bench.sights[static_cast<std::size_t>(i) % bench.sights.size()];
          policy->reset();
          actor.act(*bench.environment, scene, seen);
        }
        return calls;
      },
      calls);
  const auto saved = timed(times, method, "save", [&] { return guarded(id, [&] { return policy->saved(); }); });
  if (saved)
    times.saved_bytes = saved->size();
  else
    times.phases.pop_back();
  times.peak_bytes = method.used().peak_bytes;
  guarded(id, [&] { method.end(); });
  return times;
}

}  // namespace lgabench

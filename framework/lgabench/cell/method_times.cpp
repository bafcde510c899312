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

constexpr std::uint64_t scene_seed = 7;
constexpr int tests_an_arm = 5, calls = 50;

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

MethodBench::MethodBench(Scenario scenario, const std::optional<PluginInfo>& engine, int demonstrations)
    : scenario_(std::move(scenario)), demonstrations_(demonstrations) {
  environment_ = make_environment(scenario_, load_engine(engine));
  for (const Arm& arm : scenario_.tests)
    for (int i = 0; i < tests_an_arm; ++i) {
      const Scene scene = test_scene(scenario_, layouts_of(scenario_).front(), arm.id, scene_seed, i);
      tests_.emplace_back(scene, environment_->reset(scene));
    }
}

MethodTimes MethodBench::use(HostJob job) {
  job.environment = scenario_.environment->id();
  job.task = scenario_.task;
  job.may_stop = scenario_.may_stop;
  job.hidden = runs_below(job.plugin.file.parent_path());
  const std::string& id = job.plugin.id;
  MethodTimes times;
  Answering asked(scenario_, job, demonstrations_);
  const Clock::time_point start = Clock::now();
  HostedMethod method(job);
  method.needs(job.options);  // the process answers: it has loaded its libraries
  times.phases.push_back({"start", seconds_since(start), method.used().cpu_s});

  Selected selected = timed(times, method, "select", [&] { return select(&method, id, scenario_, asked.services); });
  if (selected.nothing_to_learn_from(scenario_))
    throw InputError(fmt::format("{} selects nothing in {}: expected a scenario where it does", id, scenario_.id));
  const std::vector<Scene> scenes =
      sample(scenario_, layouts_of(scenario_).front(), selected, job.seed, scenario_.training_scenes(demonstrations_));
  environment_->show_shadows(selected.needs.shadows);
  std::vector<Demonstration> shown =
      instructed(demonstrate(*environment_, scenes, selected.needs, scenario_.utterances()), scenes, selected);
  const auto policy = timed(times, method, "learn", [&] {
    revise(method, id, scenario_, shown, scenes, asked.services, selected);
    return learn(method, id, shown, asked.services, selected);
  });
  const Actor actor = policy_actor(*policy, selected.instructions, id);
  timed(
      times, method, "act",
      [&] {
        for (int i = 0; i < calls; ++i) {
          const auto& [scene, seen] = tests_[static_cast<std::size_t>(i) % tests_.size()];
          policy->reset();
          actor.act(*environment_, scene, seen);
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

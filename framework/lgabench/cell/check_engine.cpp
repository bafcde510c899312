#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/check.hpp>
#include <lgabench/cell/engine_contract.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/plugin/guarded.hpp>

namespace lgabench {
namespace {

constexpr int scenes_a_task = 10, most_lost = 1;  // of a task
constexpr std::uint64_t engine_seed = 7;

// A scene played by the oracle to its end: what was seen before and after each step, and how it was judged, bit for
// bit.
struct Played {
  std::string bytes;
  bool success = false;
  std::string failure{};
};

std::string bytes_of(const Observation& seen) {
  std::string text(seen.ids.begin(), seen.ids.end());
  text.append(seen.rgb.begin(), seen.rgb.end());
  for (const double value : seen.state) text += fmt::format("{:a} ", value);
  return hex(hash64(text));
}

Played play(Environment& environment, const Scene& scene) {
  Played played{bytes_of(environment.reset(scene))};
  for (bool over = false; !over;) {
    const StepResult result = environment.step(environment.expert_action());
    played.bytes += fmt::format(" {} {}", bytes_of(result.observation), result.failure);
    played.success = result.is_success;
    played.failure = result.failure == failure::goes_on
                         ? fmt::format("the oracle has not ended it after {} steps", environment.most_steps())
                         : result.failure;
    over = result.terminated || result.truncated;
  }
  played.bytes += '\n';
  return played;
}

// The contract on a world of boxes, without the framework's renderer, which keeps threads of its own.
void use_alone(const PluginInfo& engine, CheckReport& report) {
  const auto world = load_engine(engine);
  world->load(contract_bodies(), contract_bodies_at_once);
  for (const ContractCheck& check : engine_contract()) {
    std::string fault;
    try {
      fault = check.fault(*world);
    } catch (const EngineError& e) {
      fault = e.what();
    }
    report.judge(check.name, fault, "as the contract says", check.remedy);
  }
}

// Scenes of one task, forwards and twice backwards. Returns their bytes.
std::string judge_task(const TaskInfo& task_info, const PluginInfo& engine, CheckReport& report) {
  const Scenario scenario = load_scenario(task_info.example);
  const auto environment = make_environment(scenario, load_engine(engine));
  const std::string& task = task_info.id;
  std::vector<Scene> scenes;
  std::vector<Played> forwards;
  int lost = 0;
  std::string last_lost;
  std::string all;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < scenes_a_task; ++i) {
    scenes.push_back(test_scene(scenario, task_info.layouts[static_cast<std::size_t>(i) % task_info.layouts.size()],
                                scenario.tests.front().id, engine_seed, i));
    forwards.push_back(play(*environment, scenes.back()));
    if (!forwards.back().success) {
      ++lost;
      last_lost = forwards.back().failure;
    }
    all += forwards.back().bytes;
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  report.judge(
      "oracle, " + task,
      lost <= most_lost ? "" : fmt::format("loses {} of {} scenes, one of them: {}", lost, scenes_a_task, last_lost),
      fmt::format("wins {} of {} scenes, {:.1f} ms each", scenes_a_task - lost, scenes_a_task,
                  1e3 * seconds / scenes_a_task),
      "bodies must rest where reset() puts them, hang at the gripper without lag, and yield to the spatula");

  std::string differs;
  const auto backwards = [&] {
    for (std::size_t i = scenes.size(); i-- > 0;)
      if (play(*environment, scenes[i]).bytes != forwards[i].bytes) differs = "a scene played again ended differently";
  };
  backwards();
  const long long before = ProcessState::now().heap_bytes;
  backwards();
  const long long grown = (ProcessState::now().heap_bytes - before) / scenes_a_task;
  report.judge("reset, " + task, differs, "pure: scenes in reverse order end alike, bit for bit",
               "reset() must drop all state of the solver: warm starts, contacts, velocities, the grip");
  report.judge("memory, " + task, grown > 4096 ? fmt::format("grows by {} bytes an episode", grown) : "",
               "does not grow", "reset() must free the memory of the last episode");
  return all;
}

}  // namespace

CheckReport check_engine(const PluginInfo& engine, const std::string& environment, const CheckPhase& phase) {
  CheckReport report;
  const ProcessState at_first = ProcessState::now();
  std::string all, doing = "a world of boxes";
  try {
    phase(doing, report);
    use_alone(engine, report);
    judge_leftovers(report, [&at_first] { return ProcessState::now().beyond(at_first); });
    for (const TaskInfo& task : environment.empty() ? installed_tasks() : find_environment(environment).tasks()) {
      phase(doing = "scenes of " + task.example, report);
      all += judge_task(task, engine, report);
    }
  } catch (const PluginError&) {
    throw;
  } catch (const std::exception& e) {
    report.problem(doing, e.what(), "this call must succeed: a run makes it too");
  }
  report.hashes = {{"episodes", sha256(all)}};
  return report;
}

}  // namespace lgabench

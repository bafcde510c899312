#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/check.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/plugin/guarded.hpp>

namespace lgabench {
namespace {

constexpr int scenes_a_task = 4;
constexpr std::uint64_t engine_seed = 7;

// A scene played by the oracle: what was seen before and after, and how it was judged, bit for bit.
struct Played {
  std::string bytes;
  bool success = false;
};

std::string bytes_of(const Observation& seen) {
  std::string text(seen.ids.begin(), seen.ids.end());
  text.append(seen.rgb.begin(), seen.rgb.end());
  return hex(hash64(text));
}

Played play(Environment& environment, const Scene& scene) {
  const std::string before = bytes_of(environment.reset(scene));
  const StepResult result = environment.step(environment.expert_action());
  return {fmt::format("{} {} {}\n", before, bytes_of(result.observation), result.failure), result.is_success};
}

// A block is reset, lifted and let go, without the framework's renderer, which keeps threads of its own.
void use_alone(const PluginInfo& engine) {
  const auto world = load_engine(engine);
  BodyModel block{"block", {{}}};
  for (const double x : {-.02, .02})
    for (const double y : {-.03, .03})
      for (const double z : {.0, .04}) block.pieces[0].corners_m.push_back({x, y, z});
  world->load({block}, 1);
  world->reset({{0, {{.5, 0, 0}, {}}}});
  world->grip(0, {{.5, 0, .04}, {}});
  for (int i = 1; i <= 20; ++i) {
    world->move_gripper({{.5, .002 * i, .04 + .001 * i}, {}});
    world->step();
  }
  world->release();
  world->step();
}

// Scenes of one task, forwards and twice backwards. Returns their bytes.
std::string judge_task(const TaskInfo& task_info, const PluginInfo& engine, CheckReport& report) {
  const Scenario scenario = load_scenario(task_info.example);
  const auto environment = make_environment(scenario, load_engine(engine));
  const std::string& task = task_info.id;
  std::vector<Scene> scenes;
  std::vector<Played> forwards;
  int won = 0;
  std::string all;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < scenes_a_task; ++i) {
    scenes.push_back(test_scene(scenario, task_info.layouts[static_cast<std::size_t>(i) % task_info.layouts.size()],
                                scenario.tests.front().id, engine_seed, i));
    forwards.push_back(play(*environment, scenes.back()));
    won += forwards.back().success;
    all += forwards.back().bytes;
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  report.judge("oracle, " + task,
               won > 0 ? "" : fmt::format("wins none of {} scenes; the last: {}", scenes_a_task, forwards.back().bytes),
               fmt::format("wins {} of {} scenes, {:.1f} ms each", won, scenes_a_task, 1e3 * seconds / scenes_a_task),
               "bodies must rest where reset() puts them, hang at the gripper without lag, and yield to the spatula");

  std::string differs;
  const auto backwards = [&] {
    for (std::size_t i = scenes.size(); i-- > 0;)
      if (play(*environment, scenes[i]).bytes != forwards[i].bytes) differs = "a scene played again ended otherwise";
  };
  backwards();
  const long long before = ProcessState::now().heap_bytes;
  backwards();
  const long long grown = (ProcessState::now().heap_bytes - before) / scenes_a_task;
  report.judge("reset, " + task, differs, "pure: scenes in reverse order end alike, bit for bit",
               "reset() must drop all state of the solver: warm starts, contacts, velocities, the grip");
  report.judge("memory, " + task, grown > 4096 ? fmt::format("grows by {} bytes an episode", grown) : "",
               "does not grow", "reset() must give back what the last episode took");
  return all;
}

}  // namespace

CheckReport check_engine(const PluginInfo& engine, const std::string& environment, const CheckPhase& phase) {
  CheckReport report;
  const ProcessState at_first = ProcessState::now();
  std::string all, doing = "a block alone";
  try {
    phase(doing);
    use_alone(engine);
    judge_leftovers(report, [&at_first] { return ProcessState::now().beyond(at_first); });
    for (const TaskInfo& task : environment.empty() ? installed_tasks() : find_environment(environment).tasks()) {
      phase(doing = "scenes of " + task.example);
      all += judge_task(task, engine, report);
    }
  } catch (const PluginError&) {
    throw;
  } catch (const std::exception& e) {
    report.problem(doing, e.what(), "this call must succeed: a run makes the same");
  }
  report.hashes = {{"episodes", sha256(all)}};
  return report;
}

}  // namespace lgabench

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/check.hpp>
#include <lgabench/cell/engine_contract.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/read_space.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/suggest.hpp>
#include <lgabench/plugin/guarded.hpp>

namespace lgabench {
namespace {

constexpr int scenes_a_task = 10;
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
  int steps = 0;
  for (bool over = false; !over; ++steps) {
    const StepResult result = environment.step(environment.expert_action());
    played.bytes += fmt::format(" {} {}", bytes_of(result.observation), result.failure);
    played.success = result.is_success;
    played.failure = result.failure;
    over = result.terminated || result.truncated;
  }
  if (environment.most_steps() > 1)
    played.failure = fmt::format("scene {} of {}, step {}: {}", scene.index, scene.arm, steps,
                                 played.failure == failure::goes_on ? "the oracle has not ended it" : played.failure);
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

// What must be otherwise where a check of a task fails.
struct Remedies {
  const char *oracle, *reset, *memory;
};
constexpr Remedies of_engine{
    "bodies must rest where reset() puts them, hang at the gripper without lag, and yield to the spatula",
    "reset() must drop all state of the solver: warm starts, contacts, velocities, the grip",
    "reset() must free the memory of the last episode"};
constexpr Remedies of_environment{
    "expert_action() must lead to success from every state that it leads to",
    "reset() must drop all state of the last episode, and draw nothing from a clock or an address",
    "reset() must free the memory of the last episode"};

// Scenes of one task, forwards and twice backwards. Returns their bytes.
std::string judge_task(const TaskInfo& task_info, const Scenario& scenario, Environment& environment, int most_lost,
                       const Remedies& remedies, CheckReport& report) {
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
    forwards.push_back(play(environment, scenes.back()));
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
      remedies.oracle);

  std::string differs;
  const auto backwards = [&] {
    for (std::size_t i = scenes.size(); i-- > 0;)
      if (play(environment, scenes[i]).bytes != forwards[i].bytes) differs = "a scene played again ended differently";
  };
  backwards();
  const long long before = ProcessState::now().heap_bytes;
  backwards();
  const long long grown = (ProcessState::now().heap_bytes - before) / scenes_a_task;
  report.judge("reset, " + task, differs, "pure: scenes in reverse order end alike, bit for bit", remedies.reset);
  report.judge("memory, " + task, grown > 4096 ? fmt::format("grows by {} bytes an episode", grown) : "",
               "does not grow", remedies.memory);
  return all;
}

// What else may be taken ends the episode by a word of the environment's own, or wins: the row random_object does so.
void judge_others(const TaskInfo& task, const Scenario& scenario, Environment& environment, CheckReport& report) {
  std::set<std::string> ends;
  for (int i = 0; i < scenes_a_task; ++i) {
    const Scene scene = test_scene(scenario, task.layouts.front(), scenario.tests.front().id, engine_seed, i);
    std::vector<std::uint8_t> ids;
    for (const Instance& one : environment.reset(scene).instances)
      if (!is_place(one.object_type)) ids.push_back(one.id);
    if (ids.empty()) continue;
    const std::uint8_t id = ids[static_cast<std::size_t>(i) % ids.size()];
    StepResult result;
    do result = environment.step(environment.expert_action_for(id));
    while (!result.terminated && !result.truncated);
    ends.insert(result.failure);
  }
  report.ok("any object, " + task.id, fmt::format("episodes end as {}", fmt::join(ends, ", ")));
}

// heat_map's map has so many cells, whatever the picture.
constexpr int map_rows = 32, map_columns = 64;

void judge_description(const EnvironmentType& environment, CheckReport& report) {
  const PictureSize size = environment.picture_size();
  const std::vector<std::string> known = feature_space_ids();
  for (const std::string& space : environment.spaces())
    if (!contains(known, space))
      report.problem("spaces", none_named("feature space", space, known),
                     "name spaces that are there: NAME.json beside the scenarios");
  report.judge("description", environment.tasks().empty() ? "it has no task" : "",
               fmt::format("{} task(s), an action of {} numbers, {} x {} pixels", environment.tasks().size(),
                           environment.action_space().size(), size.rows, size.columns),
               "name a task with an example scenario");
  if (environment.action_space().places.empty())
    report.note(
        "heat maps", "actions have no place in the picture: policy=heat_map and the rules that take a place do not run",
        "give `places` (ActionSpace::places) where two numbers of an action are a place that the picture shows");
  else if (size.rows % map_rows != 0 || size.columns % map_columns != 0 || size.columns != 2 * size.rows)
    report.note("heat maps",
                fmt::format("{} x {} pixels: policy=heat_map has {} x {} cells, and distorts or refuses the picture",
                            size.rows, size.columns, map_rows, map_columns),
                "128 x 256 pixels fit");
}

// Sampled twice, and drawn as reset() shows them.
void judge_scenes(const EnvironmentType& environment, const TaskInfo& task, const Scenario& scenario,
                  Environment& played, CheckReport& report) {
  std::string fault;
  for (const std::string& layout : task.layouts)
    for (int i = 0; i < scenes_a_task && fault.empty(); ++i) {
      const auto scene_of = [&] { return test_scene(scenario, layout, scenario.tests.front().id, engine_seed, i); };
      const Scene scene = scene_of();
      if (scene.hash() != scene_of().hash())
        fault = fmt::format("scene {} of {} differs the second time", i, layout);
      else if (bytes_of(environment.draw(scene)) != bytes_of(played.reset(scene)))
        fault = fmt::format("draw() shows scene {} of {} otherwise than reset()", i, layout);
    }
  report.judge("scenes, " + task.id, fault, "the same scene the second time, drawn as reset() shows it",
               "draw every random number from the stream that is given, and read no clock");
}

// Does the checks, which say what they begin with, and add to `all` what was seen in each episode, bit for bit. What
// they throw is a finding on what they were doing.
using Begins = std::function<void(const std::string& doing)>;
using Checks = std::function<void(CheckReport& report, std::string& all, const Begins& begins)>;
CheckReport report_of(const CheckPhase& phase, const Checks& checks) {
  CheckReport report;
  std::string all, doing;
  try {
    checks(report, all, [&](const std::string& what) { phase(doing = what, report); });
  } catch (const PluginError&) {
    throw;
  } catch (const std::exception& e) {
    report.problem(doing, e.what(), "this call must succeed: a run makes it too");
  }
  report.hashes = {{"episodes", sha256(all)}};
  return report;
}

}  // namespace

CheckReport check_environment(const PluginInfo& plugin, const std::optional<PluginInfo>& engine,
                              const CheckPhase& phase) {
  const ProcessState at_first = ProcessState::now();
  return report_of(phase, [&](CheckReport& report, std::string& all, const Begins& begins) {
    begins("its description");
    const EnvironmentType& environment = find_environment(plugin.id);
    judge_description(environment, report);
    for (const TaskInfo& task : environment.tasks()) {
      begins("scenes of " + task.example);
      const Scenario scenario = load_scenario(task.example);
      const auto played = make_environment(scenario, load_engine(engine));
      judge_scenes(environment, task, scenario, *played, report);
      all += judge_task(task, scenario, *played, 0, of_environment, report);
      begins("any object in scenes of " + task.example);
      judge_others(task, scenario, *played, report);
    }
    if (plugin.python.is_null()) judge_leftovers(report, [&at_first] { return ProcessState::now().beyond(at_first); });
  });
}

CheckReport check_engine(const PluginInfo& engine, const std::string& environment, const CheckPhase& phase) {
  const ProcessState at_first = ProcessState::now();
  return report_of(phase, [&](CheckReport& report, std::string& all, const Begins& begins) {
    begins("a world of boxes");
    use_alone(engine, report);
    judge_leftovers(report, [&at_first] { return ProcessState::now().beyond(at_first); });
    for (const TaskInfo& task : environment.empty() ? installed_tasks() : find_environment(environment).tasks()) {
      begins("scenes of " + task.example);
      constexpr int most_lost = 1;  // an engine may grip amiss
      const Scenario scenario = load_scenario(task.example);
      const auto played = make_environment(scenario, load_engine(engine));
      all += judge_task(task, scenario, *played, most_lost, of_engine, report);
    }
  });
}

}  // namespace lgabench

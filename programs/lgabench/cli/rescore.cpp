// lgabench rescore RUN: what was recorded, judged by other limits, without the method.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

#include <lgabench/cli/commands.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/counted_progress.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/statistics/pose.hpp>
#include <lgabench/worker/played_scenes.hpp>

namespace lgabench::cli {
namespace {

using namespace worker;

struct RescoreArguments {
  fs::path run, json;
  std::string judge = "physics";
  JudgeLimits limits;
  statistics::PoseTolerance within;
  std::vector<fs::path> plugin_path;
};

// An episode that was judged again; without `problem` that is what it is.
struct Rescored {
  bool success = false;
  std::optional<double> distance_m{};
  std::string problem{};
};

// Plays the recorded action once more. What then does not end as recorded is judged by nobody: another build or
// processor plays it.
Rescored by_physics(Environment& environment, const Scene& scene, const Episode& episode, const JudgeLimits& limits) {
  environment.reset(scene);
  const StepResult end = environment.step(episode.action);
  if (end.failure != episode.failure)
    return {false, {}, fmt::format("ends as {} here, recorded as {}", end.failure, episode.failure)};
  const Rejudged again = environment.judged_again(limits);
  return {again.failure == failure::none, again.distance_m};
}

// The farther of an action's two ends from the oracle's, of the target for which that is least.
Rescored by_pose(Environment& environment, const Scene& scene, const Scenario& scenario, const Episode& episode,
                 const statistics::PoseTolerance& within) {
  const EnvironmentType& type = *scenario.environment;
  const TaskInfo& task = statistics::task_judged_by_pose(type.id(), scenario.task);
  environment.reset(scene);
  Rescored rescored;
  for (const SceneObject& object : scene.objects) {
    if (object.role != role::target) continue;
    const auto off = type.distance(task, episode.action, environment.expert_action_for(object.instance_id));
    const double farther_m = std::max(off->begin_m, off->end_m);
    if (!rescored.distance_m || farther_m < *rescored.distance_m) rescored.distance_m = farther_m;
    rescored.success = rescored.success || statistics::is_within(*off, within);
  }
  return rescored;
}

Rescored rescored(const RescoreArguments& a, PlayedScenes& scenes, const PlayedScenes::Played& cell,
                  const Episode& episode) {
  if (episode.action.empty()) return {};  // nothing was done, which no limit makes a success
  try {
    const Scene scene = PlayedScenes::scene(cell, episode.arm, episode.index, episode.scene);
    Environment* const environment = scenes.on(cell.cell.engine, cell.scenario);
    if (!environment) return {false, {}, "the run's engine is not installed: " + cell.cell.engine};
    return a.judge == "pose" ? by_pose(*environment, scene, cell.scenario, episode, a.within)
                             : by_physics(*environment, scene, episode, a.limits);
  } catch (const Error& e) {
    return {false, {}, one_line(e.what())};
  }
}

struct Mean {
  int episodes = 0, recorded = 0, rescored = 0, distances = 0;
  double distance_m = 0;

  void add(const Episode& episode, const Rescored& again) {
    ++episodes;
    recorded += episode.success();
    rescored += again.success;
    if (!again.distance_m) return;
    ++distances;
    distance_m += *again.distance_m;
  }
};

struct ByRow {
  std::string row, arm;
  int demonstrations = 0;
  Mean mean{};
};

void print(const RescoreArguments& a, const std::vector<ByRow>& rows) {
  const auto limit = [](const std::optional<double>& given, const char* unit) {
    return given ? fmt::format("{:g} {}", *given, unit) : std::string("the protocol's");
  };
  if (a.judge == "pose")
    to_stdout(
        "Judged by pose: begins within {:g} m of the oracle's action, ends within {:g} m, turns within {:g} degrees\n",
        a.within.begin_m, a.within.end_m, a.within.turn_deg);
  else
    to_stdout("Judged by physics: position {}, angle {}\n", limit(a.limits.position_m, "m"),
              limit(a.limits.angle_deg, "degrees"));
  std::size_t row = 3, arm = 3;
  for (const ByRow& one : rows) row = std::max(row, one.row.size()), arm = std::max(arm, one.arm.size());
  to_stdout("\n{:<{}}  {:<{}}  demos  episodes  recorded  rescored  distance\n", "row", row, "arm", arm);
  for (const auto& [name, of_arm, demonstrations, mean] : rows) {
    const double count = std::max(1, mean.episodes);
    to_stdout("{:<{}}  {:<{}}  {:5}  {:8}  {:8.3f}  {:8.3f}  {}\n", name, row, of_arm, arm, demonstrations,
              mean.episodes, mean.recorded / count, mean.rescored / count,
              mean.distances ? fmt::format("{:.4f} m", mean.distance_m / mean.distances) : "-");
  }
}

Json line_of(const statistics::CellResult& cell, const Episode& episode, const Rescored& again) {
  Json line{{"cell", cell.key},
            {"row", cell.method},
            {"scenario", cell.scenario},
            {"arm", episode.arm},
            {"index", episode.index},
            {"success", episode.success()},
            {"rescored", again.problem.empty() ? Json(again.success) : Json()},
            {"distance_m", again.distance_m ? Json(*again.distance_m) : Json()}};
  if (!again.problem.empty()) line["problem"] = again.problem;
  return line;
}

// Says which cells have no episodes, and why; whether there are any.
bool name_lacking(const statistics::RunResults& run) {
  const auto has_failed = [](const statistics::CellResult& cell) { return cell.failed; };
  const auto failed = static_cast<std::size_t>(std::count_if(run.cells.begin(), run.cells.end(), has_failed));
  for (const std::string& why : run.unreadable) to_stderr("left out: {}\n", why);
  if (failed > 0) to_stderr("{} failed cells have no episodes\n", failed);
  if (run.not_run > 0) to_stderr("{} cells have not been played\n", run.not_run);
  return failed + run.unreadable.size() > 0 || run.not_run > 0;
}

int rescore(const RescoreArguments& a) {
  const statistics::RunResults run = statistics::read_run(a.run);
  PlayedScenes scenes(a.plugin_path);
  std::vector<ByRow> rows;
  std::string lines;
  constexpr int most_named = 10;
  int left_out = 0;
  CountedProgress progress("cells judged:", static_cast<int>(run.cells.size()));
  for (const statistics::CellResult& cell : run.cells) {
    progress.tell_next();
    if (cell.failed) continue;
    const PlayedScenes::Played& played = scenes.cell((a.run / "cells" / cell.key / cell_file::configuration).string());
    if (a.judge == "pose") statistics::task_judged_by_pose(played.scenario.environment->id(), played.scenario.task);
    for (const std::string& arm : cell.arms) {
      const auto is_row = [&](const ByRow& one) {
        return one.row == cell.method && one.arm == arm && one.demonstrations == cell.demonstrations;
      };
      auto row = std::find_if(rows.begin(), rows.end(), is_row);
      if (row == rows.end()) row = rows.insert(rows.end(), {cell.method, arm, cell.demonstrations});
      for (const Episode& episode : cell.episodes.at(arm)) {
        const Rescored again = rescored(a, scenes, played, episode);
        if (!a.json.empty()) lines += canonical(line_of(cell, episode, again)) + "\n";
        if (again.problem.empty())
          row->mean.add(episode, again);
        else if (++left_out <= most_named)
          to_stderr("left out: {}/{}/{}: {}\n", cell.key, arm, episode.index, again.problem);
      }
    }
  }
  progress.end();
  print(a, rows);
  if (!a.json.empty()) write_file(a.json, lines);
  const bool lacks = name_lacking(run);
  if (left_out) to_stderr("{} episodes could not be judged again and are left out\n", left_out);
  return left_out || lacks ? cells_failed : ok;
}

}  // namespace

void add_rescore(CLI::App& app, int& exit) {
  auto a = std::make_shared<RescoreArguments>();
  Verb verb(app, "rescore", worker_summary("rescore"));
  verb.option("run RUN", a->run, "The run's directory", required);
  verb.option("--judge physics|pose", a->judge,
              "physics: where the recorded action leaves the target; pose: how far the action is from the oracle's",
              one_of("judge", {"physics", "pose"}), with_default);
  auto* position = verb.option("--position-tolerance METRES", a->limits.position_m,
                               "physics: how far from the asked place the target's centre may end (default: the "
                               "protocol's; in an asked area, the centre must also be this near to the middle)",
                               within(0, 10));
  const std::function<void(const double&)> turn = [a](const double& degrees) {
    a->limits.angle_deg = a->within.turn_deg = degrees;
  };
  verb.option("--angle-tolerance DEGREES", turn, "How far a turn may be from the asked one (default: 15)",
              within(0, 180));
  const std::function<void(const std::vector<double>&)> tolerate = [a](const std::vector<double>& metres) {
    a->within.begin_m = metres.at(0);
    a->within.end_m = metres.at(1);
  };
  auto* poses =
      verb.option("--within BEGIN,END", tolerate,
                  "pose: how many metres apart the two actions may begin and end (default: 0.07,0.10)", within(0, 10))
          ->expected(2);
  verb.option("--json FILE", a->json, "Also write a line of JSON for each episode (docs/formats)");
  add_plugin_path(verb, a->plugin_path);
  verb->footer(
      "rescore carries out the recorded actions on the recorded engine, without the method; RUN does not change. "
      "Without tolerances, physics gives the recorded verdicts. Episodes that do not end here as recorded, or whose "
      "scene cannot be made again, are named and left out, as are cells that failed, are damaged or were not played; "
      "the exit status is then 3.\n"
      "Example: lgabench rescore runs/q1 --position-tolerance 0.05 --json rescored.jsonl");
  verb->callback([a, position, poses, &exit] {
    const bool by_pose = a->judge == "pose";
    if (by_pose && position->count() > 0) throw InputError("--position-tolerance: expected --judge physics");
    if (!by_pose && poses->count() > 0) throw InputError("--within: expected --judge pose");
    exit = rescore(*a);
  });
}

}  // namespace lgabench::cli

// lgabench rescore RUN: what was recorded, judged by other limits, without the method.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

#include <lgabench/cli/commands.hpp>
#include <lgabench/cli/outcome.hpp>
#include <lgabench/cli/played_scenes.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/geometry.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/counted_progress.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/report/report.hpp>

namespace lgabench::cli {
namespace {

// How far an action may lie from the oracle's. The paper counts "the correct action on the target object within radius
// ε of the goal" (section 5) and does not give ε.
struct PoseTolerance {
  double begin_m = .07, end_m = .10;  // grasp and place; a sweep's beginning and end
  double turn_deg = 15;               // where the task asks for a turn
};

bool is_within(const ActionDistance& distance, const PoseTolerance& tolerance) {
  return distance.begin_m <= tolerance.begin_m && distance.end_m <= tolerance.end_m &&
         distance.turn_rad <= tolerance.turn_deg * pi / 180;
}

// Whether one action decides each episode.
bool has_one_action(const Scenario& scenario) {
  return find_task(*scenario.environment, scenario.task).most_steps == 1 && !scenario.may_stop;
}

// The environment's task. @throws InputError where the environment does not compare actions by pose
const TaskInfo& task_judged_by_pose(const Scenario& scenario) {
  const EnvironmentType& type = *scenario.environment;
  const TaskInfo& of = find_task(type, scenario.task);
  if (!has_one_action(scenario))
    throw InputError(fmt::format(
        "--judge pose: an episode of {} has several steps or may have none: no one action decides it", scenario.task));
  const Action any(type.action_space().size(), 1);
  if (!type.distance(of, any, any))
    throw InputError(fmt::format("--judge pose: {} does not compare actions by pose", type.id()));
  return of;
}

// Other limits judge the end that an action leads to; within an episode of several steps they would have ended another.
void expect_one_action(const Scenario& scenario) {
  if (!has_one_action(scenario))
    throw InputError(
        fmt::format("rescore: an episode of {} has several steps or may have none: with other limits it would have "
                    "ended at another one",
                    scenario.task));
}

struct RescoreArguments {
  fs::path run, json;
  std::string judge = "physics", format = "rows";
  JudgeLimits limits;
  PoseTolerance within;
  std::vector<fs::path> plugin_path;
};

constexpr const char* far_from_oracle = "far_from_oracle";

// An episode that was judged again; without `problem` that is what it is.
struct Rescored {
  Failure failure{};
  std::optional<double> distance_m{};
  std::string problem{};

  bool success() const { return failure == failure::none; }
};

Rescored not_judged(std::string why) { return {{}, {}, std::move(why)}; }

// Plays the recorded action once more. What then does not end as recorded is judged by nobody: another build or
// processor plays it.
Rescored by_physics(Environment& environment, const Scene& scene, const Episode& episode, const JudgeLimits& limits) {
  environment.reset(scene);
  const StepResult end = carry_out(environment, scene, episode.actions());
  if (end.failure != episode.failure)
    return not_judged(fmt::format("ends as {} here, recorded as {}", end.failure, episode.failure));
  if (environment.most_steps() > 1 || scene.errand) return {end.failure};
  const Rejudged again = environment.judged_again(limits);
  return {again.failure, again.distance_m};
}

// The farther of an action's two ends from the oracle's, of the target for which that is least.
Rescored by_pose(Environment& environment, const Scene& scene, const Scenario& scenario, const Episode& episode,
                 const PoseTolerance& within) {
  const EnvironmentType& type = *scenario.environment;
  const TaskInfo& task = task_judged_by_pose(scenario);
  environment.reset(scene);
  bool near = false;
  std::optional<double> distance_m;
  for (const SceneObject& object : scene.objects) {
    if (object.role != role::target) continue;
    const auto off = type.distance(task, episode.action, environment.expert_action_for(object.instance_id));
    const double farther_m = std::max(off->begin_m, off->end_m);
    if (!distance_m || farther_m < *distance_m) distance_m = farther_m;
    near = near || is_within(*off, within);
  }
  return {near ? failure::none : episode.success() ? far_from_oracle : episode.failure, distance_m};
}

Rescored rescored(const RescoreArguments& a, PlayedScenes& scenes, const PlayedScenes::Played& cell,
                  const Episode& episode) {
  if (episode.action.empty()) return {episode.failure};  // nothing was done, which no limit makes a success
  try {
    const Scene scene = PlayedScenes::scene(cell, episode.arm, episode.index, episode.scene);
    Environment* const environment = scenes.on(cell.cell.engine, cell.scenario);
    if (!environment) return not_judged("the run's engine is not installed: " + cell.cell.engine);
    return a.judge == "pose" ? by_pose(*environment, scene, cell.scenario, episode, a.within)
                             : by_physics(*environment, scene, episode, a.limits);
  } catch (const Error& e) {
    return not_judged(one_line(e.what()));
  }
}

struct Mean {
  int episodes = 0, recorded = 0, rescored = 0, distances = 0;
  double distance_m = 0;

  void add(const Episode& episode, const Rescored& again) {
    ++episodes;
    recorded += episode.success();
    rescored += again.success();
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

void print_judge(const RescoreArguments& a) {
  const auto limit = [](const std::optional<double>& given, const char* unit) {
    return given ? fmt::format("{:g} {}", *given, unit) : std::string("the protocol's");
  };
  if (a.judge == "pose")
    to_stdout(
        "Judged by pose: begins within {:g} m of the oracle's action, ends within {:g} m, turns within {:g} "
        "degrees\n\n",
        a.within.begin_m, a.within.end_m, a.within.turn_deg);
  else
    to_stdout("Judged by physics: position {}, angle {}\n\n", limit(a.limits.position_m, "m"),
              limit(a.limits.angle_deg, "degrees"));
}

void print_rows(const std::vector<ByRow>& rows) {
  std::size_t row = 3, arm = 3;
  for (const ByRow& one : rows) {
    row = std::max(row, one.row.size());
    arm = std::max(arm, one.arm.size());
  }
  to_stdout("{:<{}}  {:<{}}  demos  episodes  recorded  rescored  distance\n", "row", row, "arm", arm);
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
            {"rescored", again.problem.empty() ? Json(again.success()) : Json()},
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

// The run's numbers as this judge has them. @pre each episode was judged
void print_report_of(const RescoreArguments& a, statistics::RunResults run) {
  const report::Report report = report::unwritten_report(std::move(run));
  if (a.format == "json") {
    to_stdout("{}\n", canonical(statistics::to_json(report.summary)));
  } else if (a.format == "csv") {
    to_stdout("{}", report::to_csv(report.summary));
  } else {
    print_judge(a);
    print_tables(report);
  }
}

int rescore(const RescoreArguments& a) {
  statistics::RunResults run = statistics::read_run(a.run);
  PlayedScenes scenes(a.plugin_path);
  std::vector<ByRow> rows;
  std::string lines;
  constexpr int most_named = 10;
  int left_out = 0;
  CountedProgress progress("cells judged:", static_cast<int>(run.cells.size()));
  for (statistics::CellResult& cell : run.cells) {
    progress.tell_next();
    if (cell.failed) continue;
    const PlayedScenes::Played& played = scenes.cell((a.run / "cells" / cell.key / cell_file::configuration).string());
    if (a.judge == "pose") task_judged_by_pose(played.scenario);
    if (a.limits.position_m || a.limits.angle_deg) expect_one_action(played.scenario);
    for (const std::string& arm : cell.arms) {
      const auto is_row = [&](const ByRow& one) {
        return one.row == cell.method && one.arm == arm && one.demonstrations == cell.demonstrations;
      };
      auto row = std::find_if(rows.begin(), rows.end(), is_row);
      if (row == rows.end()) row = rows.insert(rows.end(), {cell.method, arm, cell.demonstrations});
      for (Episode& episode : cell.episodes.at(arm)) {
        const Rescored again = rescored(a, scenes, played, episode);
        if (!a.json.empty()) lines += canonical(line_of(cell, episode, again)) + "\n";
        if (!again.problem.empty()) {
          if (++left_out <= most_named)
            to_stderr("left out: {}/{}/{}: {}\n", cell.key, arm, episode.index, again.problem);
          continue;
        }
        row->mean.add(episode, again);
        episode.failure = again.failure;
        if (again.success()) episode.attribution.clear();
      }
    }
  }
  progress.end();
  if (!a.json.empty()) write_file(a.json, lines);
  const bool lacks = name_lacking(run);
  if (left_out) to_stderr("{} episodes could not be judged again and are left out\n", left_out);
  if (a.format == "rows") {
    print_judge(a);
    print_rows(rows);
  } else if (left_out) {
    throw InputError(fmt::format("--format {}: expected that each episode can be judged again", a.format));
  } else {
    print_report_of(a, std::move(run));
  }
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
  verb.option(
      "--format rows|tables|json|csv", a->format,
      "rows: success as recorded beside the other judge's; tables, json, csv: the report's, with intervals, as the "
      "other judge has them",
      one_of("format", {"rows", "tables", "json", "csv"}), with_default);
  verb.option("--json FILE", a->json, "Also write a line of JSON for each episode (docs/formats)");
  add_plugin_path(verb, a->plugin_path);
  add_scenario_path(verb);
  verb->footer(
      "rescore carries out the recorded actions on the recorded engine, without the method; RUN does not change. "
      "Without tolerances, physics gives the recorded verdicts. Episodes that do not end here as recorded, or whose "
      "scene cannot be made again, are named and left out, as are cells that failed, are damaged or were not played; "
      "the exit status is then 3.\n"
      "Example: lgabench rescore runs/q1 --position-tolerance 0.05 --json rescored.jsonl\n"
      "         lgabench rescore runs/q1 --judge pose --within 0.10,0.10 --format tables");
  verb->callback([a, position, poses, &exit] {
    const bool by_pose = a->judge == "pose";
    if (by_pose && position->count() > 0) throw InputError("--position-tolerance: expected --judge physics");
    if (!by_pose && poses->count() > 0) throw InputError("--within: expected --judge pose");
    exit = rescore(*a);
  });
}

}  // namespace lgabench::cli

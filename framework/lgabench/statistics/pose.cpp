#include <lgabench/statistics/pose.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/geometry.hpp>
#include <lgabench/job/job.hpp>
#include <lgabench/job/worker.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench::statistics {
namespace {

constexpr const char* far_from_oracle = "far_from_oracle";

// The oracle's state differs by engine in the last digits.
using SceneOn = std::pair<std::string, std::string>;  // engine, the scene's hash

std::map<SceneOn, std::vector<Action>> oracle_actions(const RunResults& run) {
  std::vector<SceneOn> scenes;
  std::map<SceneOn, std::vector<Action>> known;
  Json requests = Json::array();
  for (const CellResult& cell : run.cells)
    for (const auto& [arm, episodes] : cell.episodes)
      for (const Episode& episode : episodes) {
        if (!known.emplace(SceneOn{cell.engine, episode.scene}, std::vector<Action>()).second) continue;
        scenes.emplace_back(cell.engine, episode.scene);
        requests.push_back(to_json(OracleRequest{run.directory / "cells" / cell.key / cell_file::configuration, arm,
                                                 episode.index, episode.scene}));
      }
  const WorkerAnswers answers = ask_worker("oracle", requests);
  if (!answers.problem.empty()) throw InputError("--judge pose: " + answers.problem);
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const OracleActions actions = read_oracle_actions(JsonReader(answers.lines[i], "lgabench-worker oracle"));
    if (!actions.problem.empty())
      throw InputError(
          fmt::format("--judge pose: {}: scene {}: {}", run.directory.string(), scenes[i].second, actions.problem));
    known[scenes[i]] = actions.actions;
  }
  return known;
}

// What the cell's scenario is played in. @throws InputError where actions are not compared there.
std::pair<const EnvironmentType*, const TaskInfo*> played_in(const RunResults& run, const CellResult& cell) {
  const fs::path file = run.directory / "cells" / cell.key / cell_file::configuration;
  const Json json = read_json(file);
  const std::string task = JsonReader(json, file.string()).at("scenario").at("task").string();
  return {&find_environment(cell.environment), &task_judged_by_pose(cell.environment, task)};
}

}  // namespace

bool is_within(const ActionDistance& distance, const PoseTolerance& tolerance) {
  return distance.begin_m <= tolerance.begin_m && distance.end_m <= tolerance.end_m &&
         distance.turn_rad <= tolerance.turn_deg * pi / 180;
}

const TaskInfo& task_judged_by_pose(const std::string& environment, const std::string& task) {
  const EnvironmentType& type = find_environment(environment);
  const TaskInfo& of = find_task(type, task);
  const Action any(type.action_space().size(), 1);
  if (!type.distance(of, any, any))
    throw InputError(fmt::format("--judge pose: {} does not compare actions by pose", environment));
  return of;
}

void judge_by_pose(RunResults& run, const PoseTolerance& tolerance) {
  std::map<std::string, std::pair<const EnvironmentType*, const TaskInfo*>> played;  // by scenario
  for (const CellResult& cell : run.cells)
    if (!cell.failed && played.count(cell.scenario) == 0) played[cell.scenario] = played_in(run, cell);
  const auto oracle = oracle_actions(run);
  for (CellResult& cell : run.cells)
    for (auto& [arm, episodes] : cell.episodes)
      for (Episode& episode : episodes) {
        if (episode.action.empty()) continue;
        const auto& in = played.at(cell.scenario);  // a name for each of the pair could not be captured in C++17
        const auto& right = oracle.at({cell.engine, episode.scene});
        const bool near = std::any_of(right.begin(), right.end(), [&](const Action& action) {
          return is_within(*in.first->distance(*in.second, episode.action, action), tolerance);
        });
        if (near)
          episode.failure = failure::none;
        else if (episode.success())
          episode.failure = far_from_oracle;
        if (near) episode.attribution.clear();
      }
}

}  // namespace lgabench::statistics

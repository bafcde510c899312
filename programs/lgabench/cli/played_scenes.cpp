#include <lgabench/cli/played_scenes.hpp>

#include <fmt/format.h>

#include <iostream>
#include <iterator>
#include <set>
#include <utility>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/shown.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench::cli {

PlayedScenes::PlayedScenes(const std::vector<std::filesystem::path>& more)
    : catalogue_(scan_plugins(plugin_directories(more))) {}

const PlayedScenes::Played& PlayedScenes::cell(const std::string& file) {
  const auto known = cells_.find(file);
  if (known != cells_.end()) return *known->second;
  Cell read = read_cell(read_json(file), file);
  Scenario scenario = read_scenario(*read.scenario, file + ": /scenario");
  return *(cells_[file] = std::make_unique<Played>(Played{std::move(read), std::move(scenario)}));
}

Scene PlayedScenes::scene(const Played& played, const std::string& arm, int index, const std::string& hash) {
  Scene scene =
      test_scene(played.scenario, played.cell.layout, arm, played.cell.scene_seed, index, played.cell.scenes_of_seed());
  if (hex(scene.hash()) != hash) throw InputError("this version samples another scene than the run played");
  return scene;
}

Environment* PlayedScenes::on(const std::string& engine, const Scenario& scenario) {
  std::string world = scenario.space.id + scenario.environment->world_of(scenario);
  if (find_task(*scenario.environment, scenario.task).most_steps > 1 || scenario.may_stop)
    world += fmt::format(" {}{}", scenario.task, scenario.may_stop ? ", may stop" : "");
  for (const BodyVariant& body : body_variants(scenario))  // all of which one world holds, as it did in the cell
    world += fmt::format(" {},{},{}", body.scale, body.friction, body.mass);
  std::unique_ptr<Environment>& made = environments_[{engine, scenario.environment->id(), std::move(world)}];
  if (made) return made.get();
  try {
    made = make_environment(scenario, load_engine(catalogue_.engine(engine, *scenario.environment)));
  } catch (const PluginError&) {
    return nullptr;
  }
  return made.get();
}

StepResult carry_out(Environment& environment, const Scene& scene, const std::vector<Action>& actions,
                     const std::function<void(const StepResult&)>& after) {
  StepResult result;
  for (std::size_t i = 0; i < actions.size(); ++i) {
    result = environment.step(actions[i]);
    if (after) after(result);
    if ((result.terminated || result.truncated) && i + 1 < actions.size())
      throw InputError(fmt::format("scene {} of {}, step {}: the episode is over here ({}), recorded with {} steps",
                                   scene.index, scene.arm, i + 1, result.failure, actions.size()));
  }
  return result;
}

std::function<bool(int column, int row)> target_pixels(const Scene& scene, const Observation& seen) {
  std::set<std::uint8_t> ids;
  for (const SceneObject& object : scene.objects)
    if (object.role == role::target) ids.insert(object.instance_id);
  const int step = page_step(seen.size), columns = seen.size.columns / step, rows = seen.size.rows / step;
  return [=, &seen](int column, int row) {
    if (column < 0 || row < 0 || column >= columns || row >= rows) return false;
    return ids.count(seen.ids[static_cast<std::size_t>(step * row * seen.size.columns + step * column)]) != 0;
  };
}

void answer_requests(const std::string& verb, const std::function<Json(const JsonReader&)>& answer) {
  const std::string text((std::istreambuf_iterator<char>(std::cin)), {});
  const Json requests = parse_json(text, verb);
  for (const JsonReader& request : JsonReader(requests, verb).elements()) {
    Json line;
    try {
      line = answer(request);
    } catch (const Error& e) {
      line = {{"problem", e.what()}};
    }
    to_stdout("{}\n", canonical(line));
  }
}

}  // namespace lgabench::cli

// lgabench-worker oracle: what the oracle would do in test scenes, as a request on stdin lists them. `lgabench report
// --judge pose` starts it.
#include <lgabench/core/error.hpp>
#include <lgabench/job/job.hpp>
#include <lgabench/worker/played_scenes.hpp>
#include <lgabench/worker/verbs.hpp>

namespace lgabench::worker {
namespace {

// One for each target: any of them is right.
OracleActions actions_in(PlayedScenes& scenes, const OracleRequest& request) {
  const PlayedScenes::Played& played = scenes.cell(request.cell.string());
  const Scene scene = PlayedScenes::scene(played, request.arm, request.index, request.scene);
  Environment* const environment = scenes.on(played.cell.engine, played.scenario);
  if (!environment) throw InputError("the run's engine is not installed: " + played.cell.engine);
  environment->reset(scene);
  OracleActions all;
  for (const SceneObject& object : scene.objects)
    if (object.role == role::target) all.actions.push_back(environment->expert_action_for(object.instance_id));
  return all;
}

}  // namespace

void oracle() {
  PlayedScenes scenes;
  answer_requests("oracle",
                  [&](const JsonReader& request) { return to_json(actions_in(scenes, read_oracle_request(request))); });
}

}  // namespace lgabench::worker

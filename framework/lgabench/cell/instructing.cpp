#include <lgabench/cell/instructing.hpp>

#include <fmt/format.h>

#include <optional>
#include <utility>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/abstraction/selection_errors.hpp>
#include <lgabench/cell/perturbed.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/plugin/guarded.hpp>

namespace lgabench {
namespace {

// Hash of what the policy's last act() read; "" where it does not tell.
std::string read_by(const Policy& policy, const std::string& id) {
  try {
    const Shown shown = guarded(id, [&policy] { return policy.shown(); });
    if (shown.empty()) return "";
    std::string all;
    for (const ShownPicture& one : shown.pictures)
      all += fmt::format("{} {} {}\n", one.name, one.note, sha256(std::string(one.rgb.begin(), one.rgb.end())));
    for (const auto& text : shown.texts) all += canonical(Json(text)) + '\n';
    return hex(hash64(all));
  } catch (const MethodError&) {
    return "";
  }
}

}  // namespace

Instruction instruction_in(const Scene& scene, const Scenario& scenario, const Cell& cell,
                           const std::vector<Instruction>& instructions) {
  const int command = command_given(scene, scenario, cell.scenes_of_seed());
  Instruction told = instructions.at(static_cast<std::size_t>(command));
  const Arm& arm = scenario.arm(scene.arm);
  if (!arm.perturbation) return told;
  for (const PerturbationAxis* axis : axes_of(scenario, *arm.perturbation)) {
    if (!axis->selection_errors) continue;
    const double p = axis->selection_errors(arm.perturbation->level);
    told.selection = with_errors(std::move(told.selection), scenario, command, SelectionErrors{p, p},
                                 perturbation_stream(axis->id, scene, cell.scenes_of_seed()),
                                 find_environment(scenario.environment).goal_type());
  }
  return told;
}

Actor recording_actor(const Actor& actor, const Perception& reading, const Scenario& scenario, const Cell& cell,
                      const std::vector<Instruction>& instructions, const Policy* policy,
                      std::vector<PerturbedEpisode>& episodes) {
  return [&, actor, reading, policy](const Environment& environment, const Scene& scene, const Observation& seen) {
    const auto& perturbation = scenario.arm(scene.arm).perturbation;
    const Scene control =
        find_environment(scenario.environment)
            .sample(scenario, {cell.layout, "test", scene.arm, cell.scene_seed, {}, cell.scenes_of_seed()},
                    scene.index);
    const SceneObject* const target = scene.find(role::target);
    PerturbedEpisode episode{scene.arm,
                             scene.index,
                             perturbation ? perturbation->axis : "",
                             perturbation ? perturbation->level : 0,
                             {},
                             "",
                             target ? target->scale : 1};
    const Instruction told = instruction_in(scene, scenario, cell, instructions);
    const int command = command_given(scene, scenario, cell.scenes_of_seed());
    const std::optional<Observation> read = reading ? std::optional(reading(seen, scene)) : std::nullopt;
    episode.hashes = parts_of({scene, environment.bodies(), control}, seen,
                              policy ? &instructions.at(static_cast<std::size_t>(command)) : nullptr,
                              policy ? &told : nullptr, read ? &*read : nullptr);
    if (read) episode.names = names_hash(*read);
    episodes.push_back(episode);
    const Move move = actor(environment, scene, read ? *read : seen);
    if (policy) episodes.back().read = read_by(*policy, cell.method.id);
    return move;
  };
}

std::string perturbed_text(const std::vector<PerturbedEpisode>& episodes) {
  std::string lines;
  for (const PerturbedEpisode& one : episodes) lines += canonical(to_json(one)) + '\n';
  return lines;
}

void note_takings(const Scenario& scenario, const Cell& cell, const std::vector<TestScene>& tests,
                  std::vector<Episode>& episodes) {
  const PerturbationAxis* const axis = instructing_axis(scenario);
  for (std::size_t i = 0; axis && i < episodes.size(); ++i) {
    const Scene& scene = tests.at(i).scene;
    const int other = axis->other(scene, scenario, perturbation_stream(axis->id, scene, cell.scenes_of_seed()));
    episodes[i].told = command_given(scene, scenario, cell.scenes_of_seed());
    episodes[i].took = "none";
    for (const SceneObject& object : scene.objects)
      if (object.instance_id == episodes[i].taken)
        episodes[i].took = object.role == role::target                                         ? "own"
                           : means(scenario.commands[static_cast<std::size_t>(other)], object) ? "other"
                                                                                               : "third";
  }
}

}  // namespace lgabench

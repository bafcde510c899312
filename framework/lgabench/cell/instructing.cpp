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
  for (const PerturbationAxis* axis : arm.axes) {
    if (!axis->selection_errors) continue;
    const double p = axis->selection_errors(arm.perturbation->level);
    told.selection =
        with_errors(std::move(told.selection), scenario, command, SelectionErrors{p, p},
                    perturbation_stream(axis->id, scene, cell.scenes_of_seed()), scenario.environment->goal_type());
  }
  return told;
}

void PerturbedLines::given(const Environment& environment, const Given& given) {
  is_first_ = given.step == 0;
  if (!is_first_) return;
  const Scene& scene = given.scene;
  const std::optional<std::uint64_t> seed = cell_.scenes_of_seed();
  const auto& perturbation = scenario_.arm(scene.arm).perturbation;
  const Scene control = scenario_.environment->sample(
      scenario_, {cell_.layout, "test", scene.arm, cell_.scene_seed, {}, seed}, scene.index);
  const SceneObject* const target = scene.find(role::target);
  const int command = command_given(scene, scenario_, seed);
  const Observation* const read = given.read ? &*given.read : nullptr;
  PerturbedEpisode episode{scene.arm,
                           scene.index,
                           perturbation ? perturbation->axis : "",
                           perturbation ? perturbation->level : 0,
                           {},
                           "",
                           target ? target->scale : 1};
  episode.hashes = parts_of({scene, environment.bodies(), control}, given.seen,
                            given.told ? &selected_.at(static_cast<std::size_t>(command)) : nullptr,
                            given.told ? &*given.told : nullptr, read);
  if (read) episode.names = names_hash(*read);
  episodes_.push_back(std::move(episode));
}

void PerturbedLines::acted() {
  if (policy_ && is_first_) episodes_.back().read = read_by(*policy_, cell_.method.id);
}

std::string PerturbedLines::text() const {
  std::string lines;
  for (const PerturbedEpisode& one : episodes_) lines += canonical(to_json(one)) + '\n';
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

#include <lgabench/abstraction/scenes.hpp>

#include <fmt/format.h>

#include <utility>

#include <lgabench/abstraction/textualization.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/random.hpp>

namespace lgabench {
namespace {

// Refuses what needs a scene while there is none: environments take a reset for granted. What an environment does
// against its own interface is its fault.
class InOrder final : public Environment {
 public:
  InOrder(std::unique_ptr<Environment> environment, std::string id)
      : environment_(std::move(environment)), id_(std::move(id)) {}

  const ActionSpace& action_space() const override { return environment_->action_space(); }
  Observation reset(const Scene& scene) override {
    has_scene_ = false;
    Observation seen = environment_->reset(scene);
    has_scene_ = true;
    arm_ = scene.arm;
    index_ = scene.index;
    return seen;
  }
  Observation look(const View& view) override { return after_reset("look()").look(view); }
  void show_shadows(bool on) override { environment_->show_shadows(on); }
  StepResult step(const Action& action) override {
    StepResult result = after_reset("step()").step(action);
    if (!result.terminated && !result.truncated) fail("the episode goes on after its action, and lgabench plays one");
    return result;
  }
  Rejudged judged_again(const JudgeLimits& limits) const override {
    return after_reset("judged_again()").judged_again(limits);
  }
  std::vector<EngineBody> bodies() const override { return after_reset("bodies()").bodies(); }
  Observation observe() override { return after_reset("observe()").observe(); }
  Action expert_action() const override { return after_reset("expert_action()").expert_action(); }
  Action expert_action_for(std::uint8_t instance_id) const override {
    return after_reset("expert_action_for()").expert_action_for(instance_id);
  }

 private:
  Environment& after_reset(const char* call) const {
    if (!has_scene_) throw Error(fmt::format("{}: expected a reset() before it", call));
    return *environment_;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw EngineError(fmt::format("environment {}: scene {} of {}: {}", id_, index_, arm_, what));
  }

  std::unique_ptr<Environment> environment_;
  std::string id_, arm_;  // the environment's; the scene's
  int index_ = 0;
  bool has_scene_ = false;
};

}  // namespace

std::unique_ptr<Environment> make_environment(const Scenario& scenario, std::unique_ptr<PhysicsWorld> world) {
  const EnvironmentType& type = *scenario.environment;
  return std::make_unique<InOrder>(type.make(std::move(world), scenario), type.id());
}

Scene training_scene(const Scenario& scenario, const std::string& layout, const std::vector<Selection>& selections,
                     std::uint64_t training_seed, int index) {
  return scenario.environment->sample(scenario, {layout, "train", "train", training_seed, selections}, index);
}

Scene sampled_scene(const Scenario& scenario, const SceneRequest& request, int index) {
  Scene scene = scenario.environment->sample(scenario, request, index);
  return request.arm == "train" ? scene : perturbed(std::move(scene), scenario, request.training_seed);
}

Scene test_scene(const Scenario& scenario, const std::string& layout, const std::string& arm, std::uint64_t scene_seed,
                 int index, std::optional<std::uint64_t> training_seed) {
  return sampled_scene(scenario, {layout, "test", arm, scene_seed, {}, training_seed}, index);
}

Perception perception_of(const Scenario& scenario, const Arm& arm, std::optional<std::uint64_t> training_seed) {
  const TextualizationNoise noise{arm.label_noise, arm.missed_segment};
  const Perceive perceive = scenario.environment->perception(*arm.scenes);
  std::vector<const PerturbationAxis*> axes;
  for (const PerturbationAxis* axis : arm.axes)
    if (axis->perceive) axes.push_back(axis);
  if (!perceive && noise.label_noise == 0 && noise.missed_segment == 0 && axes.empty()) return nullptr;
  const std::string own = own_stream(training_seed);
  const int level = arm.perturbation ? arm.perturbation->level : 0;
  return [&scenario, noise, perceive, own, axes, level, training_seed](const Observation& seen, const Scene& scene) {
    const auto stream = [&](const char* of) {
      return RandomStream(
          fmt::format("{}/{}/{}/{}{}/{}", of, scene.scenario, scene.layout, scene.seed, own, scene.index));
    };
    Observation perceived = imperfect_textualization(perceive ? perceive(seen, stream("perception")) : seen,
                                                     scenario.space, noise, stream("textualization"));
    for (const PerturbationAxis* axis : axes)
      perceived =
          axis->perceive(std::move(perceived), scenario, level, perturbation_stream(axis->id, scene, training_seed));
    return perceived;
  };
}

View view_of(const Scenario& scenario, const Scene& scene, std::optional<std::uint64_t> training_seed) {
  View view;
  if (scene.arm == "train") return view;
  const Arm& arm = scenario.arm(scene.arm);
  for (const PerturbationAxis* axis : arm.axes)
    if (axis->look)
      axis->look(view, scene, arm.perturbation->level, perturbation_stream(axis->id, scene, training_seed));
  return view;
}

TestScene in_its_arm(const Scenario& scenario, Scene scene, std::optional<std::uint64_t> training_seed) {
  TestScene test{std::move(scene)};
  test.perception = perception_of(scenario, scenario.arm(test.scene.arm), training_seed);
  test.view = view_of(scenario, test.scene, training_seed);
  return test;
}

}  // namespace lgabench

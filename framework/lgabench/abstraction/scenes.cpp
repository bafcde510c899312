#include <lgabench/abstraction/scenes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include <lgabench/abstraction/textualization.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/meaning.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/random.hpp>

namespace lgabench {
namespace {

// Plays by the interface: refuses what needs a scene while there is none, or an episode that goes on when it is over,
// and calls what an environment does against its interface its fault.
class InOrder final : public Environment {
 public:
  InOrder(std::unique_ptr<Environment> environment, const Scenario& scenario)
      : environment_(std::move(environment)),
        id_(scenario.environment->id()),
        most_steps_(find_task(*scenario.environment, scenario.task).most_steps),
        may_stop_(scenario.may_stop),
        state_(state_of(scenario)),
        space_(scenario.space),
        size_(scenario.environment->picture_size()),
        most_instances_(most_instances_of(scenario)),
        of_plugin_(!contains(environment_ids(), id_)),
        failures_(scenario.environment->failures()) {
    for (const std::string& of_task : find_task(*scenario.environment, scenario.task).failures)
      failures_.push_back(of_task);
  }

  const ActionSpace& action_space() const override { return environment_->action_space(); }
  int most_steps() const override { return most_steps_; }
  Observation reset(const Scene& scene) override {
    has_scene_ = over_ = false;
    steps_ = 0;
    arm_ = scene.arm;
    index_ = scene.index;
    Observation seen = environment_->reset(scene);
    has_scene_ = true;
    return checked(std::move(seen));
  }
  Observation look(const View& view) override { return checked(after_reset("look()").look(view)); }
  void show_shadows(bool on) override { environment_->show_shadows(on); }
  StepResult step(const Action& action) override {
    Environment& environment = after_reset("step()");
    if (most_steps_ == 1) return judged(environment.step(action));
    if (over_)
      throw Error(fmt::format("step(): scene {} of {} is over after {} steps; expected a reset() before it", index_,
                              arm_, steps_));
    // A file has it so, and it must lead to the same when it is played again.
    StepResult result = environment.step(action.empty() && may_stop_ ? action : stored(action));
    ++steps_;
    result = judged(std::move(result));
    if (steps_ == most_steps_ && !result.terminated) result.truncated = true;
    over_ = result.terminated || result.truncated;
    if (action.empty() && !over_) fail("the episode goes on after its actor said that nothing is left to do");
    return result;
  }
  Rejudged judged_again(const JudgeLimits& limits) const override {
    return after_reset("judged_again()").judged_again(limits);
  }
  std::vector<EngineBody> bodies() const override { return after_reset("bodies()").bodies(); }
  Observation observe() override { return checked(after_reset("observe()").observe()); }
  Action expert_action() const override {
    Action action = after_reset("expert_action()").expert_action();
    if (action.empty() && !may_stop_)
      fail("the oracle says that nothing is left to do, and the scenario has no may_stop");
    return action;
  }
  Action expert_action_for(std::uint8_t instance_id) const override {
    return after_reset("expert_action_for()").expert_action_for(instance_id);
  }

 private:
  Environment& after_reset(const char* call) const {
    if (!has_scene_) throw Error(fmt::format("{}: expected a reset() before it", call));
    return *environment_;
  }

  Action stored(const Action& action) const {
    if (action.empty())
      throw MethodError(
          fmt::format("action: expected {} numbers, got none, which says that nothing is left to do where a "
                      "scenario has may_stop",
                      action_space().size()));
    executable(action_space(), action);  // refuses what has no place in a file
    return as_stored(action_space(), action);
  }

  StepResult judged(StepResult result) const {
    const bool over = result.terminated || result.truncated;
    if (!over && most_steps_ == 1) fail("the episode goes on after its action, and lgabench plays one");
    if (result.is_success != (result.failure == failure::none))
      fail(fmt::format("the failure is \"{}\" {} a success", result.failure, result.is_success ? "of" : "without"));
    if (result.is_success && (!result.terminated || result.truncated)) fail("a success in an episode that did not end");
    if (most_steps_ > 1 && over == (result.failure == failure::goes_on))
      fail(fmt::format("the failure of an episode that {} is \"{}\"", over ? "is over" : "goes on", result.failure));
    if (of_plugin_ && over && !result.is_success && !contains(failures_, result.failure))
      fail(fmt::format("the failure is \"{}\", expected one that the environment names: {}", result.failure,
                       fmt::join(failures_, ", ")));
    result.observation = checked(std::move(result.observation));
    return result;
  }

  // lgabench's own environments are held to this by tests.
  void check_picture(const Observation& seen) const {
    if (seen.size.rows != size_.rows || seen.size.columns != size_.columns || seen.rgb.size() != 3 * size_.pixels() ||
        seen.ids.size() != size_.pixels())
      fail(fmt::format("observation: expected {} x {} pixels of rgb and ids, got {} x {} with {} and {} bytes",
                       size_.rows, size_.columns, seen.size.rows, seen.size.columns, seen.rgb.size(), seen.ids.size()));
    if (static_cast<int>(seen.instances.size()) > most_instances_)
      fail(fmt::format("observation: expected at most {} instances, got {}", most_instances_, seen.instances.size()));
    std::array<int, 256> pixels{};
    for (const std::uint8_t id : seen.ids) ++pixels[id];
    for (const Instance& one : seen.instances) {
      if (one.id == 0 || pixels[one.id] != one.pixels)
        fail(fmt::format("observation: instance {} says {} pixels, the ids hold {}", one.id, one.pixels,
                         pixels[one.id]));
      pixels[one.id] = 0;
      if (!is_place(one.object_type) &&
          (!contains(space_.object_types, one.object_type) || !contains(space_.textures, one.texture)))
        fail(fmt::format("observation: instance {}: {} {} is no name of the space", one.id, one.texture,
                         one.object_type));
    }
    const auto* const stray = std::find_if(pixels.begin() + 1, pixels.end(), [](int count) { return count != 0; });
    if (stray != pixels.end())
      fail(fmt::format("observation: the ids hold {}, which is no instance's", stray - pixels.begin()));
  }

  Observation checked(Observation seen) const {
    if (of_plugin_) check_picture(seen);
    if (seen.state.size() != state_.size())
      fail(fmt::format("state: expected {} numbers, got {}", state_.size(), seen.state.size()));
    for (std::size_t i = 0; i < state_.size(); ++i)
      if (!(seen.state[i] >= state_[i].low && seen.state[i] <= state_[i].high))
        fail(fmt::format("state: {}: expected {:g} to {:g}, got {:g}", state_[i].name, state_[i].low, state_[i].high,
                         seen.state[i]));
    return seen;
  }

  [[noreturn]] void fail(const std::string& what) const {
    const std::string at = most_steps_ == 1 ? "" : fmt::format(", step {}", steps_);
    throw EngineError(fmt::format("environment {}: scene {} of {}{}: {}", id_, index_, arm_, at, what));
  }

  std::unique_ptr<Environment> environment_;
  const std::string id_;
  const int most_steps_;
  const bool may_stop_;
  const std::vector<StateNumber>& state_;
  const FeatureSpace space_;
  const PictureSize size_;
  const int most_instances_;
  const bool of_plugin_;
  std::vector<std::string> failures_;
  std::string arm_;
  int index_ = 0, steps_ = 0;  // of the scene; since reset()
  bool has_scene_ = false, over_ = false;
};

// The place to which all is brought is known in every step: it is read as nothing else, and nothing else as a place.
void places_as_they_are(Observation& perceived, const Observation& seen) {
  for (Instance& one : perceived.instances)
    for (const Instance& true_one : seen.instances)
      if (one.id == true_one.id && is_place(one.object_type) != is_place(true_one.object_type))
        one.object_type = true_one.object_type;
}

}  // namespace

std::unique_ptr<Environment> make_environment(const Scenario& scenario, std::unique_ptr<PhysicsWorld> world) {
  return std::make_unique<InOrder>(scenario.environment->make(std::move(world), scenario), scenario);
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
  const std::string of_seed = own_stream(training_seed);
  const int level = arm.perturbation ? arm.perturbation->level : 0;
  return [&scenario, noise, perceive, of_seed, axes, level, training_seed](const Observation& seen, const Scene& scene,
                                                                           int step) {
    const auto stream = [&](const char* of) {
      return RandomStream(fmt::format("{}/{}/{}/{}{}/{}{}", of, scene.scenario, scene.layout, scene.seed, of_seed,
                                      scene.drawn_as(), later_stream(step)));
    };
    Observation perceived = imperfect_textualization(perceive ? perceive(seen, stream("perception")) : seen,
                                                     scenario.space, noise, stream("textualization"));
    if (scene.errand) places_as_they_are(perceived, seen);
    for (const PerturbationAxis* axis : axes)
      perceived = axis->perceive(std::move(perceived), scenario, level,
                                 perturbation_stream(axis->id, scene, training_seed, step));
    perceived.state = seen.state;  // no error is in it
    perceived.brought = seen.brought;
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

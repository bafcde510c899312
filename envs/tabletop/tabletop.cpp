#include <tabletop/tabletop.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <map>

#include <lgabench/core/error.hpp>
#include <tabletop/objects.hpp>
#include <tabletop/oracle.hpp>
#include <tabletop/predicates.hpp>
#include <tabletop/primitives.hpp>
#include <tabletop/renderer.hpp>

namespace lgabench::tabletop {
namespace {

class Tabletop final : public Environment {
 public:
  Tabletop(std::unique_ptr<PhysicsWorld> world, const FeatureSpace& space) : world_(std::move(world)) {
    std::vector<BodyModel> models;
    const auto add = [&](const std::string& type, bool fixed) {
      models_[{type, fixed}] = static_cast<int>(models.size());
      models.push_back(object_model(type).body);
      models.back().fixed = fixed;
    };
    for (const std::string& type : space.object_types) add(type, false);
    add(goal_type, true);
    world_->load(models, most_bodies);
  }

  Observation reset(const Scene& scene) override {
    std::vector<VisibleObject> objects = visible_objects(scene);
    std::vector<BodyPlacement> placements;
    std::vector<bool> fixed;
    for (std::size_t i = 0; i < objects.size(); ++i) {
      fixed.push_back(scene.objects[i].role == Role::goal);
      const auto model = models_.find({objects[i].object_type, fixed[i]});
      if (model == models_.end())
        throw InputError(fmt::format("scene {} {}: object type \"{}\" with role {} is not in the environment's space",
                                     scene.scenario, scene.index, objects[i].object_type,
                                     to_string(scene.objects[i].role)));
      placements.push_back({model->second, objects[i].pose});
    }
    world_->reset(placements);
    scene_ = scene;
    objects_ = std::move(objects);
    fixed_ = std::move(fixed);
    touched_obstacle_ = false;
    return renderer_.render(objects_, ground_of(scene_));
  }

  StepResult step(const Action& action) override {
    const Motion motion = carry_out(executable(action));
    const std::vector<Pose> reached = poses();
    for (std::size_t i = 0; i < reached.size(); ++i) objects_[i].pose = reached[i];
    StepResult result;
    result.observation = renderer_.render(objects_, ground_of(scene_));
    result.terminated = true;
    result.truncated = !motion.came_to_rest;
    result.failure = judge(scene_, reached, motion);
    result.is_success = result.failure == Failure::none;
    return result;
  }

  Action expert_action() const override {
    const SceneObject* target = scene_.find(Role::target);
    if (!target) throw InputError("scene: expected a target");
    return expert_action_for(target->instance_id);
  }

  Action expert_action_for(std::uint8_t instance_id) const override {
    const auto& objects = scene_.objects;
    const auto found = std::find_if(objects.begin(), objects.end(),
                                    [instance_id](const SceneObject& o) { return o.instance_id == instance_id; });
    if (found == objects.end()) throw InputError(fmt::format("scene: expected an object with id {}", instance_id));
    return tabletop::expert_action(scene_, poses(), *world_, static_cast<std::size_t>(found - objects.begin()));
  }

 private:
  Motion carry_out(const Action& action) {
    switch (scene_.task) {
      case Task::pick_and_place:
      case Task::rotate:
        return pick_and_place({*world_, fixed_}, action);
      case Task::sweep:
        return sweep(action);
    }
    throw Error("a Task outside its enumeration");
  }

  Motion sweep(const Action& action) {
    Motion motion = tabletop::sweep({*world_, fixed_}, action, [this](const std::vector<Polygon>& spatula) {
      touched_obstacle_ = touched_obstacle_ || touches_obstacle(scene_, poses(), world_->contacts(), spatula);
    });
    motion.touched_obstacle = touched_obstacle_;
    return motion;
  }

  std::vector<Pose> poses() const {
    std::vector<Pose> all;
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) all.push_back(world_->pose(static_cast<int>(i)));
    return all;
  }

  std::unique_ptr<PhysicsWorld> world_;
  Renderer renderer_;
  std::map<std::pair<std::string, bool>, int> models_;  // by type and whether it is fixed
  Scene scene_;
  std::vector<VisibleObject> objects_;  // in the scene's order, at their poses now
  std::vector<bool> fixed_;
  bool touched_obstacle_ = false;  // since the scene's beginning
};

}  // namespace

std::unique_ptr<Environment> make_environment(std::unique_ptr<PhysicsWorld> world, const FeatureSpace& space) {
  return std::make_unique<Tabletop>(std::move(world), space);
}

}  // namespace lgabench::tabletop

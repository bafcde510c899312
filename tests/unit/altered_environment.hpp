// An environment that is like another one but for what its steps lead to: how environments break their interface.
#pragma once
#include <functional>
#include <memory>
#include <utility>

#include <lgabench/core/environments.hpp>

namespace lgabench {

class AlteredEnvironment final : public Environment {
 public:
  using Alter = std::function<void(StepResult&)>;
  AlteredEnvironment(std::unique_ptr<Environment> like, Alter alter)
      : like_(std::move(like)), alter_(std::move(alter)) {}

  const ActionSpace& action_space() const override { return like_->action_space(); }
  Observation reset(const Scene& scene) override { return like_->reset(scene); }
  StepResult step(const Action& action) override {
    StepResult result = like_->step(action);
    alter_(result);
    return result;
  }
  Observation observe() override { return like_->observe(); }
  Action expert_action() const override { return like_->expert_action(); }
  Action expert_action_for(std::uint8_t id) const override { return like_->expert_action_for(id); }

 private:
  std::unique_ptr<Environment> like_;
  Alter alter_;
};

class AlteredType final : public EnvironmentType {
 public:
  AlteredType(const EnvironmentType& like, AlteredEnvironment::Alter alter) : like_(like), alter_(std::move(alter)) {}

  const std::string& id() const override { return like_.id(); }
  const std::vector<TaskInfo>& tasks() const override { return like_.tasks(); }
  const std::vector<std::string>& spaces() const override { return like_.spaces(); }
  const std::vector<std::string>& failures() const override { return like_.failures(); }
  const ActionSpace& action_space() const override { return like_.action_space(); }
  const std::vector<StateNumber>& state_of(const TaskInfo& task) const override { return like_.state_of(task); }
  PictureSize picture_size() const override { return like_.picture_size(); }
  int most_instances(const TaskInfo& task) const override { return like_.most_instances(task); }
  Vec2 in_picture(Vec3 point_m) const override { return like_.in_picture(point_m); }
  std::vector<std::string> scenario_members(const TaskInfo& task) const override {
    return like_.scenario_members(task);
  }
  std::vector<std::string> scene_members(const TaskInfo& task) const override { return like_.scene_members(task); }
  std::shared_ptr<const SceneContent> read_content(const Scenario& scenario, const JsonReader& file,
                                                   const JsonReader* scenes, bool training) const override {
    return like_.read_content(scenario, file, scenes, training);
  }
  Scene sample(const Scenario& scenario, const SceneRequest& request, int index) const override {
    return like_.sample(scenario, request, index);
  }
  Observation draw(const Scene& scene, const View& view) const override { return like_.draw(scene, view); }
  std::unique_ptr<Environment> make(std::unique_ptr<PhysicsWorld> engine, const Scenario& scenario) const override {
    return std::make_unique<AlteredEnvironment>(like_.make(std::move(engine), scenario), alter_);
  }

 private:
  const EnvironmentType& like_;
  AlteredEnvironment::Alter alter_;
};

}  // namespace lgabench

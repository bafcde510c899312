// An environment of which most is data. Derive from SimpleEnvironment and from Environment, and name the first in
// LGABENCH_ENVIRONMENT (plugin/environment.hpp).
#pragma once
#include <memory>
#include <string>
#include <vector>

#include <lgabench/core/random.hpp>
#include <lgabench/plugin/environment.hpp>

namespace lgabench {

/// What a SimpleEnvironment is.
struct EnvironmentDescription {
  std::string id;
  std::vector<TaskInfo> tasks;
  std::vector<std::string> failures;  // every word that step() may give
  std::vector<std::string> spaces;    // feature spaces that name its objects, the usual one first
  ActionSpace actions;
  std::vector<StateNumber> state = {};  // of Observation::state; none: it has no state
  PictureSize picture;
  std::vector<Named> things;  // that its scenes can show, each at most once in a scene
  int most_things = 1;        // of a scene: its target, and others that are not meant
};

/// An environment of commands that mean one of several things. Its scenes hold one target, drawn from what the command
/// means, and others, drawn from what it does not; ids are permuted. The members "distractors" of an arm or of
/// training, [fewest, most], says how many others (by default as many as most_things allows), "near_miss": true that
/// those come first that share the target's object type or texture.
class SimpleEnvironment : public EnvironmentType {
 public:
  const std::string& id() const override { return about_.id; }
  const std::vector<TaskInfo>& tasks() const override { return about_.tasks; }
  const std::vector<std::string>& spaces() const override { return about_.spaces; }
  const std::vector<std::string>& failures() const override { return about_.failures; }
  const ActionSpace& action_space() const override { return about_.actions; }
  const std::vector<StateNumber>& state_of(const TaskInfo& /*task*/) const override { return about_.state; }
  PictureSize picture_size() const override { return about_.picture; }
  int most_instances(const TaskInfo& /*task*/) const override { return about_.most_things; }
  /// By the bounds of the numbers that are an action's first place. The picture's middle where actions have no place.
  Vec2 in_picture(Vec3 point_m) const override;
  std::vector<std::string> scenario_members(const TaskInfo& /*task*/) const override { return {}; }
  std::vector<std::string> scene_members(const TaskInfo& /*task*/) const override {
    return {"distractors", "near_miss"};
  }
  /// @throws InputError for a command that says which of several objects is meant, and for members of another form.
  std::shared_ptr<const SceneContent> read_content(const Scenario& scenario, const JsonReader& file,
                                                   const JsonReader* scenes, bool training) const override;
  Scene sample(const Scenario& scenario, const SceneRequest& request, int index) const override;
  /// As reset() shows it.
  Observation draw(const Scene& scene, const View& view) const override;
  bool has_engine() const override { return false; }
  std::unique_ptr<Environment> make(std::unique_ptr<PhysicsWorld> engine, const Scenario& scenario) const override;

 protected:
  explicit SimpleEnvironment(EnvironmentDescription about) : about_(std::move(about)) {}

  /// @throws InputError for a command that says which of several objects is meant.
  void expect_sets(const Scenario& scenario, const JsonReader& file) const;

  /// What a scene may have as its target, and what its command does not mean.
  struct Things {
    std::vector<Named> meant, others;
  };
  /// @throws InputError for a layout that there is not; NothingToShow where nothing is meant.
  Things things_for(const Scenario& scenario, const SceneRequest& request, int index) const;

  /// Gives the scene's objects their places (SceneObject::position_m, yaw_rad) and Scene::parameters their values. The
  /// same arguments give the same bits. Any thread.
  virtual void place(Scene& scene, RandomStream random) const = 0;
  /// An environment for scenes of that task, which has no engine.
  virtual std::unique_ptr<Environment> make(const std::string& task) const = 0;

 private:
  EnvironmentDescription about_;
};

}  // namespace lgabench

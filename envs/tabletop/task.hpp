// A task: what is placed, what an action does, what the expert would do, and what counts as success. One file of
// tasks/ each.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/environment.hpp>
#include <lgabench/core/environments.hpp>
#include <tabletop/content.hpp>
#include <tabletop/motions.hpp>
#include <tabletop/placement.hpp>
#include <tabletop/renderer.hpp>

namespace lgabench::tabletop {

/// A task's second set of objects: its name in Selections, and the one that its objects have in scenes.
struct SecondObjects : SecondRole {
  Role in_scenes;  // SceneObject::role
};

/// An object where a motion left it.
struct Final {
  const SceneObject& object;
  Pose pose;
  Vec2 centre_m;  // see centre_of()
  double yaw_rad;
};

/// How far from the goal's centre an object lies at most that counts as brought there.
constexpr double placed_within_m = 0.1;

/// One object, constant, for as long as the program runs. Whatever is not overridden is as in pick-and-place.
class Task {
 public:
  virtual ~Task() = default;

  virtual std::string id() const = 0;
  virtual std::vector<Layout> layouts() const = 0;
  virtual std::optional<SecondObjects> second() const { return std::nullopt; }
  /// Failure words of judge() and carry_out(), beside those that every task has (failures.hpp).
  virtual std::vector<std::string> failures() const = 0;
  /// A shipped scenario: TaskInfo::example, what checks play.
  virtual std::string example() const = 0;

  /// Members of the task's own in a scenario's file, and in its "train" and "tests"; read() puts what they say into
  /// `content.numbers`. Arguments as of EnvironmentType::read_content().
  virtual std::vector<std::string> scenario_members() const { return {}; }
  virtual std::vector<std::string> scene_members() const { return {}; }
  virtual void read(const JsonReader& /*file*/, const JsonReader* /*scenes*/, Content& /*content*/) const {}
  /// The turn that it asks for, in radians; 0 where it asks for none.
  virtual double turn_rad(const Content&) const { return 0; }

  /// Sets position and yaw of every object but the goal. objects[0] is a target and takes its place first, from a
  /// stream of its own, so that scenes with other distractors share it. A distractor that finds no place is left out
  /// (fixed places). @throws NoRoom where free places run out.
  virtual void place(const Layout& layout, const Content& content, std::vector<SceneObject>& objects,
                     const Streams& stream) const;
  /// What must stay free beside the target itself for its motion: seen from above.
  virtual std::vector<Polygon> room(const Layout& layout, const SceneObject& target) const;
  virtual int most_steps() const { return 1; }  // TaskInfo::most_steps
  /// Whether scenes have an errand (errand.hpp), so that "nothing is left to do" may be right.
  virtual bool has_errand() const { return false; }
  /// How many distractors its scenes may have.
  virtual int most_distractors() const { return 2; }  // more do not fit beside the widest target
  /// What is painted on the table.
  virtual Ground ground() const { return Ground::plain; }

  /// Whether success depends on the turn from an action's first pose to its second.
  virtual bool judges_turn() const { return false; }
  /// Carries out what the action means in this task. @pre `action` is executable().
  virtual Motion carry_out(const Scene& scene, const Bodies& bodies, const TwoPoses& action) const;
  /// What does the task in the present state, with objects[object] as the target. `poses` in the order of
  /// scene.objects; the world is only looked at. @throws InputError where the scene lacks an object that this needs.
  virtual TwoPoses expert_action(const Scene& scene, const std::vector<Pose>& poses, const PhysicsWorld& world,
                                 std::size_t object) const = 0;
  /// Did that target end as the task asks? All bodies rest, within the workspace. Pure. `finals` in the order of
  /// scene.objects. @returns failure::none or one of failures(). @throws InputError where the scene lacks an object.
  virtual Failure judge(const Scene& scene, const Final& target, const std::vector<Final>& finals,
                        const JudgeLimits& limits) const = 0;
  /// How far that target's centre is from where the task asks for it, in metres. Pure. @throws InputError likewise.
  virtual double off_m(const Scene& scene, const Final& target, const std::vector<Final>& finals) const = 0;
  /// How far judge() is from success with that target: the same parts in every scene, all 0 where it succeeds.
  virtual std::vector<Gap> gaps(const Scene& /*scene*/, const Final& /*target*/, const std::vector<Final>& /*finals*/,
                                const Motion& /*motion*/) const {
    return {};
  }
  /// How far from an object, which has that outline, the action takes hold.
  virtual double reach_m(const TwoPoses& action, const std::vector<Polygon>& outline) const {
    return distance(action.pose0.position_m, outline);
  }
};

/// All tasks, in the order in which tables and checks name them.
const std::vector<const Task*>& tasks();
/// @throws InputError that lists the known ones.
const Task& find_task(const std::string& id);
/// The scene before any action, drawn by a renderer of the calling thread's own.
Observation drawn(const Scene& scene, const View& view = {});
/// The task's layout of that name. @throws InputError that lists its layouts.
Layout find_layout(const Task& task, const std::string& id);

/// The turn that the scene's task asks for, which is part of the scene; 0 where it asks for none.
double asked_turn_rad(const Scene& scene);
void set_asked_turn(Scene& scene, double turn_rad);
/// The four fixed places of pick-and-place ("cells").
std::vector<Vec2> four_places();
/// The five places of the authors' released code: targets in the first two, distractors in the second and third.
Layout released_layout(std::optional<Vec2> pallet = {});
/// The first object of that role. @throws InputError where there is none.
const SceneObject& expect(const Scene& scene, const Role& role);

}  // namespace lgabench::tabletop

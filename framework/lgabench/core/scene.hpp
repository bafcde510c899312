// A scene: all that is sampled for an episode, before physics.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include <lgabench/core/geometry.hpp>
#include <lgabench/core/json.hpp>

namespace lgabench {

enum class Task { pick_and_place, rotate, sweep };
std::string to_string(Task task);

enum class Role { target, distractor, obstacle, goal };
std::string to_string(Role role);

/// One object of a scene.
struct SceneObject {
  std::string object_type, texture;
  Role role = Role::distractor;
  Vec2 position_m;  // of the object type's centre
  double yaw_rad = 0;
  std::uint8_t instance_id = 0;  // 1..255, permuted over the scene
};

/// A value: the same arguments of the sampler give the same scene on every host, for every engine and method.
/// Never given to a method: it holds roles, seed and index.
struct Scene {
  std::string scenario, arm, layout, split;
  Task task = Task::pick_and_place;
  double angle_rad = 0;  // rotate: the turn that counts as success
  std::uint64_t seed = 0;
  int index = 0;
  int command = 0;                   // which of the scenario's commands is given
  std::vector<SceneObject> objects;  // ordered by instance_id

  /// Stable over hosts and versions; covers every field.
  std::uint64_t hash() const;
  /// First object with the role, or nullptr. The Scene owns it. Several objects may be targets (any of them is right)
  /// or obstacles (none may be touched).
  const SceneObject* find(Role role) const;
};

Json to_json(const Scene& scene);

}  // namespace lgabench

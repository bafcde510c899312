// A scene: everything that is sampled for an episode, before physics.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/geometry.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/core/meaning.hpp>

namespace lgabench {

/// What an object is in its scene: one of these, or a word of the environment's (the second set's objects).
using Role = std::string;
namespace role {
inline constexpr const char *target = "target", *distractor = "distractor";
inline constexpr const char* goal = "goal";  // where a target belongs: part of the table, nothing to act on
}  // namespace role

/// One object of a scene.
struct SceneObject {
  std::string object_type, texture;
  Role role = role::distractor;
  Vec2 position_m;  // of the object type's centre
  double yaw_rad = 0;
  std::uint8_t instance_id = 0;  // 1..255, permuted over the scene
  double scale = 1;              // of its type's size
};

/// A value: the same arguments of the sampler give the same scene on every host, for every engine and method.
/// Never given to a method: it holds roles, seed and index.
struct Scene {
  std::string scenario, arm, layout, split;
  std::string task;  // an id of the environment's list
  /// What else the environment needs to know of it, by its own names.
  std::map<std::string, double> parameters;
  std::uint64_t seed = 0;
  int index = 0;
  int command = 0;                   // which of the scenario's commands is given
  std::vector<SceneObject> objects;  // ordered by instance_id
  double friction = 1, mass = 1;     // of what can be moved, times those of its type
  Json own = nullptr;                // what else an environment in Python was told; null: nothing
  /// What the scene is judged by where its command says how objects are used: a judge never sees commands. Written and
  /// hashed only where there is one.
  std::optional<Meaning> errand = {};
  /// Scenes of one pair have the same number here. They differ in command, roles and errand alone, and all random
  /// streams take this number in place of `index`. Written and hashed only where there is one.
  std::optional<int> pair = {};

  /// Stable over hosts and versions; covers every field.
  std::uint64_t hash() const;
  /// The same for both scenes of a pair, whatever scenarios give them; else hash().
  std::uint64_t shared_hash() const;
  /// The number that random streams take.
  int drawn_as() const { return pair.value_or(index); }
  /// First object with the role, or nullptr. The Scene owns it. Several objects may have one role: any of several
  /// targets is right.
  const SceneObject* find(const Role& role) const;
};

Json to_json(const Scene& scene);

/// Which of the scene's objects are meant before anything was brought, by their place in `objects`: those that its
/// errand wants, without one its targets.
std::vector<bool> meant_at_first(const Scene& scene);

}  // namespace lgabench

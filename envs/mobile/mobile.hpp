// The mobile environment over any engine: one plan an episode, from a table to a person's tray or to a bin.
#pragma once
#include <memory>

#include <lgabench/core/environment.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/perturbations.hpp>
#include <mobile/place.hpp>

namespace lgabench::mobile {

/// So many objects stand on the table at most, in `fetch` with three receivers among them. An engine is told four more,
/// the furniture.
constexpr int most_objects = 6, most_fetch_objects = 11;

namespace failure {
using namespace lgabench::failure;
inline constexpr const char *missed_object = "missed_object", *wrong_object = "wrong_object";
inline constexpr const char *blocked_way = "blocked_way", *out_of_reach = "out_of_reach";
inline constexpr const char *dropped_elsewhere = "dropped_elsewhere", *moved_another = "moved_another";
inline constexpr const char* wrong_receiver = "wrong_receiver";
}  // namespace failure

/// The task whose goal stands in its scene: the receiver that the command means.
constexpr const char* fetch = "fetch";

/// Where the things of a scene go, and how the oracle stands there.
struct Task {
  std::string id;
  Vessel goal;
  Vec2 waypoint_m;
  double heading_rad;
  std::vector<Vessel> wrong = {};  // receivers that the command does not mean
};
/// @throws InputError that lists the known ones; for a scene without what its task needs.
Task task_of(const Scene& scene);

/// Takes the engine, loads the furniture and every object type that scenes can show into it once, and plays on it.
/// `fetches`: the receivers too, for scenes of that task alone. Objects as each of the variants.
std::unique_ptr<Environment> make_environment(std::unique_ptr<PhysicsWorld> world, bool fetches = false,
                                              const std::vector<BodyVariant>& variants = {{}});

}  // namespace lgabench::mobile

// What every engine must do, whatever the environment (core/physics_world.hpp), as checks on a world of boxes.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <lgabench/core/physics_world.hpp>

namespace lgabench {

struct ContractCheck {
  std::string name;
  /// What of the contract the world breaks, in a line; "" where it keeps it. The world has gone through load() with
  /// contract_bodies(), and maybe through other checks. @throws whatever the engine throws where it must not.
  std::function<std::string(PhysicsWorld& world)> fault;
  std::string remedy;  // what to look at
};

/// A block of 7 cm, and a fixed slab of 20 x 20 x 2 cm.
std::vector<BodyModel> contract_bodies();
/// Placed at once at most.
constexpr int contract_bodies_at_once = 4;

/// Reset, rest, grip, release, rays, pushes, contacts, errors: each on its own.
const std::vector<ContractCheck>& engine_contract();

}  // namespace lgabench

#include <lgabench/cell/engine_contract.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

constexpr int block = 0, slab = 1;  // models
constexpr double block_m = .07, slab_height_m = .02;

BodyModel box(const char* name, double half_m, double height_m) {
  BodyModel model{name, {{}}};
  for (const double x : {-half_m, half_m})
    for (const double y : {-half_m, half_m})
      for (const double z : {0., height_m}) model.pieces[0].corners_m.push_back({x, y, z});
  return model;
}

BodyPlacement at(int model, double x, double y, double z = 0) { return {model, {{x, y, z}, {}}}; }

double distance(const Pose& a, const Pose& b) {
  const Vec3 way = a.position_m - b.position_m;
  return std::hypot(way.x, way.y, way.z);
}

bool same(const Pose& a, const Pose& b) {
  const Quat &p = a.rotation, &q = b.rotation;
  return a.position_m.x == b.position_m.x && a.position_m.y == b.position_m.y && a.position_m.z == b.position_m.z &&
         p.x == q.x && p.y == q.y && p.z == q.z && p.w == q.w;
}

int steps_of(const PhysicsWorld& world, double seconds) {
  return static_cast<int>(std::lround(seconds / world.time_step_s()));
}
void run(PhysicsWorld& world, double seconds) {
  for (int i = steps_of(world, seconds); i > 0; --i) world.step();
}

// The gripper goes straight, in so many seconds.
void carry(PhysicsWorld& world, Vec3 from, Vec3 to, double seconds) {
  const int steps = steps_of(world, seconds);
  for (int i = 1; i <= steps; ++i) {
    world.move_gripper({from + (static_cast<double>(i) / steps) * (to - from), {}});
    world.step();
  }
}

bool touching(const PhysicsWorld& world, int a, int b) {
  const auto all = world.contacts();
  return std::any_of(all.begin(), all.end(),
                     [&](Contact c) { return (c.a == a && c.b == b) || (c.a == b && c.b == a); });
}

bool throws(const std::function<void()>& call) {
  try {
    call();
  } catch (const EngineError&) {
    return true;
  }
  return false;
}

std::string rests(PhysicsWorld& world) {
  const BodyPlacement placed = at(block, .5, -.1);
  world.reset({placed});
  if (!same(world.pose(0), placed.pose)) return "pose() after reset() is not the pose that was given";
  run(world, 1);
  const double moved = distance(world.pose(0), placed.pose);
  return moved < 5e-4 ? "" : fmt::format("a block that nothing touches moved by {:.2g} m in a second", moved);
}

// A motion that touches most of the state.
std::vector<Pose> carry_and_drop(PhysicsWorld& world) {
  world.reset({at(block, .4, -.2), at(block, .45, .1)});
  const Vec3 from{.4, -.2, block_m};
  std::vector<Pose> seen;
  world.grip(0, {from, {}});
  carry(world, from, from + Vec3{.05, .2, .08}, .5);
  world.release();
  for (int i = steps_of(world, .5); i > 0; --i) {
    world.step();
    seen.insert(seen.end(), {world.pose(0), world.pose(1)});
  }
  return seen;
}

std::string forgets(PhysicsWorld& world) {
  const std::vector<Pose> first = carry_and_drop(world);
  world.reset({at(slab, .5, .3), at(block, .6, 0)});
  world.grip(1, {{.6, 0, block_m}, {}});  // left in mid-motion, with the spatula out
  world.place_spatula({.12, .02, .05}, {{.4, -.2, .02}, {}});
  world.step();
  const std::vector<Pose> again = carry_and_drop(world);
  return std::equal(first.begin(), first.end(), again.begin(), again.end(), same)
             ? ""
             : "the same placements and moves give other poses after another scene";
}

std::string holds(PhysicsWorld& world) {
  world.reset({at(block, .4, -.2), at(block, .4, -.2 + block_m + .001)});
  const Pose beside = world.pose(1);
  const Vec3 from{.4, -.2, block_m}, to{.5, .1, block_m + .1};
  world.grip(0, {from, {}});
  carry(world, from, {.4, -.2, block_m + .1}, .3);
  const double dragged = distance(world.pose(1), beside);
  carry(world, {.4, -.2, block_m + .1}, to, .5);
  run(world, .2);  // what lag there is dies out
  const double off = distance(world.pose(0), {{.5, .1, .1}, {}});
  if (off > 2e-3) return fmt::format("a held block is {:.2g} m from where the gripper carries it", off);
  if (dragged > 2e-4) return fmt::format("lifting a block moves the one 1 mm beside it by {:.2g} m", dragged);
  return touching(world, 0, table_body) ? "a block 10 cm above the table is said to touch it" : "";
}

std::string lands(PhysicsWorld& world) {
  world.reset({at(slab, .5, .3), at(block, .5, 0)});
  const Vec3 from{.5, 0, block_m}, over{.5, .3, block_m + slab_height_m + .005};
  world.grip(1, {from, {}});
  carry(world, from, {.5, 0, over.z}, .2);
  carry(world, {.5, 0, over.z}, over, .5);
  world.release();
  run(world, .5);
  const Pose before = world.pose(1);
  run(world, .2);
  if (distance(world.pose(1), before) > 1e-4) return "a block that was let go is not at rest half a second later";
  const double off = std::abs(world.pose(1).position_m.z - slab_height_m);
  if (off > 1e-3) return fmt::format("a block on a slab lies {:.2g} m off its top", off);
  return distance(world.pose(0), at(slab, .5, .3).pose) == 0 ? "" : "a fixed body moved";
}

std::string touches(PhysicsWorld& world) {
  world.reset({at(block, .5, 0)});
  const Vec3 from{.5, 0, block_m};
  world.grip(0, {from, {}});
  carry(world, from, from + Vec3{0, 0, .1}, .2);
  for (int millimetres = 100; millimetres > -20; --millimetres) {
    world.move_gripper({{.5, 0, block_m + .001 * millimetres}, {}});
    world.step();
    if (!touching(world, 0, table_body)) continue;
    const double height = world.pose(0).position_m.z;
    return std::abs(height) < .0015 ? "" : fmt::format("a block touches the table {:.2g} m from it", height);
  }
  return "a block that is let down never touches the table";
}

std::string pushes(PhysicsWorld& world) {
  world.reset({at(block, .5, 0)});
  world.place_spatula({.12, .01, .06}, {{.5, -.08, .035}, {}});
  const int steps = steps_of(world, .8);
  bool touched = false;
  for (int i = 1; i <= steps; ++i) {
    world.move_spatula({{.5, -.08 + .2 * i / steps, .035}, {}});
    world.step();
    touched = touched || touching(world, 0, spatula_body);
  }
  const Vec3 pushed = world.pose(0).position_m;
  const double expected = .12 + .005 + block_m / 2;
  if (std::abs(pushed.y - expected) > .01 || std::abs(pushed.x - .5) > .002 || std::abs(pushed.z) > .002)
    return fmt::format("a block that the spatula pushes to y = {:.3f} m is at ({:.3f}, {:.3f}, {:.3f})", expected,
                       pushed.x, pushed.y, pushed.z);
  if (!touched) return "the spatula pushes a block and is never said to touch it";
  world.remove_spatula();
  run(world, 1);
  return touching(world, 0, spatula_body) ? "a spatula that was removed is said to touch" : "";
}

std::string rays(PhysicsWorld& world) {
  world.reset({at(slab, .5, .3), at(block, .5, .3, slab_height_m), at(block, .4, 0)});
  double height = -1;
  const auto hit = [&](Vec2 point, int body, double top) {
    return world.cast_down(point, height) == body && std::abs(height - top) < 1e-5;
  };
  if (!hit({.5, .3}, 1, slab_height_m + block_m) || !hit({.5, .38}, 0, slab_height_m) || !hit({.4, 0}, 2, block_m))
    return fmt::format("cast_down() misses the topmost body or its top: height {:.4f} m", height);
  return hit({.3, -.4}, no_body, 0) ? "" : "cast_down() beside all bodies: expected no_body at height 0";
}

std::string refuses(PhysicsWorld& world) {
  const auto nobody = [&world] { world.reset({at(block, .5, 0)}), world.pose(1); };
  const auto unknown = [&world] { world.reset({at(9, .5, 0)}); };
  const auto no_grip = [&world] { world.reset({at(block, .5, 0)}), world.move_gripper({}); };
  const auto no_spatula = [&world] { world.reset({at(block, .5, 0)}), world.move_spatula({}); };
  const auto fixed = [&world] { world.reset({at(slab, .5, 0)}), world.grip(0, {{.5, 0, slab_height_m}, {}}); };
  const auto no_number = [&world] {
    world.reset({at(block, .5, 0)});
    world.grip(0, {{.5, 0, block_m}, {}});
    for (int i = 0; i < 20; ++i) {
      world.move_gripper({{std::nan(""), 0, block_m}, {}});
      world.step();
    }
  };
  for (const auto& [what, call] : std::vector<std::pair<const char*, std::function<void()>>>{
           {"pose() of a body that is not placed", nobody},
           {"reset() with a model that was not loaded", unknown},
           {"move_gripper() without a grip", no_grip},
           {"move_spatula() without a spatula", no_spatula},
           {"grip() of a fixed body", fixed},
           {"a gripper at a place that is no number", no_number}})
    if (!throws(call)) return fmt::format("{} throws no EngineError", what);
  return rests(world);  // the next scene is sound
}

}  // namespace

std::vector<BodyModel> contract_bodies() {
  std::vector<BodyModel> all{box("block", block_m / 2, block_m), box("slab", .1, slab_height_m)};
  all.back().fixed = true;
  return all;
}

const std::vector<ContractCheck>& engine_contract() {
  static const std::vector<ContractCheck> all{
      {"time step",
       [](PhysicsWorld& world) {
         const double step = world.time_step_s();
         return step > 0 && step <= .02 ? "" : fmt::format("{} s, expected at most .02", step);
       },
       "make it finer: motions are a few seconds long"},
      {"rest", rests, "bodies must rest where reset() puts them, to the bit before the first step"},
      {"reset", forgets, "reset() must drop all state of the solver: warm starts, contacts, velocities, the grip"},
      {"suction", holds, "a held body hangs at the gripper without lag, and nothing else does"},
      {"release", lands, "a released body comes to rest on what is below it; fixed bodies stay"},
      {"contacts", touches, "report a contact where surfaces meet: neither from afar nor never"},
      {"spatula", pushes, "a pushed body moves as far as the blade goes, and a removed one touches nothing"},
      {"rays", rays, "cast_down() hits the topmost body at its top, and never the spatula"},
      {"errors", refuses, "a call out of order, and a number that is not finite, throw EngineError"}};
  return all;
}

}  // namespace lgabench

#include <tabletop/motions.hpp>

namespace lgabench::tabletop {

int under_suction(const PhysicsWorld& world, Vec2 point, double& height_m) {
  constexpr int ring = 8;
  int body = world.cast_down(point, height_m);
  for (int i = 0; i < ring; ++i) {
    double height = 0;
    const int hit = world.cast_down(point + rotated({suction_radius_m, 0}, 2 * pi * i / ring), height);
    if (hit == no_body || height <= height_m) continue;
    body = hit;
    height_m = height;
  }
  return body;
}

Motion pick_and_place(const Bodies& bodies, const TwoPoses& action) {
  PhysicsWorld& world = bodies.world;
  Clock clock(world);
  double height = 0;
  const int body = under_suction(world, action.pose0.position_m, height);
  if (body == no_body || bodies.fixed[static_cast<std::size_t>(body)]) return {};

  const Vec2 take = action.pose0.position_m, put = action.pose1.position_m;
  const Stance down{{take.x, take.y, height}, 0};
  const Stance up{{take.x, take.y, height + lift_m}, 0};
  Stance over{{put.x, put.y, height + lift_m}, yaw_of(action.pose1.rotation)};
  world.grip(body, down.pose());
  const auto put_gripper = [&](const Stance& stance) { world.move_gripper(stance.pose()); };
  const bool placed = move(clock, down, up, carry_speed, put_gripper) &&
                      move(clock, up, over, carry_speed, put_gripper) &&
                      lower(world, clock, over, body, 0, put_gripper);
  world.release();
  return {body, placed && settle(bodies, clock), failure::none};
}

}  // namespace lgabench::tabletop

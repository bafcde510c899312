#include "mujoco/mujoco_world.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

void put(const Pose& pose, double* position, double* quaternion) {
  const double p[3] = {pose.position_m.x, pose.position_m.y, pose.position_m.z};
  const double q[4] = {pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z};
  std::copy(p, p + 3, position);
  std::copy(q, q + 4, quaternion);
}

Pose get(const double* position, const double* quaternion) {
  return {{position[0], position[1], position[2]}, {quaternion[1], quaternion[2], quaternion[3], quaternion[0]}};
}

/// Height at which the vertical line through `point` leaves the convex mesh `geom`; -infinity where it passes by.
/// MuJoCo's own rays slip through the seam between two pieces: here pieces are closed sets.
double top_at(const mjModel* m, const mjData* d, int geom, Vec2 point) {
  constexpr double infinity = std::numeric_limits<double>::infinity(), tolerance_m = 1e-6, vertical = 1e-9;
  const int mesh = m->geom_dataid[geom];
  double top = infinity, bottom = -infinity;
  for (int face = m->mesh_polyadr[mesh]; face < m->mesh_polyadr[mesh] + m->mesh_polynum[mesh]; ++face) {
    const float* vertex = m->mesh_vert + 3 * (m->mesh_vertadr[mesh] + m->mesh_polyvert[m->mesh_polyvertadr[face]]);
    const double local[3] = {vertex[0], vertex[1], vertex[2]};
    double normal[3], corner[3];
    mju_mulMatVec3(normal, d->geom_xmat + 9 * geom, m->mesh_polynormal + 3 * face);
    mju_mulMatVec3(corner, d->geom_xmat + 9 * geom, local);
    mju_addTo3(corner, d->geom_xpos + 3 * geom);
    // Inside this face: normal.z * z <= room.
    const double room = mju_dot3(normal, corner) - normal[0] * point.x - normal[1] * point.y;
    if (normal[2] > vertical)
      top = std::min(top, room / normal[2]);
    else if (normal[2] < -vertical)
      bottom = std::max(bottom, room / normal[2]);
    else if (room < -tolerance_m)
      return -infinity;
  }
  return bottom <= top + tolerance_m ? top : -infinity;
}

[[noreturn]] void raise(const char* message) { throw EngineError(fmt::format("MuJoCo: {}", message)); }

}  // namespace

MujocoWorld::MujocoWorld() : data_(nullptr, mj_deleteData), pristine_(nullptr, mj_deleteData) {
  // MuJoCo's own handlers end the process and write a log file into the working directory.
  mju_user_error = raise;
  mju_user_warning = [](const char*) {};  // check() reads the warnings from the data
}

void MujocoWorld::load(const std::vector<BodyModel>& models, int bodies) {
  if (pool_) throw EngineError("MuJoCo: load() is called once");
  if (models.empty() || bodies < 1) throw EngineError("MuJoCo: load() without a model or a body");
  pool_.emplace(models, bodies);
  model_ = pool_->model();
  data_.reset(mj_makeData(model_));
  pristine_.reset(mj_makeData(model_));
  if (!data_ || !pristine_) throw EngineError("MuJoCo: no memory for the simulation state");
  owner_.assign(static_cast<std::size_t>(model_->ngeom), no_body);
}

void MujocoWorld::reset(const std::vector<BodyPlacement>& placements) {
  expect_loaded("reset");
  mjData* d = data_.get();
  if (spatula_pose_) park_spatula();
  held_ = no_body;
  std::vector<int> models;
  for (const BodyPlacement& p : placements) models.push_back(p.model);
  pool_->give_out(models);
  const std::vector<MujocoBody>& bodies = pool_->given_out();
  mj_copyData(d, model_, pristine_.get());  // costs less than mj_resetData, which computes the parked bodies anew

  std::fill(owner_.begin(), owner_.end(), no_body);
  owner_[0] = table_body;
  owner_[static_cast<std::size_t>(pool_->spatula().first_geom)] = spatula_body;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const MujocoBody& b = bodies[i];
    std::fill_n(owner_.begin() + b.first_geom, b.geoms, static_cast<int>(i));
    if (b.mocap >= 0) {
      set_mocap(b.mocap, placements[i].pose);
    } else {
      put(placements[i].pose, d->qpos + b.qpos, d->qpos + b.qpos + 3);
      d->tree_awake[b.tree] = 1;  // marked so, an asleep body counts as moved by the user, and MuJoCo wakes it
    }
  }
  lay_to_sleep();
  stale_ = false;
  check();
}

double MujocoWorld::time_step_s() const { return mujoco_time_step_s; }

void MujocoWorld::step() {
  expect_loaded("step");
  if (spatula_pose_) drive_spatula();
  mj_step(model_, data_.get());
  if (spatula_pose_) {  // to the digit, whatever it pushed
    const MujocoBody& spatula = pool_->spatula();
    put(*spatula_pose_, data_->qpos + spatula.qpos, data_->qpos + spatula.qpos + 3);
    std::fill_n(data_->qvel + spatula.dof, 6, 0.0);
  }
  stale_ = true;
  check();
}

Pose MujocoWorld::pose(int body) const {
  const MujocoBody& b = placed(body);
  const mjData* d = data_.get();
  if (b.mocap >= 0) return get(d->mocap_pos + 3 * b.mocap, d->mocap_quat + 4 * b.mocap);
  return get(d->qpos + b.qpos, d->qpos + b.qpos + 3);
}

std::optional<BodyPhysics> MujocoWorld::physics(int body) const {
  const MujocoBody& b = placed(body);
  refresh();
  const mjModel* m = model_;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  mjtNum low[3] = {infinity, infinity, infinity}, high[3] = {-infinity, -infinity, -infinity};
  for (int g = b.first_geom; g < b.first_geom + b.geoms; ++g) {
    const int mesh = m->geom_dataid[g];
    for (int v = m->mesh_vertadr[mesh]; v < m->mesh_vertadr[mesh] + m->mesh_vertnum[mesh]; ++v) {
      const mjtNum local[3] = {m->mesh_vert[3 * v], m->mesh_vert[3 * v + 1], m->mesh_vert[3 * v + 2]};
      mjtNum corner[3];
      mju_mulMatVec3(corner, data_->geom_xmat + 9 * g, local);
      mju_addTo3(corner, data_->geom_xpos + 3 * g);
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], corner[k]);
        high[k] = std::max(high[k], corner[k]);
      }
    }
  }
  return BodyPhysics{{low[0], low[1], low[2]},
                     {high[0], high[1], high[2]},
                     b.mocap >= 0 ? 0 : m->body_mass[b.body],
                     m->geom_priority[b.first_geom] > m->geom_priority[0]
                         ? m->geom_friction[3 * b.first_geom]
                         : std::max(m->geom_friction[0], m->geom_friction[3 * b.first_geom])};
}

std::vector<Contact> MujocoWorld::contacts() const {
  expect_loaded("contacts");
  std::vector<Contact> found;
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& c = data_->contact[i];
    const Contact pair{owner_[static_cast<std::size_t>(c.geom[0])], owner_[static_cast<std::size_t>(c.geom[1])]};
    const auto same = [&](const Contact& o) { return o.a == pair.a && o.b == pair.b; };
    if (std::none_of(found.begin(), found.end(), same)) found.push_back(pair);
  }
  return found;
}

int MujocoWorld::cast_down(Vec2 point, double& height_m) const {
  expect_loaded("cast_down");
  refresh();
  const mjModel* m = model_;
  int hit = no_body;
  height_m = 0;
  const std::vector<MujocoBody>& bodies = pool_->given_out();
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (int g = bodies[i].first_geom; g < bodies[i].first_geom + bodies[i].geoms; ++g) {
      const double* centre = data_->geom_xpos + 3 * g;
      if (std::hypot(centre[0] - point.x, centre[1] - point.y) > m->geom_rbound[g]) continue;
      const double top = top_at(m, data_.get(), g, point);
      if (top <= height_m) continue;
      height_m = top;
      hit = static_cast<int>(i);
    }
  return hit;
}

void MujocoWorld::grip(int body, const Pose& gripper) {
  const MujocoBody& b = placed(body);
  if (b.mocap >= 0) throw EngineError("MuJoCo: a fixed body cannot be gripped");
  mjModel* m = model_;
  mjData* d = data_.get();
  set_mocap(pool_->gripper_mocap(), gripper);
  // Weld: anchor in the held body's frame, in the gripper's frame, then the held body's turn relative to the gripper.
  const Pose held = pose(body);
  const Quat unturn{-held.rotation.x, -held.rotation.y, -held.rotation.z, held.rotation.w};
  const Quat ungrip{-gripper.rotation.x, -gripper.rotation.y, -gripper.rotation.z, gripper.rotation.w};
  mjtNum* weld = m->eq_data;
  put({rotated(gripper.position_m - held.position_m, unturn), ungrip * held.rotation}, weld, weld + 6);
  std::fill_n(weld + 3, 3, 0.0);
  m->eq_obj2id[0] = b.body;
  d->eq_active[0] = 1;
  m->tree_sleep_policy[b.tree] = mjSLEEP_NEVER;  // wakes it; a weld to a mocap body would not
  held_ = body;
}

void MujocoWorld::move_gripper(const Pose& gripper) {
  if (held_ == no_body) throw EngineError("MuJoCo: the gripper moves only while it holds a body");
  set_mocap(pool_->gripper_mocap(), gripper);
}

void MujocoWorld::release() {
  if (held_ == no_body) return;
  data_->eq_active[0] = 0;
  model_->tree_sleep_policy[placed(held_).tree] = mjSLEEP_ALLOWED;
  held_ = no_body;
}

void MujocoWorld::place_spatula(Vec3 size_m, const Pose& pose) {
  expect_loaded("place_spatula");
  mjModel* m = model_;
  const double half[3] = {size_m.x / 2, size_m.y / 2, size_m.z / 2};
  const MujocoBody& spatula = pool_->spatula();
  const int blade = spatula.first_geom;
  std::copy(half, half + 3, m->geom_size + 3 * blade);
  std::copy(half, half + 3, m->geom_aabb + 6 * blade + 3);
  m->geom_rbound[blade] = mju_norm3(half);
  pool_->set_collidable(spatula, true);
  put(pose, data_->qpos + spatula.qpos, data_->qpos + spatula.qpos + 3);
  m->tree_sleep_policy[spatula.tree] = mjSLEEP_NEVER;
  spatula_pose_ = pose;
}

void MujocoWorld::move_spatula(const Pose& pose) {
  if (!spatula_pose_) throw EngineError("MuJoCo: the spatula moves only while it is placed");
  spatula_pose_ = pose;
}

void MujocoWorld::remove_spatula() {
  if (!spatula_pose_) return;
  park_spatula();
  const int qpos = pool_->spatula().qpos;
  std::copy_n(pristine_->qpos + qpos, 7, data_->qpos + qpos);
}

void MujocoWorld::park_spatula() {
  pool_->set_collidable(pool_->spatula(), false);
  model_->tree_sleep_policy[pool_->spatula().tree] = mjSLEEP_ALLOWED;
  spatula_pose_.reset();
}

// Gives it the velocity that takes it to its pose within the step.
void MujocoWorld::drive_spatula() {
  double position[3], quaternion[4];
  put(*spatula_pose_, position, quaternion);
  const double* now = data_->qpos + pool_->spatula().qpos;
  double* velocity = data_->qvel + pool_->spatula().dof;
  for (int i = 0; i < 3; ++i) velocity[i] = (position[i] - now[i]) / mujoco_time_step_s;
  mju_subQuat(velocity + 3, quaternion, now + 3);
  mju_scl3(velocity + 3, velocity + 3, 1 / mujoco_time_step_s);
}

void MujocoWorld::expect_loaded(const char* call) const {
  if (!data_) throw EngineError(fmt::format("MuJoCo: {}() before load()", call));
}

const MujocoBody& MujocoWorld::placed(int body) const {
  const std::size_t placed = pool_ ? pool_->given_out().size() : 0;
  if (body < 0 || static_cast<std::size_t>(body) >= placed)
    throw EngineError(fmt::format("MuJoCo: no body {} among the {} placed", body, placed));
  return pool_->given_out()[static_cast<std::size_t>(body)];
}

void MujocoWorld::set_mocap(int mocap, const Pose& pose) {
  put(pose, data_->mocap_pos + 3 * mocap, data_->mocap_quat + 4 * mocap);
}

void MujocoWorld::lay_to_sleep() {
  mjModel* m = model_;
  mjData* d = data_.get();
  m->opt.disableflags = mujoco_disabled | mjDSBL_CONTACT | mjDSBL_GRAVITY;
  mj_fwdPosition(m, d);  // wakes the placed bodies, and so computes where their geoms are
  for (const MujocoBody& b : pool_->given_out())
    if (b.tree >= 0) d->tree_asleep[b.tree] = -1;  // due to sleep at the end of a step in which it does not move
  mj_step(m, d);
  pool_->pin_fixed(d);
  m->opt.disableflags = mujoco_disabled;
  d->time = 0;
}

void MujocoWorld::refresh() const {
  if (!stale_) return;
  mj_kinematics(model_, data_.get());
  stale_ = false;
}

void MujocoWorld::check() const {
  for (int w = 0; w < mjNWARNING; ++w)
    if (data_->warning[w].number > 0)
      throw EngineError(
          fmt::format("MuJoCo: {}", mju_warningText(w, static_cast<std::size_t>(data_->warning[w].lastinfo))));
}

}  // namespace lgabench

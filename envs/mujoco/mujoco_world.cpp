#include "mujoco/mujoco_world.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

constexpr double time_step = 0.005;
constexpr double stiffest = 2 * time_step;  // time constant of contacts and of suction that the step bears
constexpr double rest_speed = 5e-4;         // m/s: slower bodies may fall asleep

constexpr int disabled = mjDSBL_AUTORESET;  // an instability is an error, not a new start
/// Far beside the table, each body in its own place: parked bodies have no contacts, but must not stack for a picture.
constexpr double parking_distance = 10, parking_gap = 1;

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

MujocoWorld::MujocoWorld()
    : model_(nullptr, mj_deleteModel), data_(nullptr, mj_deleteData), pristine_(nullptr, mj_deleteData) {
  // MuJoCo's own handlers end the process and write a log file into the working directory.
  mju_user_error = raise;
  mju_user_warning = [](const char*) {};  // check() reads the warnings from the data
}

void MujocoWorld::load(const std::vector<BodyModel>& models, int copies) {
  if (model_) throw EngineError("MuJoCo: load() is called once");
  compile(models, copies);
  data_.reset(mj_makeData(model_.get()));
  pristine_.reset(mj_makeData(model_.get()));
  if (!data_ || !pristine_) throw EngineError("MuJoCo: no memory for the simulation state");
  mj_setConst(model_.get(), data_.get());  // inertial constants follow the masses set after compiling
  mj_resetData(model_.get(), pristine_.get());
  mj_forward(model_.get(), pristine_.get());
}

void MujocoWorld::reset(const std::vector<BodyPlacement>& placements) {
  mjModel* m = model_.get();
  mjData* d = data_.get();
  if (!d) throw EngineError("MuJoCo: reset() before load()");
  for (const Slot& s : placed_) {
    set_collidable(s.body, false);
    if (s.tree >= 0) m->tree_sleep_policy[s.tree] = mjSLEEP_ALLOWED;
    std::fill_n(owner_.begin() + s.first_geom, s.geoms, no_body);
  }
  if (spatula_pose_) park_spatula();
  placed_.clear();
  held_ = no_body;
  mj_copyData(d, m, pristine_.get());  // a copy costs an eighth of mj_resetData, which computes the parked bodies anew

  std::vector<std::size_t> used(pool_.size(), 0);
  for (const BodyPlacement& p : placements) {
    const auto model = static_cast<std::size_t>(p.model);
    if (model >= pool_.size() || used[model] >= pool_[model].size())
      throw EngineError(fmt::format("MuJoCo: no free body of model {} in the pool", p.model));
    const Slot& s = pool_[model][used[model]++];
    set_collidable(s.body, true);
    std::fill_n(owner_.begin() + s.first_geom, s.geoms, static_cast<int>(placed_.size()));
    placed_.push_back(s);
    if (s.mocap >= 0) {
      set_mocap(s.mocap, p.pose);
    } else {
      put(p.pose, d->qpos + s.qpos, d->qpos + s.qpos + 3);
      d->tree_awake[s.tree] = 1;  // marked so, an asleep body counts as moved by the user, and MuJoCo wakes it
    }
  }
  lay_to_sleep();
  stale_ = false;
  check();
}

double MujocoWorld::time_step_s() const { return time_step; }

void MujocoWorld::step() {
  if (spatula_pose_) drive_spatula();
  mj_step(model_.get(), data_.get());
  if (spatula_pose_) {  // to the digit, whatever it pushed
    put(*spatula_pose_, data_->qpos + spatula_.qpos, data_->qpos + spatula_.qpos + 3);
    std::fill_n(data_->qvel + spatula_.dof, 6, 0.0);
  }
  stale_ = true;
  check();
}

Pose MujocoWorld::pose(int body) const {
  const Slot& s = slot(body);
  const mjData* d = data_.get();
  if (s.mocap >= 0) return get(d->mocap_pos + 3 * s.mocap, d->mocap_quat + 4 * s.mocap);
  return get(d->qpos + s.qpos, d->qpos + s.qpos + 3);
}

std::vector<Contact> MujocoWorld::contacts() const {
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
  refresh();
  const mjModel* m = model_.get();
  int hit = no_body;
  height_m = 0;
  for (std::size_t i = 0; i < placed_.size(); ++i)
    for (int g = placed_[i].first_geom; g < placed_[i].first_geom + placed_[i].geoms; ++g) {
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
  const Slot& s = slot(body);
  if (s.mocap >= 0) throw EngineError("MuJoCo: a fixed body cannot be gripped");
  mjModel* m = model_.get();
  mjData* d = data_.get();
  set_mocap(gripper_, gripper);
  // Weld: anchor in the held body's frame, in the gripper's frame, then the held body's turn relative to the gripper.
  const Pose held = pose(body);
  const Quat unturn{-held.rotation.x, -held.rotation.y, -held.rotation.z, held.rotation.w};
  const Quat ungrip{-gripper.rotation.x, -gripper.rotation.y, -gripper.rotation.z, gripper.rotation.w};
  mjtNum* weld = m->eq_data;
  put({rotated(gripper.position_m - held.position_m, unturn), ungrip * held.rotation}, weld, weld + 6);
  std::fill_n(weld + 3, 3, 0.0);
  m->eq_obj2id[0] = s.body;
  d->eq_active[0] = 1;
  m->tree_sleep_policy[s.tree] = mjSLEEP_NEVER;  // wakes it; a weld to a mocap body would not
  held_ = body;
}

void MujocoWorld::move_gripper(const Pose& gripper) {
  if (held_ == no_body) throw EngineError("MuJoCo: the gripper moves only while it holds a body");
  set_mocap(gripper_, gripper);
}

void MujocoWorld::release() {
  if (held_ == no_body) return;
  data_->eq_active[0] = 0;
  model_->tree_sleep_policy[slot(held_).tree] = mjSLEEP_ALLOWED;
  held_ = no_body;
}

void MujocoWorld::place_spatula(Vec3 size_m, const Pose& pose) {
  mjModel* m = model_.get();
  const double half[3] = {size_m.x / 2, size_m.y / 2, size_m.z / 2};
  const int blade = spatula_.first_geom;
  std::copy(half, half + 3, m->geom_size + 3 * blade);
  std::copy(half, half + 3, m->geom_aabb + 6 * blade + 3);
  m->geom_rbound[blade] = mju_norm3(half);
  set_collidable(spatula_.body, true);
  put(pose, data_->qpos + spatula_.qpos, data_->qpos + spatula_.qpos + 3);
  m->tree_sleep_policy[spatula_.tree] = mjSLEEP_NEVER;
  spatula_pose_ = pose;
}

void MujocoWorld::move_spatula(const Pose& pose) {
  if (!spatula_pose_) throw EngineError("MuJoCo: the spatula moves only while it is placed");
  spatula_pose_ = pose;
}

void MujocoWorld::remove_spatula() {
  if (!spatula_pose_) return;
  park_spatula();
  std::copy_n(pristine_->qpos + spatula_.qpos, 7, data_->qpos + spatula_.qpos);
}

void MujocoWorld::park_spatula() {
  set_collidable(spatula_.body, false);
  model_->tree_sleep_policy[spatula_.tree] = mjSLEEP_ALLOWED;
  spatula_pose_.reset();
}

// Gives it the velocity that takes it to its pose within the step.
void MujocoWorld::drive_spatula() {
  double position[3], quaternion[4];
  put(*spatula_pose_, position, quaternion);
  const double* now = data_->qpos + spatula_.qpos;
  double* velocity = data_->qvel + spatula_.dof;
  for (int i = 0; i < 3; ++i) velocity[i] = (position[i] - now[i]) / time_step;
  mju_subQuat(velocity + 3, quaternion, now + 3);
  mju_scl3(velocity + 3, velocity + 3, 1 / time_step);
}

const MujocoWorld::Slot& MujocoWorld::slot(int body) const {
  if (body < 0 || static_cast<std::size_t>(body) >= placed_.size())
    throw EngineError(fmt::format("MuJoCo: no body {} among the {} placed", body, placed_.size()));
  return placed_[static_cast<std::size_t>(body)];
}

void MujocoWorld::compile(const std::vector<BodyModel>& models, int copies) {
  const std::unique_ptr<mjSpec, void (*)(mjSpec*)> spec(mj_makeSpec(), mj_deleteSpec);
  mjOption& option = spec->option;
  option.timestep = time_step;
  option.integrator = mjINT_IMPLICITFAST;
  option.cone = mjCONE_ELLIPTIC;
  option.impratio = 10;  // stiffer friction than normal force: resting bodies do not creep
  option.sleep_tolerance = rest_speed;
  option.enableflags |= mjENBL_SLEEP;
  option.disableflags = disabled;

  mjsBody* world = mjs_findBody(spec.get(), "world");
  mjsGeom* table = mjs_addGeom(world, nullptr);
  table->type = mjGEOM_BOX;
  std::fill_n(table->size, 3, 5.0);  // a box: on a plane, MuJoCo supports a mesh at three corners only, and it rocks
  table->solref[0] = stiffest;
  table->pos[2] = -5;
  mjsBody* gripper = mjs_addBody(world, nullptr);
  mjs_setName(gripper->element, "gripper");
  gripper->mocap = true;
  mjsBody* spatula = mjs_addBody(world, nullptr);
  mjs_setName(spatula->element, "spatula");
  mjs_addFreeJoint(spatula);
  spatula->sleep = mjSLEEP_INIT;
  spatula->gravcomp = 1;
  spatula->pos[0] = parking_distance;
  spatula->pos[1] = -parking_gap;
  mjsGeom* blade = mjs_addGeom(spatula, nullptr);
  blade->type = mjGEOM_BOX;
  blade->solref[0] = stiffest;
  blade->mass = 1000;
  std::fill_n(blade->size, 3, 0.01);
  blade->contype = blade->conaffinity = 0;

  int parked = 0;
  for (std::size_t i = 0; i < models.size(); ++i) {
    for (std::size_t p = 0; p < models[i].pieces.size(); ++p) {
      mjsMesh* mesh = mjs_addMesh(spec.get(), nullptr);
      mjs_setName(mesh->element, fmt::format("{}/{}", i, p).c_str());
      mesh->inertia = mjMESH_INERTIA_CONVEX;
      std::vector<float> corners;
      for (const Vec3& c : models[i].pieces[p].corners_m)
        for (const double v : {c.x, c.y, c.z}) corners.push_back(static_cast<float>(v));
      mjs_setFloat(mesh->uservert, corners.data(), static_cast<int>(corners.size()));
    }
    for (int copy = 0; copy < copies; ++copy, ++parked) {
      mjsBody* body = mjs_addBody(world, nullptr);
      mjs_setName(body->element, fmt::format("{}#{}", i, copy).c_str());
      body->pos[0] = parking_distance;
      body->pos[1] = parking_gap * parked;
      body->mocap = models[i].fixed;
      if (!models[i].fixed) {
        mjs_addFreeJoint(body);
        body->sleep = mjSLEEP_INIT;
      }
      for (std::size_t p = 0; p < models[i].pieces.size(); ++p) {
        mjsGeom* geom = mjs_addGeom(body, nullptr);
        geom->type = mjGEOM_MESH;
        mjs_setString(geom->meshname, fmt::format("{}/{}", i, p).c_str());
        geom->contype = geom->conaffinity = 0;
        geom->solref[0] = stiffest;
      }
    }
  }
  // One weld serves every body: grip() points it at the one that is held.
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (models[i].fixed) continue;
    mjsEquality* weld = mjs_addEquality(spec.get(), nullptr);
    weld->type = mjEQ_WELD;
    weld->objtype = mjOBJ_BODY;
    weld->active = false;
    mjs_setString(weld->name1, "gripper");
    mjs_setString(weld->name2, fmt::format("{}#0", i).c_str());
    weld->solref[0] = stiffest;
    weld->data[10] = 1;  // torque scale
    break;
  }

  model_.reset(mj_compile(spec.get(), nullptr));
  if (!model_) throw EngineError(fmt::format("MuJoCo: the models do not compile: {}", mjs_getError(spec.get())));
  mjModel* m = model_.get();
  const auto body_id = [&](const std::string& name) { return mj_name2id(m, mjOBJ_BODY, name.c_str()); };
  gripper_ = m->body_mocapid[body_id("gripper")];
  owner_.assign(static_cast<std::size_t>(m->ngeom), no_body);
  owner_[0] = table_body;

  const auto slot_of = [&](const std::string& name) {
    Slot s;
    s.body = body_id(name);
    s.first_geom = m->body_geomadr[s.body];
    s.geoms = m->body_geomnum[s.body];
    s.mocap = m->body_mocapid[s.body];
    if (s.mocap < 0) {
      s.qpos = m->jnt_qposadr[m->body_jntadr[s.body]];
      s.dof = m->body_dofadr[s.body];
      s.tree = m->body_treeid[s.body];
    }
    return s;
  };
  spatula_ = slot_of("spatula");
  owner_[static_cast<std::size_t>(spatula_.first_geom)] = spatula_body;
  pool_.assign(models.size(), {});
  for (std::size_t i = 0; i < models.size(); ++i)
    for (int copy = 0; copy < copies; ++copy) {
      const Slot s = slot_of(fmt::format("{}#{}", i, copy));
      if (!models[i].fixed) {
        // Compiled with a density of 1000: scaled to the mass that was asked for.
        const double scale = models[i].mass_kg / m->body_mass[s.body];
        m->body_mass[s.body] *= scale;
        for (int k = 0; k < 3; ++k) m->body_inertia[3 * s.body + k] *= scale;
      }
      pool_[i].push_back(s);
    }
}

void MujocoWorld::set_collidable(int body, bool collidable) {
  mjModel* m = model_.get();
  const int bit = collidable ? 1 : 0, first = m->body_geomadr[body];
  m->body_contype[body] = m->body_conaffinity[body] = bit;
  for (int g = first; g < first + m->body_geomnum[body]; ++g) m->geom_contype[g] = m->geom_conaffinity[g] = bit;
}

void MujocoWorld::set_mocap(int mocap, const Pose& pose) {
  put(pose, data_->mocap_pos + 3 * mocap, data_->mocap_quat + 4 * mocap);
}

void MujocoWorld::lay_to_sleep() {
  mjModel* m = model_.get();
  mjData* d = data_.get();
  m->opt.disableflags = disabled | mjDSBL_CONTACT | mjDSBL_GRAVITY;
  mj_fwdPosition(m, d);  // wakes the placed bodies, and so computes where their geoms are
  for (const Slot& s : placed_)
    if (s.tree >= 0) d->tree_asleep[s.tree] = -1;  // due to sleep at the end of a step in which it does not move
  mj_step(m, d);
  m->opt.disableflags = disabled;
  d->time = 0;
}

void MujocoWorld::refresh() const {
  if (!stale_) return;
  mj_kinematics(model_.get(), data_.get());
  stale_ = false;
}

void MujocoWorld::check() const {
  for (int w = 0; w < mjNWARNING; ++w)
    if (data_->warning[w].number > 0)
      throw EngineError(
          fmt::format("MuJoCo: {}", mju_warningText(w, static_cast<std::size_t>(data_->warning[w].lastinfo))));
}

}  // namespace lgabench

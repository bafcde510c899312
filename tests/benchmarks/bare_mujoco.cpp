#include "bare_mujoco.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace lgabench {
namespace {

void put(const Pose& pose, double* position, double* quaternion) {
  const double p[3] = {pose.position_m.x, pose.position_m.y, pose.position_m.z};
  const double q[4] = {pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z};
  std::copy(p, p + 3, position);
  std::copy(q, q + 4, quaternion);
}

}  // namespace

BareMujoco::BareMujoco(const std::vector<BodyModel>& models, const std::vector<BodyPlacement>& placements)
    : model_(nullptr, mj_deleteModel), data_(nullptr, mj_deleteData) {
  const std::unique_ptr<mjSpec, void (*)(mjSpec*)> spec(mj_makeSpec(), mj_deleteSpec);
  spec->option.timestep = .005;
  spec->option.integrator = mjINT_IMPLICITFAST;
  spec->option.cone = mjCONE_ELLIPTIC;
  spec->option.impratio = 10;
  spec->option.sleep_tolerance = 5e-4;
  spec->option.enableflags |= mjENBL_SLEEP;
  mjsBody* const world = mjs_findBody(spec.get(), "world");
  mjsGeom* const table = mjs_addGeom(world, nullptr);
  table->type = mjGEOM_BOX;
  std::fill_n(table->size, 3, 5.0);
  table->pos[2] = -5;
  mjsLight* const light = mjs_addLight(world, nullptr);  // for its renderer's shadows
  light->type = mjLIGHT_DIRECTIONAL;
  light->castshadow = true;
  light->pos[2] = 2;
  light->dir[0] = .3;
  mjsBody* const gripper = mjs_addBody(world, nullptr);
  mjs_setName(gripper->element, "gripper");
  gripper->mocap = true;
  int welds = 0;
  for (std::size_t i = 0; i < placements.size(); ++i) {
    const BodyModel& model = models[static_cast<std::size_t>(placements[i].model)];
    mjsBody* const body = mjs_addBody(world, nullptr);
    const std::string name = fmt::format("body{}", i);
    mjs_setName(body->element, name.c_str());
    put(placements[i].pose, body->pos, body->quat);
    if (!model.fixed) mjs_addFreeJoint(body);
    for (std::size_t p = 0; p < model.pieces.size(); ++p) {
      mjsMesh* const mesh = mjs_addMesh(spec.get(), nullptr);
      const std::string piece = fmt::format("{}/{}", i, p);
      mjs_setName(mesh->element, piece.c_str());
      mesh->inertia = mjMESH_INERTIA_CONVEX;
      std::vector<float> corners;
      for (const Vec3& c : model.pieces[p].corners_m)
        for (const double v : {c.x, c.y, c.z}) corners.push_back(static_cast<float>(v));
      mjs_setFloat(mesh->uservert, corners.data(), static_cast<int>(corners.size()));
      mjsGeom* const geom = mjs_addGeom(body, nullptr);
      geom->type = mjGEOM_MESH;
      geom->mass = model.mass_kg / static_cast<double>(model.pieces.size());
      mjs_setString(geom->meshname, piece.c_str());
    }
    welds_.push_back(model.fixed ? -1 : welds++);
    if (model.fixed) continue;
    mjsEquality* const weld = mjs_addEquality(spec.get(), nullptr);
    weld->type = mjEQ_WELD;
    weld->objtype = mjOBJ_BODY;
    weld->active = false;
    mjs_setString(weld->name1, "gripper");
    mjs_setString(weld->name2, name.c_str());
    weld->solref[0] = .01;
    weld->data[10] = 1;
  }
  model_.reset(mj_compile(spec.get(), nullptr));
  if (!model_) throw std::runtime_error(mjs_getError(spec.get()));
  data_.reset(mj_makeData(model_.get()));
}

void BareMujoco::reset() {
  mj_resetData(model_.get(), data_.get());
  mj_forward(model_.get(), data_.get());
}

void BareMujoco::play(const std::vector<GripperFrame>& frames) {
  int held = no_body;
  for (const GripperFrame& frame : frames) {
    if (held != frame.held) {
      if (held >= 0) data_->eq_active[welds_[static_cast<std::size_t>(held)]] = 0;
      held = frame.held;
      if (held >= 0) {
        const int weld = welds_[static_cast<std::size_t>(held)];
        const Quat turn = frame.body_when_gripped.rotation, grip = frame.gripper_when_gripped.rotation;
        const Quat unturn{-turn.x, -turn.y, -turn.z, turn.w}, ungrip{-grip.x, -grip.y, -grip.z, grip.w};
        mjtNum* const data = model_->eq_data + mjNEQDATA * weld;
        put({rotated(frame.gripper_when_gripped.position_m - frame.body_when_gripped.position_m, unturn),
             ungrip * turn},
            data, data + 6);
        std::fill_n(data + 3, 3, 0.0);
        data_->eq_active[weld] = 1;
      }
    }
    if (held >= 0) put(frame.gripper, data_->mocap_pos, data_->mocap_quat);
    mj_step(model_.get(), data_.get());
  }
}

}  // namespace lgabench

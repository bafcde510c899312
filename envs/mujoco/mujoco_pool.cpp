#include "mujoco/mujoco_pool.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <numeric>
#include <utility>

#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

constexpr double stiffest = 2 * mujoco_time_step_s;  // shortest stable time constant of contacts and suction
constexpr double rest_speed = 5e-4;                  // m/s: slower bodies may fall asleep
/// Far beside the table, each body in its own place.
constexpr double parking_distance = 10, parking_gap = 1;

using Model = std::unique_ptr<mjModel, void (*)(mjModel*)>;

/// A body to compile: a free or a fixed one, and its pieces' meshes.
struct Plan {
  bool fixed;
  std::vector<std::string> meshes;
};

std::string mesh_name(std::size_t model, std::size_t piece) { return fmt::format("{}/{}", model, piece); }
std::string body_name(std::size_t plan) { return fmt::format("body{}", plan); }

void add_meshes(mjSpec* spec, const std::vector<BodyModel>& models) {
  for (std::size_t i = 0; i < models.size(); ++i)
    for (std::size_t p = 0; p < models[i].pieces.size(); ++p) {
      mjsMesh* mesh = mjs_addMesh(spec, nullptr);
      mjs_setName(mesh->element, mesh_name(i, p).c_str());
      mesh->inertia = mjMESH_INERTIA_CONVEX;
      std::vector<float> corners;
      for (const Vec3& c : models[i].pieces[p].corners_m)
        for (const double v : {c.x, c.y, c.z}) corners.push_back(static_cast<float>(v));
      mjs_setFloat(mesh->uservert, corners.data(), static_cast<int>(corners.size()));
    }
}

void add_spatula(mjsBody* world) {
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
}

// Bodies lie along y, `gap` apart.
Model compile(const std::vector<BodyModel>& models, const std::vector<Plan>& plans, double x, double gap) {
  const std::unique_ptr<mjSpec, void (*)(mjSpec*)> spec(mj_makeSpec(), mj_deleteSpec);
  mjOption& option = spec->option;
  option.timestep = mujoco_time_step_s;
  option.integrator = mjINT_IMPLICITFAST;
  option.cone = mjCONE_ELLIPTIC;
  option.impratio = 10;  // stiffer friction than normal force: resting bodies do not creep
  option.sleep_tolerance = rest_speed;
  option.disableflags = mujoco_disabled;
  option.jacobian = mjJAC_DENSE;  // by itself, the number of bodies would decide, and show in the last digits
  option.enableflags |= mjENBL_SLEEP;

  mjsBody* world = mjs_findBody(spec.get(), "world");
  mjsGeom* table = mjs_addGeom(world, nullptr);
  table->type = mjGEOM_BOX;
  std::fill_n(table->size, 3, 5.0);  // a box: on a plane, MuJoCo supports a mesh at three corners only, and it rocks
  table->solref[0] = stiffest;
  table->pos[2] = -5;
  mjsBody* gripper = mjs_addBody(world, nullptr);
  mjs_setName(gripper->element, "gripper");
  gripper->mocap = true;
  add_spatula(world);
  add_meshes(spec.get(), models);

  for (std::size_t i = 0; i < plans.size(); ++i) {
    mjsBody* body = mjs_addBody(world, nullptr);
    mjs_setName(body->element, body_name(i).c_str());
    body->pos[0] = x;
    body->pos[1] = gap * static_cast<double>(i);
    body->mocap = plans[i].fixed;
    if (!plans[i].fixed) {
      mjs_addFreeJoint(body);
      body->sleep = mjSLEEP_INIT;
    }
    for (const std::string& mesh : plans[i].meshes) {
      mjsGeom* geom = mjs_addGeom(body, nullptr);
      geom->type = mjGEOM_MESH;
      mjs_setString(geom->meshname, mesh.c_str());
      geom->contype = geom->conaffinity = 0;
      geom->solref[0] = stiffest;
    }
  }
  const auto held = std::find_if(plans.begin(), plans.end(), [](const Plan& p) { return !p.fixed; });
  if (held != plans.end()) {  // one weld serves every body: it is pointed at the one that is held
    mjsEquality* weld = mjs_addEquality(spec.get(), nullptr);
    weld->type = mjEQ_WELD;
    weld->objtype = mjOBJ_BODY;
    weld->active = false;
    mjs_setString(weld->name1, "gripper");
    mjs_setString(weld->name2, body_name(static_cast<std::size_t>(held - plans.begin())).c_str());
    weld->solref[0] = stiffest;
    weld->data[10] = 1;  // torque scale
  }
  Model compiled(mj_compile(spec.get(), nullptr), mj_deleteModel);
  if (!compiled) throw EngineError(fmt::format("MuJoCo: the models do not compile: {}", mjs_getError(spec.get())));
  return compiled;
}

MujocoBody find_body(const mjModel* m, const std::string& name) {
  MujocoBody found;
  found.body = mj_name2id(m, mjOBJ_BODY, name.c_str());
  found.first_geom = m->body_geomadr[found.body];
  found.geoms = m->body_geomnum[found.body];
  found.mocap = m->body_mocapid[found.body];
  if (found.mocap < 0) {
    found.qpos = m->jnt_qposadr[m->body_jntadr[found.body]];
    found.dof = m->body_dofadr[found.body];
    found.tree = m->body_treeid[found.body];
  }
  return found;
}

// What of a compiled model depends on the shape of a body, its degrees of freedom and its geoms; beside these, which
// frames coincide and each geom's mesh.
struct Column {
  mjtNum* mjModel::*rows;
  int width;
};
constexpr Column of_body[] = {{&mjModel::body_ipos, 3},    {&mjModel::body_iquat, 4},
                              {&mjModel::body_mass, 1},    {&mjModel::body_subtreemass, 1},
                              {&mjModel::body_inertia, 3}, {&mjModel::body_invweight0, 2}};
constexpr Column of_dof[] = {{&mjModel::dof_length, 1}};
constexpr Column of_geom[] = {{&mjModel::geom_aabb, 6},
                              {&mjModel::geom_rbound, 1},
                              {&mjModel::geom_pos, 3},
                              {&mjModel::geom_quat, 4},
                              {&mjModel::geom_friction, 3}};

template <std::size_t n>
void copy_rows(const Column (&columns)[n], const mjModel* from, int first, mjModel* to, int to_first, int count) {
  for (const Column& c : columns)
    std::copy_n(from->*c.rows + c.width * first, c.width * count, to->*c.rows + c.width * to_first);
}

// Compiled with a density of 1000: scaled to the mass that was asked for.
void set_mass(mjModel* m, int body, double mass_kg) {
  const double scale = mass_kg / m->body_mass[body];
  m->body_mass[body] *= scale;
  for (int k = 0; k < 3; ++k) m->body_inertia[3 * body + k] *= scale;
}

// MuJoCo takes the greater friction of two: of what has another than usual, the priority makes it count alone.
void set_friction(mjModel* m, const MujocoBody& body, double friction) {
  if (friction == 1) return;
  for (int g = body.first_geom; g < body.first_geom + body.geoms; ++g) {
    m->geom_priority[g] = 1;
    for (int k = 0; k < 3; ++k) m->geom_friction[3 * g + k] *= friction;
  }
}

}  // namespace

MujocoPool::MujocoPool(const std::vector<BodyModel>& models, int bodies)
    : patterns_(nullptr, mj_deleteModel), model_(nullptr, mj_deleteModel) {
  std::vector<Plan> each;
  std::size_t most_pieces = 0;
  for (std::size_t i = 0; i < models.size(); ++i) {
    each.push_back({models[i].fixed, {}});
    for (std::size_t p = 0; p < models[i].pieces.size(); ++p) each.back().meshes.push_back(mesh_name(i, p));
    most_pieces = std::max(most_pieces, models[i].pieces.size());
  }
  patterns_ = compile(models, each, 0, 0);  // all in one place: where they lie would show in the last digits
  for (std::size_t i = 0; i < models.size(); ++i) {
    shapes_.push_back(find_body(patterns_.get(), body_name(i)));
    if (!models[i].fixed) set_mass(patterns_.get(), shapes_.back().body, models[i].mass_kg);
    set_friction(patterns_.get(), shapes_.back(), models[i].friction);
  }
  const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(patterns_.get()), mj_deleteData);
  if (!data) throw EngineError("MuJoCo: no memory for the simulation state");
  mj_setConst(patterns_.get(), data.get());  // inertial constants follow the masses

  std::vector<Plan> plans(static_cast<std::size_t>(bodies), {false, std::vector(most_pieces, mesh_name(0, 0))});
  plans.resize(2 * plans.size(), {true, plans.front().meshes});
  model_ = compile(models, plans, parking_distance, parking_gap);
  mjModel* m = model_.get();
  gripper_mocap_ = m->body_mocapid[mj_name2id(m, mjOBJ_BODY, "gripper")];
  spatula_ = find_body(m, "spatula");
  for (std::size_t i = 0; i < plans.size(); ++i)
    (plans[i].fixed ? fixed_ : free_).push_back(find_body(m, body_name(i)));
}

void MujocoPool::give_out(const std::vector<int>& models) {
  for (const MujocoBody& body : given_out_) {
    set_collidable(body, false);
    if (body.tree >= 0)
      model_->tree_sleep_policy[body.tree] = mjSLEEP_ALLOWED;
    else
      set_mocap(body, true);
  }
  given_out_.clear();
  for (const int i : models)
    if (i < 0 || static_cast<std::size_t>(i) >= shapes_.size())
      throw EngineError(fmt::format("MuJoCo: no model {} among the {} loaded", i, shapes_.size()));
  if (models.size() > free_.size())
    throw EngineError(fmt::format("MuJoCo: {} bodies, of at most {}", models.size(), free_.size()));

  std::vector<std::size_t> order(models.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&models](auto a, auto b) { return models[a] < models[b]; });
  std::vector<MujocoBody> given(models.size());
  std::size_t used[2] = {0, 0};
  for (const std::size_t i : order) {
    const MujocoBody& shape = shapes_[static_cast<std::size_t>(models[i])];
    const bool fixed = shape.mocap >= 0;
    given[i] = (fixed ? fixed_ : free_)[used[fixed]++];
    put_on(shape, given[i]);
    set_collidable(given[i], true);
  }
  given_out_ = std::move(given);
}

void MujocoPool::pin_fixed(mjData* data) {
  for (const MujocoBody& body : given_out_) {
    if (body.mocap < 0) continue;
    std::copy_n(data->mocap_pos + 3 * body.mocap, 3, model_->body_pos + 3 * body.body);
    std::copy_n(data->mocap_quat + 4 * body.mocap, 4, model_->body_quat + 4 * body.body);
    set_mocap(body, false);
    data->body_awake[body.body] = mjS_STATIC;
  }
}

void MujocoPool::set_mocap(const MujocoBody& body, bool mocap) {
  model_->body_mocapid[body.body] = mocap ? body.mocap : -1;
  model_->body_weldid[body.body] = mocap ? body.body : 0;  // welded to the world, which no asleep body collides with
}

void MujocoPool::set_collidable(const MujocoBody& body, bool collidable) {
  mjModel* m = model_.get();
  const int bit = collidable ? 1 : 0;
  m->body_contype[body.body] = m->body_conaffinity[body.body] = bit;
  for (int g = body.first_geom; g < body.first_geom + body.geoms; ++g)
    m->geom_contype[g] = m->geom_conaffinity[g] = bit;
}

void MujocoPool::put_on(const MujocoBody& shape, MujocoBody& body) const {
  const mjModel* from = patterns_.get();
  mjModel* to = model_.get();
  copy_rows(of_body, from, shape.body, to, body.body, 1);
  to->body_sameframe[body.body] = from->body_sameframe[shape.body];
  to->body_geomnum[body.body] = body.geoms = shape.geoms;
  if (body.dof >= 0) copy_rows(of_dof, from, shape.dof, to, body.dof, 6);
  copy_rows(of_geom, from, shape.first_geom, to, body.first_geom, shape.geoms);
  for (int g = 0; g < shape.geoms; ++g) {
    to->geom_sameframe[body.first_geom + g] = from->geom_sameframe[shape.first_geom + g];
    to->geom_dataid[body.first_geom + g] = from->geom_dataid[shape.first_geom + g];
    to->geom_priority[body.first_geom + g] = from->geom_priority[shape.first_geom + g];
  }
}

}  // namespace lgabench

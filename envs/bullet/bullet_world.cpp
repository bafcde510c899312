#include "bullet/bullet_world.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

constexpr double time_step = 0.005;
constexpr double turning_lost_per_s = .8;  // a share: a disc on its edge would roll for ever
constexpr double friction = 1;             // of every pair of bodies: Bullet multiplies the two
constexpr double slop_m = 2e-5;            // so deep bodies may rest in one another: contacts then do not come and go
constexpr double contact_m = 2e-3;         // from here on a contact is known, before bodies touch
constexpr double touch_m = 1e-5;           // nearer than this, bodies touch
constexpr double asleep_m_s = 5e-4, asleep_rad_s = 5e-3, asleep_after_s = .05;  // slower for so long: asleep
constexpr double most_pull_m_s = 10, most_pull_rad_s = 40;  // of what lags behind the gripper because it was held up
const btVector3 gravity(0, 0, -9.81);

bool is_finite(const btTransform& t) {
  const auto finite = [](const btVector3& v) { return std::isfinite(v.x() + v.y() + v.z()); };
  return finite(t.getOrigin()) && finite(t.getBasis()[0]) && finite(t.getBasis()[1]) && finite(t.getBasis()[2]);
}

btTransform finite(const Pose& pose) {
  const btTransform t = to_bullet(pose);
  if (!is_finite(t)) throw EngineError("Bullet: expected a pose of finite numbers");
  return t;
}

std::unique_ptr<btRigidBody> make_body(double mass_kg, btCollisionShape* shape, const btVector3& inertia,
                                       const btTransform& at, int name) {
  btRigidBody::btRigidBodyConstructionInfo info(mass_kg, nullptr, shape, inertia);
  info.m_startWorldTransform = at;
  info.m_friction = friction;
  info.m_angularDamping = turning_lost_per_s;
  info.m_linearSleepingThreshold = asleep_m_s;
  info.m_angularSleepingThreshold = asleep_rad_s;
  auto body = std::make_unique<btRigidBody>(info);
  body->setFlags(0);  // no gyroscopic torque: what is held turns as it is told
  body->setUserIndex(name);
  return body;
}

btVector3 at_most(double limit, const btVector3& v) {
  const double length = v.length();
  return length > limit ? limit / length * v : v;
}

}  // namespace

void BulletWorld::load(const std::vector<BodyModel>& models, int bodies) {
  if (most_bodies_ > 0) throw EngineError("Bullet: load() is called once");
  // The whole process has these. By default 2 s, most of an episode, and .02 m, which keeps neighbours awake.
  gDeactivationTime = asleep_after_s;
  gContactBreakingThreshold = contact_m;
  for (const BodyModel& model : models) models_.push_back(make_bullet_model(model));
  most_bodies_ = static_cast<std::size_t>(bodies);
}

BulletWorld::Simulation BulletWorld::make_simulation(std::size_t bodies) const {
  btDefaultCollisionConstructionInfo pools;  // the default pools are 4 MB, which take longer to lay out than an episode
  pools.m_defaultMaxPersistentManifoldPoolSize = 256;
  pools.m_defaultMaxCollisionAlgorithmPoolSize = 256;
  Simulation s;
  s.configuration = std::make_unique<btDefaultCollisionConfiguration>(pools);
  // A plane asks a body for its lowest corner only: four tilted looks more, as long as fewer than four corners are
  // known.
  s.configuration->setPlaneConvexMultipointIterations(4, 4);
  s.dispatcher = std::make_unique<btCollisionDispatcher>(s.configuration.get());
  // Every pair by its exact boxes: few bodies, and a tree's wider boxes wake bodies that nothing comes near.
  s.dispatcher->setDispatcherFlags(0);  // contact_m is a length, not a share of each body's size
  constexpr std::size_t table_and_spatula = 2;
  s.broadphase = std::make_unique<btSimpleBroadphase>(static_cast<int>(bodies + table_and_spatula));
  s.solver = std::make_unique<btSequentialImpulseConstraintSolver>();
  s.world = std::make_unique<btDiscreteDynamicsWorld>(s.dispatcher.get(), s.broadphase.get(), s.solver.get(),
                                                      s.configuration.get());
  s.world->setGravity(gravity);
  s.world->getDispatchInfo().m_enableSatConvex = true;
  s.world->getDispatchInfo().m_deterministicOverlappingPairs = true;
  s.solver->setRandSeed(0);
  btContactSolverInfo& solver = s.world->getSolverInfo();
  solver.m_minimumSolverBatchSize = 1;  // each island alone: what happens elsewhere does not change the order
  solver.m_numIterations = 50;          // at most: fewer where impulses have settled
  solver.m_leastSquaresResidualThreshold = 1e-14;
  solver.m_linearSlop = slop_m;
  // Friction along two fixed directions: along that of sliding, a block pushed straight turns by up to 17 degrees.
  solver.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_DISABLE_VELOCITY_DEPENDENT_FRICTION_DIRECTION |
                         SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;
  solver.m_splitImpulsePenetrationThreshold = 0;  // positions are put right without adding speed, however shallow
  s.table_shape = std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), 0);
  s.table = make_body(0, s.table_shape.get(), {0, 0, 0}, btTransform::getIdentity(), table_body);
  s.world->addRigidBody(s.table.get());
  return s;
}

void BulletWorld::reset(const std::vector<BodyPlacement>& placements) {
  if (most_bodies_ == 0) throw EngineError("Bullet: reset() before load()");
  if (placements.size() > most_bodies_)
    throw EngineError(fmt::format("Bullet: {} bodies, of at most {}", placements.size(), most_bodies_));
  grip_.reset();
  now_.reset();
  auto made = std::make_unique<Simulation>(make_simulation(placements.size()));
  for (const BodyPlacement& p : placements) {
    const auto index = static_cast<std::size_t>(p.model);
    if (p.model < 0 || index >= models_.size())
      throw EngineError(fmt::format("Bullet: no model {} among the {} loaded", p.model, models_.size()));
    const BulletModel& model = models_[index];
    const btTransform start = finite(p.pose) * model.mass_frame;
    auto rigid = make_body(model.mass_kg, model.shape(), model.inertia, start, static_cast<int>(made->bodies.size()));
    rigid->setFriction(friction * model.friction);
    made->world->addRigidBody(rigid.get());
    // At rest: it sleeps until something touches it, and costs nothing before.
    if (!model.fixed) rigid->setActivationState(ISLAND_SLEEPING);
    made->bodies.push_back({&model, p.pose, start, std::move(rigid)});
  }
  now_ = std::move(made);
}

double BulletWorld::time_step_s() const { return time_step; }

void BulletWorld::step() {
  if (!now_) throw EngineError("Bullet: step() before reset()");
  if (grip_) pull_held();
  now_->world->stepSimulation(time_step, 0);  // 0: this very step, no clock that splits or skips
  for (const Body& b : now_->bodies)
    if (!is_finite(b.rigid->getWorldTransform())) throw EngineError("Bullet: a body's pose is not finite");
}

Pose BulletWorld::pose(int index) const {
  const Body& b = body(index);
  const btTransform& at = b.rigid->getWorldTransform();
  // What has not moved is where it was put, to the digit.
  return at == b.start ? b.placed : from_bullet(at * b.model->mass_frame.inverse());
}

std::optional<BodyPhysics> BulletWorld::physics(int index) const {
  const Body& b = body(index);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  btVector3 low(infinity, infinity, infinity), high = -low;
  for (const auto& piece : b.model->pieces)
    for (int i = 0; i < piece->getNumPoints(); ++i) {
      const btVector3 corner = b.rigid->getWorldTransform() * piece->getScaledPoint(i);
      low.setMin(corner);
      high.setMax(corner);
    }
  const double lightness = b.rigid->getInvMass();
  return BodyPhysics{from_bullet(low), from_bullet(high), lightness > 0 ? 1 / lightness : 0,
                     b.rigid->getFriction() * now_->table->getFriction()};
}

std::vector<Contact> BulletWorld::contacts() const {
  std::vector<Contact> found;
  if (!now_) return found;
  for (int i = 0; i < now_->dispatcher->getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *now_->dispatcher->getManifoldByIndexInternal(i);
    bool touch = false;
    for (int k = 0; k < manifold.getNumContacts(); ++k)
      touch = touch || manifold.getContactPoint(k).getDistance() < touch_m;
    const Contact pair{manifold.getBody0()->getUserIndex(), manifold.getBody1()->getUserIndex()};
    const auto same = [&](const Contact& o) { return o.a == pair.a && o.b == pair.b; };
    if (touch && std::none_of(found.begin(), found.end(), same)) found.push_back(pair);
  }
  return found;
}

int BulletWorld::cast_down(Vec2 point, double& height_m) const {
  int hit = no_body;
  height_m = 0;
  if (!now_) return hit;
  for (std::size_t i = 0; i < now_->bodies.size(); ++i) {
    const Body& b = now_->bodies[i];
    btVector3 low, high;
    b.rigid->getAabb(low, high);
    if (point.x < low.x() || point.x > high.x() || point.y < low.y() || point.y > high.y()) continue;
    for (const auto& piece : b.model->pieces) {
      const double top = top_at(*piece, b.rigid->getWorldTransform(), point);
      if (top <= height_m) continue;
      height_m = top;
      hit = static_cast<int>(i);
    }
  }
  return hit;
}

void BulletWorld::grip(int index, const Pose& gripper) {
  const Body& b = body(index);
  if (b.model->fixed) throw EngineError("Bullet: a fixed body cannot be gripped");
  release();
  const btTransform at = finite(gripper);
  grip_ = Grip{index, at.inverse() * b.rigid->getWorldTransform(), at};
  b.rigid->forceActivationState(DISABLE_DEACTIVATION);
  b.rigid->setGravity({0, 0, 0});
  b.rigid->setDamping(0, 0);
}

void BulletWorld::move_gripper(const Pose& gripper) {
  if (!grip_) throw EngineError("Bullet: the gripper moves only while it holds a body");
  grip_->target = finite(gripper);
}

void BulletWorld::release() {
  if (!grip_) return;
  btRigidBody& held = *body(grip_->body).rigid;
  held.forceActivationState(ACTIVE_TAG);
  held.setDeactivationTime(0);
  held.setGravity(gravity);
  held.setDamping(0, turning_lost_per_s);
  grip_.reset();
}

void BulletWorld::pull_held() {
  btRigidBody& held = *body(grip_->body).rigid;
  btVector3 linear, angular;
  btTransformUtil::calculateVelocity(held.getWorldTransform(), grip_->target * grip_->to_body, time_step, linear,
                                     angular);
  held.setLinearVelocity(at_most(most_pull_m_s, linear));
  held.setAngularVelocity(at_most(most_pull_rad_s, angular));
}

void BulletWorld::place_spatula(Vec3 size_m, const Pose& pose) {
  if (!now_) throw EngineError("Bullet: place_spatula() before reset()");
  const btTransform at = finite(pose);
  remove_spatula();
  now_->spatula_shape = std::make_unique<btBoxShape>(to_bullet(0.5 * size_m));
  now_->spatula_shape->initializePolyhedralFeatures();
  now_->spatula = make_body(0, now_->spatula_shape.get(), {0, 0, 0}, at, spatula_body);
  now_->spatula->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  now_->spatula->setActivationState(DISABLE_DEACTIVATION);
  now_->world->addRigidBody(now_->spatula.get());
}

void BulletWorld::move_spatula(const Pose& pose) {
  if (!now_ || !now_->spatula) throw EngineError("Bullet: the spatula moves only while it is placed");
  now_->spatula->setWorldTransform(finite(pose));
}

void BulletWorld::remove_spatula() {
  if (!now_ || !now_->spatula) return;
  now_->world->removeRigidBody(now_->spatula.get());
  now_->spatula.reset();
}

const BulletWorld::Body& BulletWorld::body(int index) const {
  const std::size_t placed = now_ ? now_->bodies.size() : 0;
  if (index < 0 || static_cast<std::size_t>(index) >= placed)
    throw EngineError(fmt::format("Bullet: no body {} among the {} placed", index, placed));
  return now_->bodies[static_cast<std::size_t>(index)];
}

}  // namespace lgabench

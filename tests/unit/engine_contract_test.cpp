// What check-plugin demands of an engine: the shipped ones keep it, and one with a fault is found out by its name.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include <lgabench/cell/engine_contract.hpp>

#include "../engine_under_test.hpp"
#include "../forwarding_world.hpp"

namespace lgabench {
namespace {

// Names of the checks that the world fails.
std::vector<std::string> failed(PhysicsWorld& world) {
  world.load(contract_bodies(), contract_bodies_at_once);
  std::vector<std::string> names;
  for (const ContractCheck& check : engine_contract()) try {
      if (!check.fault(world).empty()) names.push_back(check.name);
    } catch (const EngineError&) {
      names.push_back(check.name);
    }
  return names;
}

TEST(EngineContract, IsKeptByEveryEngineThatWasBuilt) {
  const Catalogue catalogue = scan_plugins(plugin_directories());
  for (const PluginInfo& plugin : catalogue.plugins) {
    if (plugin.kind != "engine") continue;
    EXPECT_EQ(failed(*load_engine(plugin)), std::vector<std::string>()) << plugin.id;
  }
}

struct OnAnEngine : ForwardingWorld {
  OnAnEngine() : ForwardingWorld(make_engine()) {}
};
struct Sinking : OnAnEngine {
  Pose pose(int body) const override {
    Pose pose = ForwardingWorld::pose(body);
    pose.position_m.z -= .002;
    return pose;
  }
};
struct Remembering : OnAnEngine {
  void reset(const std::vector<BodyPlacement>& placements) override {
    ForwardingWorld::reset(placements);
    ++scenes;
  }
  void step() override {
    ForwardingWorld::step();
    ++steps;
  }
  Pose pose(int body) const override {
    Pose pose = ForwardingWorld::pose(body);
    if (steps > 0) pose.position_m.x += 1e-9 * scenes;
    return pose;
  }
  int scenes = 0, steps = 0;
};
struct Lagging : OnAnEngine {
  void move_gripper(const Pose& gripper) override {
    Pose late = gripper;
    late.position_m.x -= .005;
    ForwardingWorld::move_gripper(late);
  }
};
struct Silent : OnAnEngine {
  std::vector<Contact> contacts() const override { return {}; }
};
struct Weak : OnAnEngine {
  void move_spatula(const Pose&) override {}
};
struct Blind : OnAnEngine {
  int cast_down(Vec2, double& height_m) const override {
    height_m = 0;
    return no_body;
  }
};
struct Tolerant : OnAnEngine {
  void move_gripper(const Pose& gripper) override {
    try {
      ForwardingWorld::move_gripper(gripper);
    } catch (const EngineError&) {
    }
  }
};
struct Coarse : OnAnEngine {
  double time_step_s() const override { return .05; }
};

template <class Faulty>
std::vector<std::string> failed_by() {
  Faulty world;
  return failed(world);
}

TEST(EngineContract, FindsAFaultByItsName) {
  using Names = std::vector<std::string>;
  const auto holds = [](const Names& names, const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  EXPECT_TRUE(holds(failed_by<Sinking>(), "rest"));
  EXPECT_TRUE(holds(failed_by<Remembering>(), "reset"));
  EXPECT_TRUE(holds(failed_by<Lagging>(), "suction"));
  EXPECT_TRUE(holds(failed_by<Silent>(), "contacts"));
  EXPECT_TRUE(holds(failed_by<Weak>(), "spatula"));
  EXPECT_EQ(failed_by<Blind>(), Names{"rays"});
  EXPECT_EQ(failed_by<Tolerant>(), Names{"errors"});
  EXPECT_TRUE(holds(failed_by<Coarse>(), "time step"));
}

}  // namespace
}  // namespace lgabench

// A whole episode, a reset and a picture.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <map>

#include <common/objects.hpp>
#include <lgabench/abstraction/repaint.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/environment.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/harness/suite_scenario.hpp>
#include <lgabench/plugin/loader.hpp>
#include <mobile/renderer.hpp>
#include <mobile/sampler.hpp>
#include <mujoco/mujoco_world.hpp>
#include <tabletop/renderer.hpp>
#include <tabletop/sampler.hpp>
#include <tabletop/tabletop.hpp>
#include <tabletop/task.hpp>

#include "../forwarding_world.hpp"
#include "bare_mujoco.hpp"
#include "benchmarks.hpp"

namespace lgabench {
namespace {

constexpr int scenes = 10;

// The engine, which remembers what it was asked for.
class Recorder final : public ForwardingWorld {
 public:
  Recorder() : ForwardingWorld(std::make_unique<MujocoWorld>()) {}
  void load(const std::vector<BodyModel>& models, int bodies) override {
    ForwardingWorld::load(known = models, bodies);
  }
  void reset(const std::vector<BodyPlacement>& placements) override {
    ForwardingWorld::reset(placed = placements);
    frames.clear();
    now_ = {};
  }
  void step() override {
    ForwardingWorld::step();
    frames.push_back(now_);
  }
  void grip(int body, const Pose& gripper) override {
    now_ = {body, gripper, pose(body), gripper};
    ForwardingWorld::grip(body, gripper);
  }
  void move_gripper(const Pose& gripper) override { ForwardingWorld::move_gripper(now_.gripper = gripper); }
  void release() override {
    now_.held = no_body;
    ForwardingWorld::release();
  }

  std::vector<BodyModel> known;
  std::vector<BodyPlacement> placed;
  std::vector<GripperFrame> frames;

 private:
  GripperFrame now_;
};

// Ten test scenes of a scenario, the oracle's actions on them, and what the engine was asked for.
struct Played {
  struct Episode {
    Scene scene;
    tabletop::TwoPoses action;
    std::vector<BodyPlacement> placed;
    std::vector<GripperFrame> frames;
    std::unique_ptr<BareMujoco> bare;
  };
  std::unique_ptr<Environment> environment;
  std::unique_ptr<MujocoWorld> world;  // for resets without pictures
  std::vector<Episode> episodes;
};

Played& played(const std::string& name) {
  static std::map<std::string, Played> all;
  const auto found = all.find(name);
  if (found != all.end()) return found->second;
  Played& played = all[name];
  const Scenario scenario = load_scenario(name);
  played.environment = tabletop::make_environment(std::make_unique<MujocoWorld>(), scenario.space);
  auto owned = std::make_unique<Recorder>();
  Recorder& recorder = *owned;
  const auto recorded = tabletop::make_environment(std::move(owned), scenario.space);
  for (int i = 0; i < scenes; ++i) {
    const Scene scene = tabletop::sample_scene(scenario, {"cells", "test", "test", 0}, i);
    recorded->reset(scene);
    const Action action = recorded->expert_action();
    recorded->step(action);
    played.episodes.push_back({scene, action, recorder.placed, recorder.frames,
                               std::make_unique<BareMujoco>(recorder.known, recorder.placed)});
  }
  played.world = std::make_unique<MujocoWorld>();
  played.world->load(recorder.known, tabletop::most_bodies);
  return played;
}

// Calls each(episode) once an iteration, the ten in turn.
template <class Each>
void over_episodes(benchmark::State& state, const char* scenario, const Each& each) {
  Played& p = played(scenario);
  std::size_t i = 0;
  for (auto _ : state) each(p, p.episodes[i++ % p.episodes.size()]);
  state.SetItemsProcessed(state.iterations());
}

void episode(benchmark::State& state, const char* scenario) {
  over_episodes(state, scenario, [](Played& p, const Played::Episode& e) {
    benchmark::DoNotOptimize(p.environment->reset(e.scene));
    benchmark::DoNotOptimize(p.environment->step(e.action));
  });
}

void bare_episode(benchmark::State& state, const char* scenario) {
  double steps = 0;
  over_episodes(state, scenario, [&steps](Played&, const Played::Episode& e) {
    e.bare->reset();
    e.bare->play(e.frames);
    steps += static_cast<double>(e.frames.size());
  });
  state.counters["steps"] = steps / static_cast<double>(state.iterations());
}

void reset(benchmark::State& state) {
  over_episodes(state, "heart", [](Played& p, const Played::Episode& e) { p.world->reset(e.placed); });
}
void bare_reset(benchmark::State& state) {
  over_episodes(state, "heart", [](Played&, const Played::Episode& e) { e.bare->reset(); });
}

void picture(benchmark::State& state) {
  tabletop::Renderer renderer;
  over_episodes(state, "heart", [&renderer](Played&, const Played::Episode& e) {
    benchmark::DoNotOptimize(
        renderer.render(tabletop::visible_objects(e.scene), tabletop::find_task(e.scene.task).ground()));
  });
}

// Near misses of the suite clutter, as many as the arm says, on an engine's own world.
void crowd(benchmark::State& state, const PluginInfo& engine, const std::string& arm) {
  const Scenario scenario = suite_scenario(load_suite("clutter"), "heart", Truth::released);
  const auto environment = make_environment(scenario, load_engine(engine));
  std::vector<std::pair<Scene, Action>> all;
  for (int i = 0; i < scenes; ++i) {
    const Scene scene = test_scene(scenario, "continuous", arm, 0, i);
    environment->reset(scene);
    all.emplace_back(scene, environment->expert_action());
  }
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& [scene, action] = all[i++ % all.size()];
    benchmark::DoNotOptimize(environment->reset(scene));
    benchmark::DoNotOptimize(environment->step(action));
  }
  state.SetItemsProcessed(state.iterations());
}

// A table with six objects, 480 x 640.
void mobile_picture(benchmark::State& state) {
  const Scene scene = mobile::sample_scene(load_scenario("bring_fruit"), {mobile::layout, "test", "crowd", 0}, 0);
  const auto objects = mobile::visible_objects(scene);
  mobile::Renderer renderer(mobile::front_camera());
  for (auto _ : state) benchmark::DoNotOptimize(renderer.render(objects));
}

// A scene of the tabletop, with its shadows.
Observation shaded() {
  const Scene scene = training_scene(load_scenario("heart"), "continuous", {}, 0, 0);
  return tabletop::Renderer().render(tabletop::visible_objects(scene), tabletop::Ground::plain, {}, true);
}

// What repaint() is given is a copy too.
void copied(benchmark::State& state) {
  const Observation seen = shaded();
  for (auto _ : state) {
    Observation copy = seen;
    benchmark::DoNotOptimize(copy);
  }
}

void erased(benchmark::State& state) {
  const Observation seen = shaded();
  const Background empty{seen.rgb};
  const Ids all = unselected(seen, {});
  for (auto _ : state) benchmark::DoNotOptimize(repaint(seen, all, empty));
}

}  // namespace

BareMujoco& first_scene() { return *played("heart").episodes[0].bare; }

void register_environment() {
  for (const char* scenario : {"heart", "rotate_block"}) {
    benchmark::RegisterBenchmark((std::string("episode/") + scenario).c_str(), episode, scenario);
    benchmark::RegisterBenchmark((std::string("episode/") + scenario + "/bare").c_str(), bare_episode, scenario);
  }
  benchmark::RegisterBenchmark("episode/sweep_block_without_touching_pan", episode, "sweep_block_without_touching_pan");
  for (const PluginInfo& plugin : scan_plugins(plugin_directories()).plugins)
    if (plugin.kind == "engine")
      for (const char* arm : {"near_2", "near_6"})
        benchmark::RegisterBenchmark(fmt::format("crowd/{}/{}", plugin.id, arm).c_str(),
                                     [plugin, arm](benchmark::State& state) { crowd(state, plugin, arm); });
  benchmark::RegisterBenchmark("reset", reset);
  benchmark::RegisterBenchmark("reset/bare", bare_reset);
  benchmark::RegisterBenchmark("picture", picture);
  benchmark::RegisterBenchmark("repaint", erased);
  benchmark::RegisterBenchmark("repaint/copy", copied);
  benchmark::RegisterBenchmark("picture/mobile", mobile_picture);
}

}  // namespace lgabench

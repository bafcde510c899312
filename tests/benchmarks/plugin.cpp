// A policy's act() behind the plugin interface, the same code linked in, and in a process of its own; what that process
// costs a cell.
#include <benchmark/benchmark.h>

#include <lgabench/abstraction/human.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/core/scratch.hpp>
#include <lgabench/host/hosted_method.hpp>
#include <lgabench/host/messages.hpp>
#include <lgabench/plugin/loader.hpp>
#include <tabletop/renderer.hpp>
#include <tabletop/sampler.hpp>
#include <tabletop/two_poses.hpp>

#include "../../plugins/lga.cpp"
#include "benchmarks.hpp"

namespace lgabench {
namespace {

struct Silent : TrainingLog {
  void epoch(int, long long, double) override {}
};

PluginInfo lga_plugin() { return scan_plugins(plugin_directories()).find("method", "lga"); }

Json one_epoch() { return resolve_options(lga_plugin(), {{"epochs", 1}}); }

Observation seen(const Scene& scene) { return tabletop::Renderer().render(tabletop::visible_objects(scene)); }

Scene training_scene(const Scenario& scenario, int index) {
  return tabletop::sample_scene(scenario, {"cells", "train", "train", 0}, index);
}

// A process of its own for the method, as a run gives it one.
struct Hosted {
  Scratch scratch{"benchmark"};
  std::unique_ptr<HostedMethod> method =
      std::make_unique<HostedMethod>(HostJob{lga_plugin(), "tabletop", one_epoch(), 0, scratch.path});
};

// A policy that was trained for a moment, and what it is asked.
class Trained {
 public:
  explicit Trained(std::unique_ptr<Method> method) : method_(std::move(method)) {
    const Scenario scenario = load_scenario("heart");
    RecordedLanguageModel lm(scenario, scenario.recorded);
    TruthAsHuman human(scenario.commands);
    Silent log;
    Services services{lm, human, one_epoch(), 0, log, tabletop::two_poses()};
    const Scene scene = training_scene(scenario, 0);
    observation_ = seen(scene);
    const Command command = scenario.command(scene.command);
    instruction_ = {command.utterance, method_->select(command, scenario.space, services)};
    policy_ = method_->learn({{instruction_, {{observation_, tabletop::TwoPoses{}}}}}, services);
  }
  Action act() { return policy_->act(observation_, instruction_); }

 private:
  std::unique_ptr<Method> method_;
  std::unique_ptr<Policy> policy_;
  Observation observation_;
  Instruction instruction_;
};

void act(benchmark::State& state, std::unique_ptr<Method> method) {
  Trained trained(std::move(method));
  for (auto _ : state) benchmark::DoNotOptimize(trained.act());
}

void act_hosted(benchmark::State& state) {
  Hosted hosted;  // its directory outlives the process
  act(state, std::move(hosted.method));
}

// From nothing to an orderly end: fork, confinement, loading of the plugin and its libraries.
void start(benchmark::State& state) {
  for (auto _ : state) Hosted().method->end();
}

// Fifty of them, written to shared memory as the worker does and read as the host does.
void demonstrations(benchmark::State& state) {
  const Scenario scenario = load_scenario("heart");
  std::vector<Demonstration> all;
  for (int i = 0; i < 50; ++i) all.push_back({{}, {{seen(training_scene(scenario, i)), tabletop::TwoPoses{}}}});
  const host::Layout layout{tabletop::Workspace::picture, tabletop::two_poses()};
  std::size_t bytes = 0;
  for (auto _ : state) {
    const host::DemonstrationFile packed = host::pack(layout, all);
    benchmark::DoNotOptimize(host::unpack(layout, JsonReader(packed.header, "learn"), packed.file));
    bytes = packed.size;
  }
  state.counters["bytes"] = static_cast<double>(bytes);
}

}  // namespace

void register_plugin() {
  benchmark::RegisterBenchmark("act/plugin", [](benchmark::State& state) { act(state, load_method(lga_plugin())); });
  benchmark::RegisterBenchmark("act/linked", [](benchmark::State& state) { act(state, std::make_unique<Lga>()); });
  benchmark::RegisterBenchmark("act/hosted", act_hosted)->UseRealTime();
  benchmark::RegisterBenchmark("host/start", start)->UseRealTime();
  benchmark::RegisterBenchmark("host/demonstrations", demonstrations)->UseRealTime();
}

}  // namespace lgabench

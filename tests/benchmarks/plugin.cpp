// A policy's act() behind the plugin interface, and the same code linked in.
#include <benchmark/benchmark.h>

#include <lgabench/abstraction/human.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/plugin/loader.hpp>
#include <tabletop/renderer.hpp>
#include <tabletop/sampler.hpp>

#include "../../plugins/lga.cpp"
#include "benchmarks.hpp"

namespace lgabench {
namespace {

struct Silent : TrainingLog {
  void epoch(int, long long, double) override {}
};

// A policy that was trained for a moment, and what it is asked.
class Asked {
 public:
  explicit Asked(std::unique_ptr<Method> method) : method_(std::move(method)) {
    const Scenario scenario = load_scenario("heart");
    RecordedLanguageModel lm(scenario, scenario.recorded);
    TruthAsHuman human(scenario.commands);
    Silent log;
    Services services{lm, human, options(), 0, log};
    const Scene scene = tabletop::sample_scene(scenario, {"cells", "train", "train", 0}, 0);
    observation_ = tabletop::Renderer().render(tabletop::visible_objects(scene), tabletop::ground_of(scene));
    const Command command = scenario.command(scene.command);
    instruction_ = {command.utterance, method_->select(command, scenario.space, services)};
    policy_ = method_->learn({{instruction_, {{observation_, {}}}}}, services);
  }
  Action act() { return policy_->act(observation_, instruction_); }

 private:
  static Json options() {
    return resolve_options(scan_plugins(plugin_directories()).find("method", "lga"), {{"epochs", 1}});
  }
  std::unique_ptr<Method> method_;
  std::unique_ptr<Policy> policy_;
  Observation observation_;
  Instruction instruction_;
};

void act(benchmark::State& state, bool plugin) {
  Asked asked(plugin ? load_method(scan_plugins(plugin_directories()).find("method", "lga"))
                     : std::unique_ptr<Method>(std::make_unique<Lga>()));
  for (auto _ : state) benchmark::DoNotOptimize(asked.act());
}

}  // namespace

void register_plugin() {
  benchmark::RegisterBenchmark("act/plugin", act, true);
  benchmark::RegisterBenchmark("act/linked", act, false);
}

}  // namespace lgabench

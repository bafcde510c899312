#include <lgabench/cell/bench.hpp>

#include <utility>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/environments.hpp>

namespace lgabench {

Bench::Bench(Scenario played, const std::optional<PluginInfo>& engine)
    : scenario(std::move(played)), layout(layouts_of(scenario).front()) {
  constexpr int scenes_an_arm = 5;
  environment = make_environment(scenario, load_engine(engine));
  for (const Arm& arm : scenario.tests)
    for (int i = 0; i < scenes_an_arm; ++i) {
      const Scene scene = test_scene(scenario, layout, arm.id, seed, i);
      sights.push_back({scene, environment->reset(scene)});
    }
}

void Bench::look_again(const Needs& needs) {
  environment->show_shadows(needs.shadows);
  for (Sight& sight : sights) sight.observation = environment->reset(sight.scene);
}

}  // namespace lgabench

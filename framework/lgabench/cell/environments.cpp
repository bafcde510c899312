#include <lgabench/cell/environments.hpp>

#include <lgabench/core/environments.hpp>

namespace lgabench {
std::unique_ptr<Environment> make_environment(const Scenario& scenario, std::unique_ptr<PhysicsWorld> world) {
  return find_environment(scenario.environment).make(std::move(world), scenario);
}

Scene training_scene(const Scenario& scenario, const std::string& layout, const std::vector<Selection>& selections,
                     std::uint64_t training_seed, int index) {
  return find_environment(scenario.environment)
      .sample(scenario, {layout, "train", "train", training_seed, selections}, index);
}

Scene test_scene(const Scenario& scenario, const std::string& layout, const std::string& arm, std::uint64_t scene_seed,
                 int index, std::optional<std::uint64_t> training_seed) {
  return find_environment(scenario.environment)
      .sample(scenario, {layout, "test", arm, scene_seed, {}, training_seed}, index);
}

}  // namespace lgabench

#include <lgabench/cell/environments.hpp>

#include <fmt/format.h>

#include <tabletop/sampler.hpp>
#include <tabletop/tabletop.hpp>

namespace lgabench {
namespace {

void expect_tabletop(const Scenario& scenario) {
  if (scenario.environment != "tabletop")
    throw InputError(
        fmt::format("scenario {}: /environment: expected \"tabletop\", got \"{}\"", scenario.id, scenario.environment));
}

}  // namespace

std::unique_ptr<Environment> make_environment(const Scenario& scenario, std::unique_ptr<PhysicsWorld> world) {
  expect_tabletop(scenario);
  return tabletop::make_environment(std::move(world), scenario.space);
}

Scene training_scene(const Scenario& scenario, const std::string& layout, const std::vector<Selection>& selections,
                     std::uint64_t training_seed, int index) {
  expect_tabletop(scenario);
  return tabletop::sample_scene(scenario, {layout, "train", "train", training_seed, selections}, index);
}

Scene test_scene(const Scenario& scenario, const std::string& layout, const std::string& arm, std::uint64_t scene_seed,
                 int index, std::optional<std::uint64_t> training_seed) {
  expect_tabletop(scenario);
  return tabletop::sample_scene(scenario, {layout, "test", arm, scene_seed, {}, training_seed}, index);
}

}  // namespace lgabench

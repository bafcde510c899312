// What a demonstration takes, in every task, against what the oracle was told to take.
#include <algorithm>
#include <map>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/stations.hpp>
#include <lgabench/plugin/loader.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

TEST(Taken, IsTheOraclesTargetInEveryTask) {
  constexpr int scenes = 4;
  const Catalogue catalogue = scan_plugins(plugin_directories());
  std::map<std::string, int> tasks;
  for (const std::string& id : scenario_ids()) {
    const Scenario scenario = load_scenario(id);
    // Nothing moves, and this engine takes no time to load a scene.
    const auto environment = make_environment(scenario, load_engine(catalogue.find("engine", "kinematic")));
    for (const std::string& layout : layouts_of(scenario)) try {
        for (int i = 0; i < scenes; ++i) {
          const Scene scene = training_scene(scenario, layout, {}, 7, i);
          const Observation seen = environment->reset(scene);
          const Action label = environment->expert_action();
          const auto found = taken({{}, {{seen, label}}}, environment->action_space());
          if (scene.find("target") == nullptr) {
            EXPECT_TRUE(label.empty() && !found) << id << ": nothing that is meant is there";
            continue;
          }
          const bool targets =
              std::any_of(scene.objects.begin(), scene.objects.end(), [&found](const SceneObject& one) {
                return found == one.instance_id && one.role == "target";  // in an errand several are wanted at first
              });
          EXPECT_TRUE(targets) << id << " " << layout << " " << i;
          const SceneObject* const receiver = scene.find("receiver");
          EXPECT_EQ(receiving({seen, label}, actions_of(scenario)),
                    receiver ? std::optional(receiver->instance_id) : std::nullopt)
              << id << " " << i;
          EXPECT_FALSE(taken(Step{seen, {}}, actions_of(scenario)) || receiving({seen, {}}, actions_of(scenario)));
          ++tasks[scenario.task];
        }
      } catch (const NothingToShow&) {  // what is too wide for this layout
      }
  }
  for (const TaskInfo& task : installed_tasks()) EXPECT_GE(tasks[task.id], scenes) << task.id;
}

}  // namespace
}  // namespace lgabench

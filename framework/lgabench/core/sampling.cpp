#include <lgabench/core/sampling.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/error.hpp>

namespace lgabench {

Scene without_objects(const Scenario& scenario, const SceneRequest& request, int index) {
  const auto& split = request.split;
  if (split != "train" && split != "dev" && split != "test")
    throw InputError(fmt::format("split \"{}\": expected train, dev or test", split));
  if (request.training_seed && split != "test") throw InputError("a training seed's own scenes: expected split test");
  if (index < 0) throw InputError(fmt::format("scene index {}: expected 0 or more", index));
  const std::vector<int> commands = scenario.commands_of(request.arm);
  Scene scene{scenario.id, request.arm, request.layout, split, scenario.task, {}, request.seed, index, 0, {}};
  scene.command = commands[static_cast<std::size_t>(index) % commands.size()];
  return scene;
}

std::string stream_name(const std::string& scenario, const SceneRequest& request, int index) {
  return fmt::format("scene/{}/{}/{}/{}{}/{}/", scenario, request.layout, request.split, request.seed,
                     own_stream(request.training_seed), index);
}

Streams streams_of(const Scenario& scenario, const SceneRequest& request, int index) {
  return streams_of(scenario.id, request, index);
}

Streams streams_of(const std::string& scenario, const SceneRequest& request, int index) {
  const std::string scene = stream_name(scenario, request, index);
  return [scene](const std::string& purpose) { return RandomStream(scene + purpose); };
}

const std::string& any_of(const std::vector<std::string>& names, RandomStream& random) {
  return names[random.below(static_cast<std::uint32_t>(names.size()))];
}

void permute_ids(std::vector<SceneObject>& objects, RandomStream random) {
  const auto order = random.permutation(static_cast<int>(objects.size()));
  for (std::size_t i = 0; i < objects.size(); ++i) objects[i].instance_id = static_cast<std::uint8_t>(order[i] + 1);
  std::sort(objects.begin(), objects.end(), [](const auto& a, const auto& b) { return a.instance_id < b.instance_id; });
}

}  // namespace lgabench

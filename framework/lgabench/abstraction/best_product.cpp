#include <lgabench/abstraction/best_product.hpp>

#include <algorithm>
#include <map>
#include <vector>

#include <lgabench/abstraction/scenes.hpp>

namespace lgabench {
namespace {

constexpr std::uint64_t training_seed = 1000003;

struct Placed {
  std::size_t type, texture;
  bool meant;
};
using Seen = std::vector<Placed>;  // what stands on it

struct Kept {
  std::vector<char> types, textures;

  bool exactly(const Seen& scene) const {
    return std::all_of(scene.begin(), scene.end(),
                       [this](const Placed& one) { return (types[one.type] && textures[one.texture]) == one.meant; });
  }
  auto won(const std::vector<Seen>& scenes) const {
    return std::count_if(scenes.begin(), scenes.end(), [this](const Seen& scene) { return exactly(scene); });
  }
};

std::size_t place_of(const std::string& name, const std::vector<std::string>& names) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

std::vector<Seen> training_scenes(const Scenario& scenario, int command, const std::string& layout, int count) {
  std::vector<Selection> truths;
  for (const ScenarioCommand& one : scenario.commands) truths.push_back(one.truth);
  std::vector<Seen> scenes;
  for (int i = 0; i < count; ++i) {
    const Scene drawn = training_scene(scenario, layout, truths, training_seed, i);
    if (drawn.command != command) continue;
    Seen& scene = scenes.emplace_back();
    for (const SceneObject& object : drawn.objects)
      if (!is_place(object.object_type))
        scene.push_back({place_of(object.object_type, scenario.space.object_types),
                         place_of(object.texture, scenario.space.textures), object.role == role::target});
  }
  return scenes;
}

std::vector<std::string> names_of(const std::vector<char>& kept, const std::vector<std::string>& names) {
  std::vector<std::string> some;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (kept[i]) some.push_back(names[i]);
  return some;
}

}  // namespace

FeatureSet best_product(const Scenario& scenario, int command, const std::string& layout, int count) {
  const std::vector<Seen> scenes = training_scenes(scenario, command, layout, count);
  const FeatureSpace& space = scenario.space;
  Kept kept{std::vector<char>(space.object_types.size()), std::vector<char>(space.textures.size())};
  for (const FeatureSet& set : scenario.commands[static_cast<std::size_t>(command)].truth.target.sets) {
    for (const std::string& type : set.object_types) kept.types[place_of(type, space.object_types)] = 1;
    for (const std::string& texture : set.textures) kept.textures[place_of(texture, space.textures)] = 1;
  }
  auto won = kept.won(scenes);
  for (bool better = true; better;) {
    better = false;
    for (std::vector<char>* names : {&kept.types, &kept.textures})
      for (char& name : *names) {
        name = !name;
        const auto changed = kept.won(scenes);
        if (changed > won) {
          won = changed;
          better = true;
        } else {
          name = !name;
        }
      }
  }
  return {names_of(kept.types, space.object_types), names_of(kept.textures, space.textures)};
}

}  // namespace lgabench

#include <lgabench/abstraction/best_product.hpp>

#include <algorithm>
#include <utility>
#include <vector>

#include <lgabench/abstraction/scenes.hpp>

namespace lgabench {
namespace {

constexpr std::uint64_t training_seed = 1000003;

struct InView {
  std::size_t type, texture;
  bool meant;
};
using Seen = std::vector<InView>;  // a scene's objects, but for places

struct Kept {
  std::vector<char> types, textures;

  bool exactly(const Seen& scene) const {
    return std::all_of(scene.begin(), scene.end(),
                       [this](const InView& one) { return (types[one.type] && textures[one.texture]) == one.meant; });
  }
  auto won(const std::vector<Seen>& scenes) const {
    return std::count_if(scenes.begin(), scenes.end(), [this](const Seen& scene) { return exactly(scene); });
  }
};

std::size_t place_of(const std::string& name, const std::vector<std::string>& names) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

// By command.
std::vector<std::vector<Seen>> training_scenes(const Scenario& scenario, const std::string& layout, int count) {
  std::vector<std::vector<Seen>> scenes(scenario.commands.size());
  for (int i = 0; i < count; ++i) {
    const Scene drawn = training_scene(scenario, layout, {}, training_seed, i);
    Seen& scene = scenes.at(static_cast<std::size_t>(drawn.command)).emplace_back();
    const std::vector<bool> meant = meant_at_first(drawn);
    for (std::size_t k = 0; k < meant.size(); ++k)
      if (const SceneObject& object = drawn.objects[k]; !is_place(object.object_type))
        scene.push_back({place_of(object.object_type, scenario.space.object_types),
                         place_of(object.texture, scenario.space.textures), meant[k]});
  }
  return scenes;
}

std::vector<std::string> names_of(const std::vector<char>& kept, const std::vector<std::string>& names) {
  std::vector<std::string> some;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (kept[i]) some.push_back(names[i]);
  return some;
}

FeatureSet best_product(const Meaning& truth, const FeatureSpace& space, const std::vector<Seen>& scenes) {
  Kept kept{std::vector<char>(space.object_types.size()), std::vector<char>(space.textures.size())};
  for (const FeatureSet& set : truth.sets) {
    for (const std::string& type : set.object_types) kept.types[place_of(type, space.object_types)] = 1;
    for (const std::string& texture : set.textures) kept.textures[place_of(texture, space.textures)] = 1;
  }
  auto won = kept.won(scenes);
  for (bool better = true; better;) {
    better = false;
    for (std::vector<char>* names : {&kept.types, &kept.textures})
      for (char& name : *names) {
        const char before = std::exchange(name, name == 0 ? 1 : 0);
        const auto changed = kept.won(scenes);
        if (changed > won) {
          won = changed;
          better = true;
        } else {
          name = before;
        }
      }
  }
  return {names_of(kept.types, space.object_types), names_of(kept.textures, space.textures)};
}

}  // namespace

std::vector<FeatureSet> best_products(const Scenario& scenario, const std::string& layout, int scenes,
                                      const std::function<void()>& found) {
  const std::vector<std::vector<Seen>> by_command = training_scenes(scenario, layout, scenes);
  std::vector<FeatureSet> best;
  for (std::size_t i = 0; i < by_command.size(); ++i) {
    best.push_back(best_product(scenario.commands[i].truth.target, scenario.space, by_command[i]));
    found();
  }
  return best;
}

}  // namespace lgabench

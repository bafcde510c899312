#include <common/changed.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include <lgabench/core/environments.hpp>

namespace lgabench::common {

BodyModel varied(BodyModel body, const BodyVariant& variant) {
  body.mass_kg *= variant.mass;
  body.friction *= variant.friction;
  return body;
}

Scene resized(Scene scene, double scale, const std::function<bool(const SceneObject&)>& movable) {
  for (SceneObject& object : scene.objects)
    if (movable(object)) object.scale *= scale;
  return scene;
}

Scene with_larger_target(Scene scene, const std::vector<double>& scales,
                         const std::function<bool(const Scene&, std::size_t target)>& fits) {
  const auto found = std::find_if(scene.objects.begin(), scene.objects.end(),
                                  [](const SceneObject& o) { return o.role == role::target; });
  if (found == scene.objects.end()) return scene;
  const auto target = static_cast<std::size_t>(found - scene.objects.begin());
  for (const double scale : scales) {
    Scene larger = scene;
    larger.objects[target].scale = scale;
    if (!fits(larger, target)) break;
    scene = std::move(larger);
  }
  return scene;
}

Scene with_more(const Scene& scene, int count, RandomStream& random, const Adding& adding) {
  constexpr int draws = 60;
  const std::vector<int> order = random.permutation(static_cast<int>(scene.objects.size()) + most_added);
  std::vector<SceneObject> objects = scene.objects;
  std::stable_partition(objects.begin(), objects.end(), [](const SceneObject& o) { return o.role == role::target; });
  std::vector<SceneObject> all = scene.objects;
  for (int draw = 0; count > 0; ++draw) {
    if (draw == draws)
      throw NothingToShow(fmt::format("scenario \"{}\", layout {}: no room for {} more distractors in scene {}",
                                      scene.scenario, scene.layout, count, scene.index));
    const std::optional<SceneObject> one = adding.draw(objects, draw);
    if (!one) continue;
    objects.push_back(*one);
    if (!adding.place(objects)) {
      objects.pop_back();
      continue;
    }
    all.push_back(objects.back());
    --count;
  }

  std::vector<std::size_t> indices(all.size());
  std::iota(indices.begin(), indices.end(), 0);
  std::sort(indices.begin(), indices.end(), [&order](std::size_t a, std::size_t b) { return order[a] < order[b]; });
  Scene fuller = scene;
  fuller.objects.clear();
  for (const std::size_t i : indices) {
    fuller.objects.push_back(all[i]);
    fuller.objects.back().instance_id = static_cast<std::uint8_t>(fuller.objects.size());
  }
  return fuller;
}

}  // namespace lgabench::common

// Another table. The levels are kinds, not sizes: the last hides an object by its own texture, the others hide none.
#include <lgabench/core/perturbations.hpp>

#include <algorithm>

namespace lgabench::perturbations {
namespace {

using Names = std::vector<std::string>;

// From a place that is drawn on, the first that is no part of an object's texture.
std::string unlike_objects(const Names& looks, const Scene& scene, RandomStream stream) {
  const auto shared = [&scene](const std::string& look) {
    return std::any_of(scene.objects.begin(), scene.objects.end(),
                       [&look](const SceneObject& o) { return o.texture.find(look) != std::string::npos; });
  };
  Names from = looks;
  std::rotate(from.begin(), from.begin() + stream.below(static_cast<std::uint32_t>(from.size())), from.end());
  const auto found = std::find_if_not(from.begin(), from.end(), shared);
  return found == from.end() ? from.front() : *found;
}

}  // namespace

PerturbationAxis table() {
  PerturbationAxis axis{
      "table", {"another colour", "a grain", "another pattern", "an object's texture"}, {EpisodePart::rgb}};
  axis.named = true;
  axis.look = [](View& view, const Scene& scene, int level, RandomStream stream) {
    static const std::array<Names, 3> looks{Names{"blue", "cyan", "green", "olive", "orange", "pink", "purple"},
                                            Names{"wooden", "granite"},
                                            Names{"tiles", "brick", "checkerboard", "polka dot"}};
    const auto at = static_cast<std::size_t>(level - 1);
    view.table = at < looks.size()
                     ? unlike_objects(looks.at(at), scene, stream)
                     : scene.objects[stream.below(static_cast<std::uint32_t>(scene.objects.size()))].texture;
  };
  return axis;
}

}  // namespace lgabench::perturbations

// Draws pictures of every object type with every texture and grows the reader's forests on them: readers/*.forest,
// which are shipped. A seed of its own: no suite has these scenes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <lgabench/core/feature_space.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/sampling.hpp>
#include <opencv2/imgproc.hpp>
#include <readers/features.hpp>
#include <readers/grow.hpp>
#include <readers/reader.hpp>
#include <tabletop/placement.hpp>
#include <tabletop/renderer.hpp>

namespace lgabench::tabletop {
namespace {

using Pair = std::pair<int, int>;  // object type, texture

// A table with the goal and some of them; takes those that found a place.
Scene table_with(std::vector<Pair>& pairs, const FeatureSpace& space, RandomStream& random) {
  constexpr int most = 6;
  const Room none = [](const SceneObject&) { return std::vector<Polygon>(); };
  Scene scene;
  scene.objects.push_back({goal_type, goal_texture, role::goal, {.5, .3}, 0, 1, 1});
  for (int tried = 0; tried < most && !pairs.empty(); ++tried) {
    const auto [type, texture] = pairs.back();
    scene.objects.push_back({space.object_types[static_cast<std::size_t>(type)],
                             space.textures[static_cast<std::size_t>(texture)],
                             role::distractor,
                             {},
                             0,
                             static_cast<std::uint8_t>(scene.objects.size() + 1),
                             1});
    if (place_last(none, scene.objects, random))
      pairs.pop_back();
    else
      scene.objects.pop_back();
  }
  return scene;
}

// Another camera, some of the light, noise and blur.
View drawn_view(RandomStream& random) {
  View view;
  view.zoom = std::exp(random.uniform(std::log(.8), std::log(1.25)));
  view.turn_rad = {random.uniform(-.14, .14), 0};
  return view;
}
void draw_light(Observation& seen, RandomStream& random) {
  const double brightness = random.uniform(.85, 1.15);
  double gains[3];
  for (double& gain : gains) gain = brightness * random.uniform(.95, 1.05);
  const double noise = random.coin() ? random.uniform(0, .1) : 0, blur = random.coin() ? random.uniform(.3, 2) : 0;
  for (std::size_t i = 0; i < seen.rgb.size(); ++i)
    seen.rgb[i] = static_cast<std::uint8_t>(std::lround(std::min(255., seen.rgb[i] * gains[i % 3])));
  cv::Mat rgb(seen.size.rows, seen.size.columns, CV_8UC3, seen.rgb.data());
  if (blur > 0) cv::GaussianBlur(rgb, rgb, cv::Size(), blur);
  if (noise > 0)
    for (std::uint8_t& value : seen.rgb)
      value = static_cast<std::uint8_t>(std::lround(std::clamp(value + 255 * noise * random.gaussian(), 0., 255.)));
}

int number(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

// Of each pair so many crops; `drawn`: in drawn light, noise, blur and distance.
seeing::Model taught(const FeatureSpace& space, std::size_t crops, bool drawn) {
  RandomStream random(fmt::format("reader/{}/{}", space.id, drawn));
  std::vector<Pair> pairs;
  for (int type = 0; type < static_cast<int>(space.object_types.size()); ++type)
    for (int texture = 0; texture < static_cast<int>(space.textures.size()); ++texture)
      pairs.insert(pairs.end(), crops, {type, texture});
  std::vector<Pair> left;
  for (const int i : random.permutation(static_cast<int>(pairs.size())))
    left.push_back(pairs[static_cast<std::size_t>(i)]);

  constexpr int goal_seldom = 16;  // it stands in every scene
  Renderer renderer;
  seeing::Examples types, textures;
  while (!left.empty()) {
    const Scene scene = table_with(left, space, random);
    Observation seen = renderer.render(visible_objects(scene), Ground::plain, drawn ? drawn_view(random) : View());
    if (drawn) draw_light(seen, random);
    const seeing::Picture picture(seen);
    for (const Instance& one : seen.instances) {
      if (one.pixels == 0 || (one.id == 1 && random.below(goal_seldom) != 0)) continue;
      types.rows.push_back(seeing::shape_features(picture, one.id));
      types.classes.push_back(number(space.object_types, one.object_type));
      textures.rows.push_back(seeing::surface_features(picture, one.id));
      textures.classes.push_back(number(space.textures, one.texture));
    }
  }
  constexpr std::uint64_t seed = 52;
  constexpr int tried = 40;  // most bins of colours are empty
  return {seeing::grown(types, space.object_types, {}, seed),
          seeing::grown(textures, space.textures, {seeing::ForestSize().trees, tried}, seed)};
}

}  // namespace
}  // namespace lgabench::tabletop

// Writes DIRECTORY/plain.forest and drawn.forest, in a minute.
int main(int count, char** arguments) {
  using namespace lgabench;
  if (count != 2) return 2;
  const FeatureSpace space = load_feature_space("household");  // which begins with the tabletop's
  for (const bool drawn : {false, true})
    write_file(fs::path(arguments[1]) / (drawn ? "drawn.forest" : "plain.forest"),
               tabletop::taught(space, drawn ? 2 : 1, drawn).bytes());
}

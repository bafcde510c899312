#include <fmt/format.h>

#include <algorithm>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/picture.hpp>
#include <lgabench/cli/gallery.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/harness/suite_scenario.hpp>

namespace lgabench::cli {
namespace {

constexpr int zoom = 2, gutter = 8, widest_picture = 256;

struct Tile {
  std::string caption;
  int columns, rows;
  std::vector<Rgb> pixels;
};

std::size_t pixel(const Observation& seen, int column, int row) {
  return static_cast<std::size_t>(row * seen.size.columns + column);
}

// The first environment that has a showcase: whose sheets those are that name none.
const EnvironmentType& shown_first() {
  for (const std::string& id : environment_ids())
    if (const EnvironmentType& environment = find_environment(id); environment.showcase()) return environment;
  throw InputError("--gallery: no installed environment shows its objects alone");
}

// One object alone in the middle of a scene, and what lies around it.
Tile close_up(const EnvironmentType& environment, const std::string& type, const std::string& texture,
              const std::string& caption) {
  Tile tile{caption, 72, 72, {}};
  Scene scene;
  scene.task = environment.tasks().front().id;
  scene.objects = {{type, texture, role::distractor, environment.showcase()->position_m, 0, 1}};
  const Observation seen = environment.draw(scene);
  const int left = (seen.size.columns - tile.columns) / 2, top = (seen.size.rows - tile.rows) / 2;
  for (int row = 0; row < tile.rows; ++row)
    for (int column = 0; column < tile.columns; ++column)
      tile.pixels.push_back(pixel_colour(seen, pixel(seen, left + column, top + row)));
  return tile;
}

// An object where a scene of its scenario has the target, alone; what is larger than a tile is drawn smaller.
Tile alone(const JsonReader& object) {
  object.only({"scenario", "object_type", "texture"});
  const Scenario scenario = load_scenario(object.at("scenario").string());
  Scene scene = test_scene(scenario, layouts_of(scenario).front(), scenario.tests.front().id, 0, 0);
  const SceneObject* const target = scene.find(role::target);
  if (!target) object.at("scenario").fail("a scenario in whose first scene something is meant");
  SceneObject shown = *target;
  shown.object_type = object.at("object_type").string();
  shown.texture = object.at("texture").string();
  scene.objects = {shown};
  const Observation seen = scenario.environment->draw(scene);
  int left = seen.size.columns, right = 0, top = seen.size.rows, bottom = 0;
  for (int row = 0; row < seen.size.rows; ++row)
    for (int column = 0; column < seen.size.columns; ++column)
      if (seen.ids[pixel(seen, column, row)] == shown.instance_id) {
        left = std::min(left, column);
        right = std::max(right, column);
        top = std::min(top, row);
        bottom = std::max(bottom, row);
      }
  Tile tile{fmt::format("{}, {}", shown.object_type, shown.texture), 72, 72, {}};
  const int side = std::max({tile.columns, right - left + 9, bottom - top + 9});
  const auto from = [side](int low, int high, int size, int i, int of) {
    return std::clamp((low + high - side) / 2 + i * side / of, 0, size - 1);
  };
  for (int row = 0; row < tile.rows; ++row)
    for (int column = 0; column < tile.columns; ++column)
      tile.pixels.push_back(pixel_colour(seen, pixel(seen, from(left, right, seen.size.columns, column, tile.columns),
                                                     from(top, bottom, seen.size.rows, row, tile.rows))));
  return tile;
}

Tile scene_and_mask(const Scenario& scenario, const std::string& layout, const std::string& arm, int index = 0,
                    int widest = widest_picture) {
  const Scene scene = test_scene(scenario, layout, arm, 0, index);
  const ScenarioCommand& command = scenario.commands[static_cast<std::size_t>(scene.command)];
  const Observation seen = drawn_in_arm(scenario, scene);
  const auto mask = goal_mask(seen, command.truth);
  const int step = std::max(1, seen.size.columns / widest);  // of a large picture every step-th pixel
  const int rows = seen.size.rows / step, columns = seen.size.columns / step;
  Tile tile{fmt::format("`{}`, {}: {}", scenario.id, arm, command.utterance), 2 * columns, rows, {}};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column)
      tile.pixels.push_back(pixel_colour(seen, pixel(seen, step * column, step * row)));
    for (int column = 0; column < columns; ++column)
      tile.pixels.push_back(mask_colour(mask[pixel(seen, step * column, step * row)] != 0));
  }
  return tile;
}

// Row by row; all tiles have one size.
Sheet sheet(const std::vector<Tile>& tiles, int across) {
  const int count = static_cast<int>(tiles.size()), down = (count + across - 1) / across;
  const int width = zoom * tiles[0].columns + gutter, height = zoom * tiles[0].rows + gutter;
  Picture picture(across * width - gutter, down * height - gutter);
  std::string header, rule, body;
  Json names = Json::array();
  for (const Tile& tile : tiles) names.push_back(tile.caption);
  for (int i = 0; i < across; ++i) {
    header += "| ";
    rule += "| --- ";
  }
  for (int i = 0; i < across * down; ++i) {
    const bool ends_row = i % across == across - 1;
    if (i < count) {
      const Tile& tile = tiles[static_cast<std::size_t>(i)];
      picture.paste(i % across * width, i / across * height, tile.columns, tile.rows, zoom, [&](int column, int row) {
        return tile.pixels[static_cast<std::size_t>(row * tile.columns + column)];
      });
      body += "| " + tile.caption + " ";
    } else {
      body += "| ";
    }
    if (ends_row) body += "|\n";
  }
  return {picture.png(),
          header + "|\n" + rule + "|\n" + body,
          {{"names", std::move(names)}, {"tile", width - gutter}, {"step", width}, {"across", across}}};
}

// Whether the arm has other words for the scenes of the first one.
bool in_other_words(const Scenario& scenario, const Arm& arm) {
  const std::vector<int> given = scenario.commands_of(arm.id);
  return std::all_of(given.begin(), given.end(),
                     [&](int command) { return !scenario.commands[static_cast<std::size_t>(command)].arm.empty(); });
}

// Of the suite's first scenario every perturbed arm that looks otherwise than the control, a row an axis.
std::vector<Tile> perturbed() {
  const Suite suite = load_suite("perturbations");
  const Scenario scenario = suite_scenario(suite, suite.design.scenarios.front(), Truth::released);
  const std::string layout = suite.design.layouts.front();
  constexpr int shown = 6;  // a scene in which the segmenter does not miss the target at once
  std::vector<Tile> tiles;
  for (const Arm& arm : scenario.tests) {
    if (!arm.perturbation) continue;
    const auto shows = [](const PerturbationAxis* one) {
      return one->touches(EpisodePart::rgb) || one->touches(EpisodePart::ids);
    };
    if (std::none_of(arm.axes.begin(), arm.axes.end(), shows)) continue;
    tiles.push_back(scene_and_mask(scenario, layout, arm.id, shown, widest_picture / 2));
    const auto level = static_cast<std::size_t>(arm.perturbation->level);
    const std::string what = arm.axes.size() == 1 ? arm.axes.front()->levels[level - 1] : "each";
    tiles.back().caption = fmt::format("`{}`: {}", arm.id, what);
  }
  return tiles;
}

}  // namespace

Observation drawn_in_arm(const Scenario& scenario, const Scene& scene) {
  const EnvironmentType& environment = *scenario.environment;
  Observation seen = environment.draw(scene, view_of(scenario, scene));
  if (scene.arm != "train" && scenario.arm(scene.arm).perturbation)
    if (const Perception perception = perception_of(scenario, scenario.arm(scene.arm)))
      seen = perception(seen, scene, 0);
  return seen;
}

Sheet scene_sheet(const Scenario& scenario, const std::string& layout) {
  std::vector<Tile> tiles;
  for (const Arm& arm : scenario.tests) tiles.push_back(scene_and_mask(scenario, layout, arm.id));
  return sheet(tiles, 1);
}

Sheet gallery(const std::string& what) {
  std::vector<Tile> tiles;
  if (what == "objects" || what == "textures") {
    const EnvironmentType& environment = shown_first();
    const Showcase show = *environment.showcase();
    if (what == "objects")
      for (const std::string& type : load_feature_space(show.types_of).object_types)
        tiles.push_back(close_up(environment, type, show.texture, type));
    else
      for (const std::string& texture : load_feature_space(show.textures_of).textures)
        tiles.push_back(close_up(environment, show.type, texture, texture));
    return sheet(tiles, 7);
  }
  if (what == "perturbations") return sheet(perturbed(), 4);
  if (fs::path(what).extension() == ".json") {
    const Json objects = read_json(what);
    for (const JsonReader& object : JsonReader(objects, what).elements()) tiles.push_back(alone(object));
    if (tiles.empty()) throw InputError(what + ": expected an object");
    return sheet(tiles, 7);
  }
  const std::vector<std::string> environments = environment_ids();
  const bool words = what == "words";
  const std::string environment = words || what == "scenes" ? shown_first().id() : what;
  if (contains(environments, environment)) {
    for (const std::string& id : scenario_ids()) {
      const Scenario scenario = load_scenario(id);
      if (scenario.environment->id() != environment || id.rfind("drawn_", 0) == 0)
        continue;  // a hundred of one grammar
      const std::string layout = layouts_of(scenario).front();
      const bool stands_freely_alone = layout != find_task(*scenario.environment, scenario.task).layouts.front();
      if (stands_freely_alone != words) continue;
      for (const Arm& arm : scenario.tests)
        if (!in_other_words(scenario, arm)) tiles.push_back(scene_and_mask(scenario, layout, arm.id));
    }
    return sheet(tiles, 2);
  }
  throw InputError(fmt::format(
      "--gallery {}: expected objects, textures, scenes, words, perturbations, an environment or a file", what));
}

}  // namespace lgabench::cli

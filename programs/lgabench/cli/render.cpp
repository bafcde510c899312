#include <fmt/format.h>

#include <functional>
#include <memory>
#include <optional>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/picture.hpp>
#include <lgabench/cli/commands.hpp>
#include <lgabench/cli/gallery.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/suite_scenario.hpp>

namespace lgabench::cli {
namespace {

struct RenderArguments {
  std::string scenario, gallery, cells, layout, split = "test", truth = "released", arm, suite, out;
  std::uint64_t seed = 0;
  int index = 0;
  std::vector<fs::path> plugin_path;
};

// Pictures of one size side by side, enlarged.
struct Panels {
  static constexpr int zoom = 4, gutter = 8;
  PictureSize size;
  int step;
  Picture picture;

  Panels(int count, PictureSize of_one)
      : size(of_one), step(size.columns * zoom + gutter), picture(count * step - gutter, size.rows * zoom) {}

  void fill(int panel, const std::function<Rgb(std::size_t pixel)>& colour_at) {
    picture.paste(panel * step, 0, size.columns, size.rows, zoom, [&](int column, int row) {
      return colour_at(static_cast<std::size_t>(row * size.columns + column));
    });
  }
};

void render_gallery(const RenderArguments& arguments) {
  const Sheet sheet = gallery(arguments.gallery);
  const fs::path file = arguments.out.empty() ? fmt::format("{}.png", arguments.gallery) : arguments.out;
  write_file(file, sheet.png);
  if (!arguments.cells.empty()) return write_file(arguments.cells, canonical(sheet.cells));
  to_stdout("{}\n\n{}", file.string(), sheet.legend);
}

void render(const RenderArguments& arguments) {
  const Truth truth = read_truth(arguments.truth);
  const std::optional<Suite> suite =
      arguments.suite.empty() ? std::nullopt : std::optional(load_suite(arguments.suite));
  const Scenario scenario =
      suite ? suite_scenario(*suite, arguments.scenario, truth) : load_scenario(arguments.scenario, truth);
  const std::string layout = layout_of(scenario, arguments.layout);
  const std::string first = arguments.split == "train" ? "train" : scenario.tests.front().id;
  const Scene scene =
      sampled_scene(scenario, {layout, arguments.split, arguments.arm.empty() ? first : arguments.arm, arguments.seed},
                    arguments.index);
  const ScenarioCommand& command = scenario.commands[static_cast<std::size_t>(scene.command)];

  const Observation seen = drawn_in_arm(scenario, scene);
  const std::vector<std::uint8_t> mask = goal_mask(seen, command.truth);

  Panels panels(3, seen.size);
  panels.fill(0, [&](std::size_t i) { return pixel_colour(seen, i); });
  panels.fill(1, [&](std::size_t i) { return id_colour(seen.ids[i]); });
  panels.fill(2, [&](std::size_t i) { return mask_colour(mask[i] != 0); });
  const fs::path file = arguments.out.empty() ? fmt::format("{}-{}.png", scenario.id, arguments.index) : arguments.out;
  write_file(file, panels.picture.png());

  to_stdout("{}\n", file.string());
  to_stdout("{}, {}: {}\n", scenario.id, scene.arm, command.utterance);
  for (const SceneObject& object : scene.objects)
    to_stdout("  {:3}  {:10}  {} {}\n", object.instance_id, object.role, object.texture, object.object_type);
}

}  // namespace

void add_render(CLI::App& app, int&) {
  auto arguments = std::make_shared<RenderArguments>();
  Verb verb(app, "render", worker_summary("render"));
  std::vector<std::string> galleries{"objects", "textures", "scenes", "words", "perturbations"};
  for (const std::string& id : environment_ids()) galleries.push_back(id);
  auto* scenario = verb.option("scenario SCENARIO", arguments->scenario, "A scenario's id");
  verb.option("--out FILE", arguments->out, "The file for the picture (default: SCENARIO-INDEX.png or GALLERY.png)");
  verb.below("What is drawn");
  verb.option("--gallery objects|textures|scenes|words|perturbations|ENVIRONMENT|FILE.json", arguments->gallery,
              "Draw one sheet instead. objects, textures: all of them; scenes: one of every scenario; words: one of "
              "each scenario of the suite words; perturbations: one along each axis; ENVIRONMENT: one of each of its "
              "scenarios; FILE.json: the objects of a list of {\"scenario\", \"object_type\", \"texture\"}",
              [known = one_of("gallery", galleries)](std::string what) {
                return fs::path(what).extension() == ".json" ? std::string() : known(what);
              })
      ->excludes(scenario);
  verb.option("--cells FILE", arguments->cells,
              "With --gallery: write the position of each picture on the sheet as JSON, and print nothing")
      ->excludes(scenario);
  verb.option("--index N", arguments->index, "Number of the scene", CLI::Range(0, 1000000000), with_default);
  verb.option("--layout LAYOUT", arguments->layout,
              "How objects are placed: one of `lgabench list layouts --of SCENARIO` (default: the first)");
  verb.option("--split train|dev|test", arguments->split, "Which set of scenes",
              one_of("split", {"train", "dev", "test"}), with_default);
  verb.option("--arm ARM", arguments->arm,
              "An arm of the scenario's test (lgabench info SCENARIO), or train (default: its first arm)");
  verb.option("--suite SUITE", arguments->suite,
              "Draw the scenario as this suite plays it, with its arms; in a suite with variants, name the scenario "
              "SCENARIO_VARIANT");
  verb.option("--truth released|printed", arguments->truth,
              "Which true distributions to use where released and printed ones differ",
              one_of("truth", {"released", "printed"}), with_default);
  verb.option("--seed N", arguments->seed, "Seed of the scenes", a_seed(), with_default);
  add_plugin_path(verb, arguments->plugin_path, any_plugin);
  add_scenario_path(verb);
  verb->footer(
      "Draws the scene before the action; the mask is that of the command's true Selection.\nExample: lgabench render "
      "red_heart --index 3 --out scene.png\n         lgabench render --gallery objects --out objects.png");
  verb->callback([arguments] {
    if (arguments->scenario.empty() && arguments->gallery.empty())
      throw InputError("render: expected a scenario's id, or --gallery");
    arguments->gallery.empty() ? render(*arguments) : render_gallery(*arguments);
  });
}

}  // namespace lgabench::cli

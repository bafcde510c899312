#include <fmt/format.h>

#include <functional>
#include <memory>
#include <optional>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/cell/picture.hpp>
#include <lgabench/cli/commands.hpp>
#include <lgabench/cli/gallery.hpp>
#include <lgabench/cli/help.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/expand.hpp>

namespace lgabench::cli {
namespace {

struct RenderArguments {
  std::string scenario, gallery, cells, layout, split = "test", truth = "released", arm, suite, out;
  std::uint64_t seed = 0;
  int index = 0;
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
  const std::string layout = arguments.layout.empty() ? layouts_of(scenario).front() : arguments.layout;
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
  CLI::App* verb = app.add_subcommand("render", worker_summary("render"));
  std::vector<std::string> galleries{"objects", "textures", "scenes", "words", "perturbations"};
  for (const std::string& id : environment_ids()) galleries.push_back(id);
  auto* scenario = verb->add_option("scenario", arguments->scenario, "A scenario's id");
  verb->add_option("--gallery", arguments->gallery,
                   "Draw one sheet instead: all objects, all textures, or a scene of every scenario (words: of the "
                   "suite words; perturbations: one along each axis; or of those of one environment); or the objects "
                   "of a file, a list of {\"scenario\", \"object_type\", \"texture\"}")
      ->check([known = one_of("gallery", galleries)](std::string what) {
        return fs::path(what).extension() == ".json" ? std::string() : known(what);
      })
      ->excludes(scenario);
  verb->add_option("--cells", arguments->cells,
                   "With --gallery: write the position of each picture on the sheet as JSON, and print nothing")
      ->excludes(scenario);
  verb->add_option("--index", arguments->index, "Number of the scene")
      ->check(CLI::Range(0, 1000000000))
      ->capture_default_str();
  verb->add_option("--layout", arguments->layout,
                   "How objects are placed: one of `lgabench list layouts --of SCENARIO` (default: the first)")
      ->check(one_of("layout", installed_layouts()));
  verb->add_option("--split", arguments->split, "Which set of scenes")
      ->check(one_of("split", {"train", "dev", "test"}))
      ->capture_default_str();
  verb->add_option("--arm", arguments->arm,
                   "An arm of the scenario's test (lgabench info SCENARIO), or train (default: its first arm)");
  verb->add_option("--suite", arguments->suite,
                   "Draw the scenario as this suite plays it: its arms; in a suite with variants, name the scenario "
                   "SCENARIO_VARIANT");
  verb->add_option("--truth", arguments->truth,
                   "Which true distributions to use where released and printed ones differ")
      ->check(one_of("truth", {"released", "printed"}))
      ->capture_default_str();
  verb->add_option("--seed", arguments->seed, "Seed of the scenes")->capture_default_str();
  verb->add_option("--out", arguments->out, "The file for the picture (default: SCENARIO-INDEX.png or GALLERY.png)");
  add_scenario_path(*verb);
  arrange(*verb, "", {{"scenario", "SCENARIO"}, {"--out", "FILE"}});
  arrange(*verb, "What is drawn",
          {{"--gallery", "objects|textures|scenes|words|perturbations|ENVIRONMENT|FILE.json"},
           {"--cells", "FILE"},
           {"--index", "N"},
           {"--layout", "LAYOUT"},
           {"--split", "train|dev|test"},
           {"--arm", "ARM"},
           {"--suite", "SUITE"},
           {"--truth", "released|printed"},
           {"--seed", "N"},
           {"--scenario-path", "DIR"}});
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

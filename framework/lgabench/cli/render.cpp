#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <tabletop/renderer.hpp>
#include <tabletop/sampler.hpp>
#include <tabletop/textures.hpp>

namespace lgabench::cli {
namespace {

struct Arguments {
  std::string scenario, layout = "cells", split = "test", out;
  std::uint64_t seed = 0;
  int index = 0;
};

using tabletop::Rgb;

constexpr Rgb gutter_colour{255, 255, 255}, dropped{32, 32, 32}, kept{245, 245, 245};

// Far hues for near ids (steps of the golden section around the colour circle).
Rgb colour_of(std::uint8_t id) {
  if (id == 0) return dropped;
  const double hue = 6 * std::fmod(0.618034 * id, 1.0);
  const auto channel = [hue](double peak) {
    const double distance = std::abs(std::remainder(hue - peak, 6.0));
    return static_cast<std::uint8_t>(60 + 180 * std::clamp(2 - distance, 0.0, 1.0));
  };
  return {channel(0), channel(2), channel(4)};
}

/// Pictures of the observation's size side by side, each pixel as a square of `zoom`, with gutters between them.
struct Panels {
  static constexpr int zoom = 4, gutter = 8, panel_width = Observation::columns * zoom;
  int count, width, height = Observation::rows * zoom;
  std::vector<std::uint8_t> rgb;

  explicit Panels(int panels) : count(panels), width(panels * (panel_width + gutter) - gutter) {
    for (int i = 0; i < width * height; ++i) rgb.insert(rgb.end(), gutter_colour.begin(), gutter_colour.end());
  }

  void fill(int panel, const std::function<Rgb(std::size_t pixel)>& colour_at) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < panel_width; ++x) {
        const Rgb colour = colour_at(static_cast<std::size_t>(y / zoom * Observation::columns + x / zoom));
        std::copy(colour.begin(), colour.end(), rgb.begin() + 3 * (y * width + panel * (panel_width + gutter) + x));
      }
  }

  std::string png() const {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width);
    image.height = static_cast<png_uint_32>(height);
    image.format = PNG_FORMAT_RGB;
    std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
    png_alloc_size_t size = bytes.size();
    if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr))
      throw Error(fmt::format("libpng: {}", image.message));
    bytes.resize(size);
    return bytes;
  }
};

void render(const Arguments& arguments) {
  const Scenario scenario = load_scenario(arguments.scenario);
  tabletop::SceneRequest request;
  request.distribution = scenario.truth;
  request.layout = arguments.layout;
  request.split = arguments.split;
  request.arm = arguments.split == "train" ? "train" : "test";
  request.seed = arguments.seed;
  const Scene scene = sample_scene(scenario, request, arguments.index);

  tabletop::Renderer renderer;
  const Observation seen = renderer.render(tabletop::visible_objects(scene), tabletop::ground_of(scene));
  const std::vector<std::uint8_t> mask = goal_mask(seen, scenario.truth);

  Panels panels(3);
  panels.fill(0, [&](std::size_t i) { return Rgb{seen.rgb[3 * i], seen.rgb[3 * i + 1], seen.rgb[3 * i + 2]}; });
  panels.fill(1, [&](std::size_t i) { return colour_of(seen.ids[i]); });
  panels.fill(2, [&](std::size_t i) { return mask[i] ? kept : dropped; });
  const fs::path file = arguments.out.empty() ? fmt::format("{}-{}.png", scenario.id, arguments.index) : arguments.out;
  write_file(file, panels.png());

  fmt::print("{}\n", file.string());
  fmt::print("{}: {}\n", scenario.id, scenario.command.utterance);
  for (const SceneObject& object : scene.objects)
    fmt::print("  {:3}  {:10}  {} {}\n", object.instance_id, to_string(object.role), object.texture,
               object.object_type);
}

}  // namespace

void add_render(CLI::App& app, int&) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb = app.add_subcommand("render", "Draw a scene, its ids and its goal mask as a PNG");
  verb->add_option("scenario", arguments->scenario, "A scenario's id")->required();
  verb->add_option("--index", arguments->index, "Number of the scene")
      ->check(CLI::Range(0, 1000000000))
      ->capture_default_str();
  verb->add_option("--layout", arguments->layout, "cells, continuous or released")->capture_default_str();
  verb->add_option("--split", arguments->split, "train, dev or test")->capture_default_str();
  verb->add_option("--seed", arguments->seed, "Seed of the scenes")->capture_default_str();
  verb->add_option("--out", arguments->out, "The picture's file; SCENARIO-INDEX.png if not given");
  verb->footer(
      "Draws the scene before the first action; the mask is the one of the true Selection.\n"
      "Example: lgabench render red_heart --index 3 --out scene.png");
  verb->callback([arguments] { render(*arguments); });
}

}  // namespace lgabench::cli

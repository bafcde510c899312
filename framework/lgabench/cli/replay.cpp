// lgabench replay RUN EPISODE: a recorded episode played again, to be looked at.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cli/commands.hpp>
#include <lgabench/cli/gif.hpp>
#include <lgabench/cli/help.hpp>
#include <lgabench/cli/watched_world.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/record/cell.hpp>
#include <lgabench/record/episode.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench::cli {
namespace {

constexpr double frame_s = .05;  // of simulated time
constexpr int zoom = 3;

struct ReplayArguments {
  fs::path run, out;
  std::string episode;
  std::vector<fs::path> plugin_path;
};

struct Recorded {
  Cell cell;
  Scenario scenario;
  Episode episode;
};

// The only cell whose key begins so.
fs::path cell_of(const fs::path& run, const std::string& key) {
  fs::path found;
  std::error_code none_there;
  for (const auto& entry : fs::directory_iterator(run / "cells", none_there)) {
    if (key.empty() || entry.path().filename().string().rfind(key, 0) != 0) continue;
    if (!found.empty()) throw InputError(fmt::format("replay: several cells begin with {}", key));
    found = entry.path();
  }
  if (found.empty()) throw InputError(fmt::format("replay: no cell of {} begins with \"{}\"", run.string(), key));
  return found;
}

// KEY/ARM/INDEX, or KEY/INDEX of the first arm.
Recorded recorded(const ReplayArguments& a) {
  const std::size_t first = a.episode.find('/'), last = a.episode.rfind('/');
  int index = 0;
  if (first == std::string::npos || !CLI::detail::lexical_cast(a.episode.substr(last + 1), index))
    throw InputError(fmt::format("replay: expected KEY/ARM/INDEX or KEY/INDEX, got \"{}\"", a.episode));
  const fs::path directory = cell_of(a.run, a.episode.substr(0, first));
  const Cell cell = recorded_cell(directory);
  const Scenario scenario =
      read_scenario(*cell.scenario, (directory / cell_file::configuration).string() + ": /scenario");
  const std::string arm = first == last ? scenario.tests.front().id : a.episode.substr(first + 1, last - first - 1);
  scenario.arm(arm);  // says which there are
  const std::string file = (directory / cell_file::episodes).string();
  for (const Json& line : parse_json_lines(read_file(file, Links::refused), file)) {
    const Episode episode = read_episode(JsonReader(line, file));
    if (episode.arm != arm || episode.index != index) continue;
    if (episode.action.empty())
      throw InputError(fmt::format("replay: {} ended without an action: {}", a.episode, episode.failure));
    return {cell, scenario, episode};
  }
  throw InputError(fmt::format("replay: {} has no episode {} in arm {}", directory.string(), index, arm));
}

void draw(const EnvironmentType& environment, const Tool& tool, Picture& picture) {
  constexpr Rgb colour{255, 0, 160};
  const Vec3 at = tool.pose.position_m;
  const auto dots = [&](Vec3 from, Vec3 to) {
    constexpr int count = 40;
    for (int i = 0; i <= count; ++i) {
      const Vec2 p = zoom * environment.in_picture(from + static_cast<double>(i) / count * (to - from));
      picture.dot(p.x, p.y, 2, colour);
    }
  };
  if (tool.box_m) {
    const Vec3 half = .5 * *tool.box_m;
    const auto corner = [&](double x, double y) {
      return at + rotated({x * half.x, y * half.y, 0}, tool.pose.rotation);
    };
    dots(corner(-1, -1), corner(1, -1));
    dots(corner(1, -1), corner(1, 1));
    dots(corner(1, 1), corner(-1, 1));
    dots(corner(-1, 1), corner(-1, -1));
  } else {
    constexpr double arm_m = .02;
    dots(at - Vec3{arm_m, 0, 0}, at + Vec3{arm_m, 0, 0});
    dots(at - Vec3{0, arm_m, 0}, at + Vec3{0, arm_m, 0});
  }
}

// Eight of the frames, first and last among them, below each other in two columns.
Picture filmstrip(const std::vector<Picture>& frames) {
  constexpr int count = 8, across = 2, gutter = 8;
  const int width = frames.front().width(), height = frames.front().height();
  Picture strip(across * (width + gutter) - gutter, count / across * (height + gutter) - gutter);
  for (int i = 0; i < count; ++i) {
    const Picture& frame = frames[static_cast<std::size_t>(i) * (frames.size() - 1) / (count - 1)];
    strip.paste(i % across * (width + gutter), i / across * (height + gutter), width, height, 1,
                [&](int column, int row) { return frame.at(column, row); });
  }
  return strip;
}

void replay(const ReplayArguments& a) {
  const std::string ending = a.out.extension().string();
  if (ending != ".gif" && ending != ".png") throw InputError("replay: expected --out FILE.gif or FILE.png");
  const auto [cell, scenario, episode] = recorded(a);
  const Scene scene =
      test_scene(scenario, cell.layout, episode.arm, cell.scene_seed, episode.index, cell.scenes_of_seed());
  if (hex(scene.hash()) != episode.scene)
    throw InputError("replay: this version samples another scene than the run played");

  const EnvironmentType& type = find_environment(scenario.environment);
  std::vector<Picture> frames;
  const auto add = [&](const Observation& seen, const std::optional<Tool>& tool) {
    frames.emplace_back(zoom * seen.size.columns, zoom * seen.size.rows);
    frames.back().paste(0, 0, seen.size.columns, seen.size.rows, zoom, [&](int column, int row) {
      return pixel_colour(seen, static_cast<std::size_t>(row * seen.size.columns + column));
    });
    if (tool) draw(type, *tool, frames.back());
  };
  std::unique_ptr<Environment> environment;
  const auto look = [&](const std::optional<Tool>& tool) { add(environment->observe(), tool); };
  const Catalogue catalogue = scan_plugins(plugin_directories(a.plugin_path));
  environment = make_environment(
      scenario, std::make_unique<WatchedWorld>(load_engine(catalogue.find("engine", cell.engine)), frame_s, look));
  add(environment->reset(scene), std::nullopt);
  const StepResult end = environment->step(episode.action);
  add(end.observation, std::nullopt);

  write_file(a.out, ending == ".gif" ? gif(frames, frame_s) : filmstrip(frames).png());
  to_stdout("{}: {} frames; {} {}\n", a.out.string(), frames.size(), end.is_success ? "success" : end.failure,
            end.failure == episode.failure ? "as recorded" : "here, recorded as " + episode.failure);
}

}  // namespace

void add_replay(CLI::App& app, int&) {
  auto a = std::make_shared<ReplayArguments>();
  CLI::App* verb = app.add_subcommand("replay", worker_summary("replay"));
  verb->add_option("run", a->run, "The run's directory")->required();
  verb->add_option("episode", a->episode,
                   "The cell's key or its first digits, the arm, and the scene's number; without an arm, the "
                   "scenario's first arm")
      ->required();
  verb->add_option("--out", a->out, "FILE.gif for an animation, FILE.png for a film strip")->required();
  add_plugin_path(*verb, a->plugin_path);
  arrange(*verb, "", {{"run", "RUN"}, {"episode", "KEY/ARM/INDEX"}, {"--out", "FILE"}, {"--plugin-path", "PATH"}});
  verb->footer(
      "Carries out the recorded action on the recorded engine, without the method. Pink marks where the suction cup "
      "holds, or the spatula.\nExample: lgabench replay runs/q1 752bdc8e/test/3 --out episode.gif");
  verb->callback([a] { replay(*a); });
}

}  // namespace lgabench::cli

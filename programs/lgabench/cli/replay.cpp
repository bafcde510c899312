// lgabench replay RUN EPISODE...: recorded episodes played again, to be looked at, several beside each other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cli/commands.hpp>
#include <lgabench/cli/gif.hpp>
#include <lgabench/cli/outcome.hpp>
#include <lgabench/cli/played_scenes.hpp>
#include <lgabench/cli/watched_world.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/host/python_environment.hpp>
#include <lgabench/host/python_method.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/record/cell.hpp>
#include <lgabench/record/episode.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench::cli {
namespace {

constexpr double frame_s = .05;  // of simulated time
constexpr double input_s = 1.5, last_s = 2;
constexpr double slowed_s = .15;  // a frame's, where two are watched at once

struct ReplayArguments {
  fs::path run, out;
  std::vector<std::string> episodes;
  std::vector<fs::path> plugin_path;
  std::string python = usual_python();
};

struct Recorded {
  Cell cell;
  Scenario scenario;
  Episode episode;
  std::optional<Selection> selection;  // none where the policy sees everything
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

// What the cell's method selected for the command.
std::optional<Selection> selection_of(const fs::path& directory, const Scenario& scenario, int command) {
  const std::string file = (directory / cell_file::selections).string();
  const Json recorded = parse_json(read_file(file, Links::refused), file);
  const std::vector<JsonReader> commands = JsonReader(recorded, file).at("commands").elements();
  if (command < 0 || static_cast<std::size_t>(command) >= commands.size())
    throw InputError(fmt::format("{}: expected a command {}", file, command));
  const JsonReader selection = commands[static_cast<std::size_t>(command)].at("selection");
  if (selection.at("provenance").string() == "none") return std::nullopt;
  const Json distribution = distribution_of(selection.json());
  return read_distribution(JsonReader(distribution, file), scenario.space, scenario.second);
}

// KEY/ARM/INDEX, or KEY/INDEX of the first arm.
Recorded recorded(const fs::path& run, const std::string& named) {
  const std::size_t first = named.find('/'), last = named.rfind('/');
  const std::optional<int> index = first == std::string::npos ? std::nullopt : number_of<int>(named.substr(last + 1));
  if (!index) throw InputError(fmt::format("replay: expected KEY/ARM/INDEX or KEY/INDEX, got \"{}\"", named));
  const fs::path directory = cell_of(run, named.substr(0, first));
  const Cell cell = recorded_cell(directory);
  const Scenario scenario =
      read_scenario(*cell.scenario, (directory / cell_file::configuration).string() + ": /scenario");
  const std::string arm = first == last ? scenario.tests.front().id : named.substr(first + 1, last - first - 1);
  scenario.arm(arm);  // says which there are
  const std::string file = (directory / cell_file::episodes).string();
  for (const Json& line : parse_json_lines(read_file(file, Links::refused), file)) {
    const Episode episode = read_episode(JsonReader(line, file));
    if (episode.arm != arm || episode.index != *index) continue;
    if (episode.actions().empty())
      throw InputError(fmt::format("replay: {} ended without an action: {}", named, episode.failure));
    return {cell, scenario, episode, selection_of(directory, scenario, episode.given())};
  }
  throw InputError(fmt::format("replay: {} has no episode {} in arm {}", directory.string(), *index, arm));
}

void draw(const EnvironmentType& environment, const Tool& tool, int zoom, Picture& picture) {
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

// Eight of the frames, or one for each of several steps, first and last among them, below each other in two columns.
Picture filmstrip(const std::vector<Picture>& frames, std::size_t steps) {
  constexpr int across = 2, gutter = 8;
  const int count = steps == 1 ? 8 : static_cast<int>(steps) + 1;
  const int width = frames.front().width(), height = frames.front().height();
  Picture strip(across * (width + gutter) - gutter, (count + 1) / across * (height + gutter) - gutter);
  for (int i = 0; i < count; ++i) {
    const Picture& frame =
        frames[static_cast<std::size_t>(i) * (frames.size() - 1) / static_cast<std::size_t>(count - 1)];
    strip.paste(i % across * (width + gutter), i / across * (height + gutter), width, height, 1,
                [&](int column, int row) { return frame.at(column, row); });
  }
  return strip;
}

// Where a pixel is outside of what the policy sees.
Rgb faded(Rgb colour) {
  for (auto& part : colour) part = static_cast<std::uint8_t>(255 - (255 - part) / 6);
  return colour;
}

struct Played {
  Picture input;  // what the policy sees of the scene
  std::vector<Picture> frames;
  StepResult end;
  std::size_t steps;
};

Played play(const Catalogue& catalogue, const Recorded& recorded, int zoom) {
  const auto& [cell, scenario, episode, selection] = recorded;
  const Scene scene =
      test_scene(scenario, cell.layout, episode.arm, cell.scene_seed, episode.index, cell.scenes_of_seed());
  if (hex(scene.hash()) != episode.scene)
    throw InputError("replay: this version samples another scene than the run played");

  const EnvironmentType& type = *scenario.environment;
  const auto enlarged = [&](const Observation& seen, const std::vector<std::uint8_t>& mask) {
    Picture picture(zoom * seen.size.columns, zoom * seen.size.rows);
    picture.paste(0, 0, seen.size.columns, seen.size.rows, zoom, [&](int column, int row) {
      const auto at = static_cast<std::size_t>(row * seen.size.columns + column);
      return mask.empty() || mask[at] ? pixel_colour(seen, at) : faded(pixel_colour(seen, at));
    });
    return picture;
  };
  std::vector<Picture> frames;
  const auto add = [&](const Observation& seen, const std::optional<Tool>& tool) {
    frames.push_back(enlarged(seen, {}));
    if (tool) draw(type, *tool, zoom, frames.back());
  };
  std::unique_ptr<Environment> environment;
  const auto look = [&](const std::optional<Tool>& tool) { add(environment->observe(), tool); };
  auto world = load_engine(catalogue.engine(cell.engine, type));
  if (world) world = std::make_unique<WatchedWorld>(std::move(world), frame_s, look);
  environment = make_environment(scenario, std::move(world));
  const Observation first = environment->reset(scene);
  add(first, std::nullopt);
  const Picture input = enlarged(first, selection ? goal_mask(first, *selection) : std::vector<std::uint8_t>());
  StepResult end = carry_out(*environment, scene, episode.actions(),
                             [&](const StepResult& result) { add(result.observation, std::nullopt); });
  return {input, frames, std::move(end), episode.actions().size()};
}

// From left to right. @pre All of one height.
Picture beside(const std::vector<const Picture*>& pictures) {
  constexpr int gutter = 16;
  int width = -gutter;
  for (const Picture* picture : pictures) width += picture->width() + gutter;
  Picture row(width, pictures.front()->height());
  int left = 0;
  for (const Picture* picture : pictures) {
    row.paste(left, 0, picture->width(), picture->height(), 1, [&](int x, int y) { return picture->at(x, y); });
    left += picture->width() + gutter;
  }
  return row;
}

void replay(const ReplayArguments& a) {
  const std::string ending = a.out.extension().string();
  const bool several = a.episodes.size() > 1;
  if (ending != ".gif" && (ending != ".png" || several))
    throw InputError(several ? "replay: expected --out FILE.gif" : "replay: expected --out FILE.gif or FILE.png");
  expect_run(a.run);
  const Catalogue catalogue = plugins_at(a.plugin_path, usual_python());
  std::vector<Played> all;
  std::string said;
  std::size_t longest = 0;
  for (const std::string& named : a.episodes) {
    const Recorded episode = recorded(a.run, named);
    all.push_back(play(catalogue, episode, several ? 2 : 3));
    if (all.back().input.height() != all.front().input.height())
      throw InputError("replay: expected episodes of one environment");
    const auto& [input, frames, end, steps] = all.back();
    longest = std::max(longest, frames.size());
    said += fmt::format(
        "{}{}; {}{} {}", said.empty() ? "" : " | ", several ? episode.cell.method.name : "",
        steps == 1 ? "" : fmt::format("{} steps, ", steps), end.is_success ? "success" : end.failure,
        end.failure == episode.episode.failure ? "as recorded" : "here, recorded as " + episode.episode.failure);
  }

  std::vector<Frame> frames;
  if (several) {  // one frame is not enough to see what each policy goes by
    std::vector<const Picture*> inputs;
    for (const Played& played : all) inputs.push_back(&played.input);
    frames.push_back({beside(inputs), input_s});
  }
  for (std::size_t i = 0; i < longest; ++i) {
    std::vector<const Picture*> now;
    for (const Played& played : all) now.push_back(&played.frames[std::min(i, played.frames.size() - 1)]);
    frames.push_back({beside(now), i + 1 == longest ? last_s : several || all.front().steps > 1 ? slowed_s : frame_s});
  }
  write_file(a.out, ending == ".gif" ? gif(frames) : filmstrip(all.front().frames, all.front().steps).png());
  to_stdout("{}: {} frames{}{}\n", a.out.string(), frames.size(), several ? "; " : "", said);
}

}  // namespace

void add_replay(CLI::App& app, int&) {
  auto a = std::make_shared<ReplayArguments>();
  Verb verb(app, "replay", worker_summary("replay"));
  verb.option("run RUN", a->run, "The run's directory", required);
  verb.option("episodes KEY/ARM/INDEX", a->episodes,
              "The cell's key or its first digits, the arm, and the scene's number; without an arm, the "
              "scenario's first arm. Several episodes are drawn side by side, after the input of each policy",
              required);
  verb.option("--out FILE", a->out, "FILE.gif for an animation, FILE.png for a film strip", required);
  add_plugin_path(verb, a->plugin_path, any_plugin);
  add_scenario_path(verb);
  add_python(verb, a->python);
  verb->footer(
      "replay carries out the recorded actions on the recorded engine, without the method. Pink marks the suction "
      "cup's "
      "hold or the spatula. Several episodes are slowed down.\nExample: lgabench replay runs/q1 752bdc8e/test/3 "
      "--out "
      "episode.gif");
  verb->callback([a] { replay(*a); });
}

}  // namespace lgabench::cli

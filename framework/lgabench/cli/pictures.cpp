// lgabench-worker pictures: what report.html shows of test scenes, as a request on stdin lists them.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/cell/environments.hpp>
#include <lgabench/cell/evaluator.hpp>
#include <lgabench/cell/picture.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/job/job.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/report/pictures.hpp>

namespace lgabench::cli {
namespace {

template <class ColourAt>
std::string png(PictureSize size, ColourAt colour_at) {
  const int step = page_step(size), columns = size.columns / step, rows = size.rows / step;
  Picture picture(columns, rows);
  picture.paste(0, 0, columns, rows, 1, [&](int column, int row) {
    return colour_at(static_cast<std::size_t>(step * row * size.columns + step * column));
  });
  return base64(picture.png());
}

// The edges of all pixels that are `inside`, as an SVG path in pixels.
std::string outline(PictureSize size, const std::function<bool(int column, int row)>& inside) {
  std::string path;
  const auto edges = [&path](int lines, int length, const auto& is_edge, const auto& step) {
    for (int line = 0; line <= lines; ++line)
      for (int begin = 0, end = 0; begin < length; begin = end + 1) {
        for (end = begin; end < length && is_edge(line, end);) ++end;
        if (end > begin) path += step(line, begin, end - begin);
      }
  };
  edges(
      size.rows, size.columns, [&](int y, int x) { return inside(x, y) != inside(x, y - 1); },
      [](int y, int x, int n) { return fmt::format("M{} {}h{}", x, y, n); });
  edges(
      size.columns, size.rows, [&](int x, int y) { return inside(x, y) != inside(x - 1, y); },
      [](int x, int y, int n) { return fmt::format("M{} {}v{}", x, y, n); });
  return path;
}

// The targets' outline, as far as they are in view.
std::string targets(const Scene& scene, const Observation& seen) {
  std::set<std::uint8_t> ids;
  for (const SceneObject& object : scene.objects)
    if (object.role == role::target) ids.insert(object.instance_id);
  const int step = page_step(seen.size);
  const PictureSize size{seen.size.rows / step, seen.size.columns / step};
  return outline(size, [&](int column, int row) {
    if (column < 0 || row < 0 || column >= size.columns || row >= size.rows) return false;
    return ids.count(seen.ids[static_cast<std::size_t>(step * row * seen.size.columns + step * column)]) != 0;
  });
}

struct Replayed {
  Cell cell;
  Scenario scenario;
};

class Pictures {
 public:
  // {"picture": PNG, "masks": [PNG, ...], "ends": [PNG, ...], "targets": path, "oracle": action},
  // pictures in base64: the scene, goal masks of the request's Selections, the scene after each of its actions (null
  // where it could not be carried out, "" where nothing moved), the targets' outline, and what the oracle would do
  // (null without the cell's engine). @throws InputError where the scene is not the one asked for.
  Json draw(const PictureRequest& request) {
    const Replayed& played = cell(request.cell.string());
    const Scene scene = test_scene(played.scenario, played.cell.layout, request.arm, played.cell.scene_seed,
                                   request.index, played.cell.scenes_of_seed());
    if (hex(scene.hash()) != request.scene) throw InputError("this version samples another scene than the run played");

    const Observation seen = find_environment(played.scenario.environment).draw(scene);
    const Perception perception =
        perception_of(played.scenario, played.scenario.arm(request.arm), played.cell.scenes_of_seed());
    const Observation perceived = perception ? perception(seen, scene) : seen;
    Json masks = Json::array();
    for (const Json& one : request.selections) {
      const JsonReader selection(one, "selection");
      const auto mask = goal_mask(
          perceived, read_distribution(selection.at("distribution"), played.scenario.space, played.scenario.second),
          selection.at("instances").string() == "first" ? Instances::first : Instances::all);
      masks.push_back(png(seen.size, [&](std::size_t i) { return mask_colour(mask[i] != 0); }));
    }
    const std::string picture = picture_of(seen);
    Json ends = Json::array();
    for (const PictureRequest::End& end : request.ends) {
      const std::optional<std::string> after = after_action(played.scenario, scene, end);
      ends.push_back(!after ? Json() : Json(*after == picture ? "" : *after));
    }
    Environment* const environment = on(played.cell.engine, played.scenario);
    if (environment) environment->reset(scene);
    return {{"picture", picture},
            {"masks", masks},
            {"ends", ends},
            {"targets", targets(scene, seen)},
            {"oracle", environment ? Json(environment->expert_action()) : Json()}};
  }

 private:
  static std::string picture_of(const Observation& seen) {
    return png(seen.size, [&](std::size_t i) { return pixel_colour(seen, i); });
  }

  // None where the engine is not there, or the action is none of this environment's.
  std::optional<std::string> after_action(const Scenario& scenario, const Scene& scene,
                                          const PictureRequest::End& end) {
    Environment* const environment = on(end.engine, scenario);
    if (!environment) return std::nullopt;
    environment->reset(scene);
    try {
      return picture_of(environment->step(end.action).observation);
    } catch (const MethodError&) {
      return std::nullopt;
    }
  }

  // Null for an engine that is not there.
  Environment* on(const std::string& engine, const Scenario& scenario) {
    std::unique_ptr<Environment>& made = environments_[{engine, scenario.environment, scenario.space.id}];
    if (made) return made.get();
    static const Catalogue catalogue = scan_plugins(plugin_directories());
    try {
      made = make_environment(scenario, load_engine(catalogue.find("engine", engine)));
    } catch (const PluginError&) {
      return nullptr;
    }
    return made.get();
  }

  const Replayed& cell(const std::string& file) {
    const auto known = cells_.find(file);
    if (known != cells_.end()) return *known->second;
    Cell read = read_cell(read_json(file), file);
    Scenario scenario = read_scenario(*read.scenario, file + ": /scenario");
    return *(cells_[file] = std::make_unique<Replayed>(Replayed{std::move(read), std::move(scenario)}));
  }

  std::map<std::array<std::string, 3>, std::unique_ptr<Environment>> environments_;  // by engine, environment, space
  std::map<std::string, std::unique_ptr<Replayed>> cells_;                           // by file
};

}  // namespace

void add_pictures(CLI::App& app, int&) {
  CLI::App* verb = app.add_subcommand("pictures", "Draw the scenes listed as JSON on stdin, a line of JSON each");
  verb->group("");  // `lgabench report` starts it
  verb->footer(
      "Example: echo '[{\"cell\": \"runs/x/cells/KEY/cell.json\", \"arm\": \"test\", \"index\": 0, \"scene\": "
      "\"HASH\",\n"
      "                \"selections\": []}]' | lgabench-worker pictures");
  verb->callback([] {
    const std::string text((std::istreambuf_iterator<char>(std::cin)), {});
    const Json requests = parse_json(text, "pictures");
    Pictures pictures;
    for (const JsonReader& request : JsonReader(requests, "pictures").elements()) {
      Json line;
      try {
        line = pictures.draw(read_picture_request(request));
      } catch (const Error& e) {
        line = {{"problem", e.what()}};
      }
      to_stdout("{}\n", canonical(line));
    }
  });
}

}  // namespace lgabench::cli

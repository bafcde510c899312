// lgabench-worker pictures: test scenes and goal masks for report.html, as a request on stdin lists them.
#include <fmt/format.h>
#include <openssl/evp.h>

#include <iostream>
#include <iterator>
#include <map>
#include <memory>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/cell/environments.hpp>
#include <lgabench/cell/evaluator.hpp>
#include <lgabench/cli/picture.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/job/job.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/report/pictures.hpp>

namespace lgabench::cli {
namespace {

std::string base64(const std::string& bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  const auto* from = reinterpret_cast<const unsigned char*>(bytes.data());
  const int size = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), from, static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(size));
  return text;
}

template <class ColourAt>
std::string png(PictureSize size, ColourAt colour_at) {
  const int step = report::page_step(size), columns = size.columns / step, rows = size.rows / step;
  Picture picture(columns, rows);
  picture.paste(0, 0, columns, rows, 1, [&](int column, int row) {
    return colour_at(static_cast<std::size_t>(step * row * size.columns + step * column));
  });
  return base64(picture.png());
}

struct Played {
  Cell cell;
  Scenario scenario;
};

class Pictures {
 public:
  // {"picture": PNG, "masks": [PNG, ...], "ends": [PNG, ...]}, in base64: the scene, goal masks of the request's
  // Selections, and the scene after its action on each of its engines (null for one that is not there). @throws
  // InputError where the scene is not the one asked for.
  Json draw(const PictureRequest& request) {
    const Played& played = cell(request.cell.string());
    const Scene scene = test_scene(played.scenario, played.cell.layout, request.arm, played.cell.scene_seed,
                                   request.index, played.cell.scenes_of_seed());
    if (hex(scene.hash()) != request.scene) throw InputError("this version samples another scene than the run played");

    const Observation seen = find_environment(played.scenario.environment).draw(scene);
    const Perception perception = perception_of(played.scenario, played.scenario.arm(request.arm));
    const Observation perceived = perception ? perception(seen, scene) : seen;
    Json masks = Json::array();
    for (const Json& one : request.selections) {
      const JsonReader selection(one, "selection");
      const auto mask = goal_mask(
          perceived, read_distribution(selection.at("distribution"), played.scenario.space, played.scenario.second),
          selection.at("instances").string() == "first" ? Instances::first : Instances::all);
      masks.push_back(png(seen.size, [&](std::size_t i) { return mask_colour(mask[i] != 0); }));
    }
    return {{"picture", picture_of(seen)}, {"masks", masks}, {"ends", ends(played.scenario, scene, request)}};
  }

 private:
  static std::string picture_of(const Observation& seen) {
    return png(seen.size, [&](std::size_t i) { return pixel_colour(seen, i); });
  }

  Json ends(const Scenario& scenario, const Scene& scene, const PictureRequest& request) {
    Json pictures = Json::array();
    for (const std::string& name : request.engines) {
      Environment* const environment = on(name, scenario);
      if (environment) environment->reset(scene);
      pictures.push_back(environment ? Json(picture_of(environment->step(request.action).observation)) : Json());
    }
    return pictures;
  }

  // Null for an engine that is not there.
  Environment* on(const std::string& engine, const Scenario& scenario) {
    std::unique_ptr<Environment>& made = environments_[{engine, scenario.space.id}];
    if (made) return made.get();
    static const Catalogue catalogue = scan_plugins(plugin_directories());
    try {
      made = make_environment(scenario, load_engine(catalogue.find("engine", engine)));
    } catch (const PluginError&) {
      return nullptr;
    }
    return made.get();
  }

  const Played& cell(const std::string& file) {
    const auto known = cells_.find(file);
    if (known != cells_.end()) return *known->second;
    Cell read = read_cell(read_json(file), file);
    Scenario scenario = read_scenario(read.scenario, file + ": /scenario");
    return *(cells_[file] = std::make_unique<Played>(Played{std::move(read), std::move(scenario)}));
  }

  std::map<std::pair<std::string, std::string>, std::unique_ptr<Environment>> environments_;  // by engine and space
  std::map<std::string, std::unique_ptr<Played>> cells_;                                      // by file
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

// lgabench-worker pictures: what report.html shows of test scenes, as a request on stdin lists them.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/evaluator.hpp>
#include <lgabench/cell/picture.hpp>
#include <lgabench/cli/played_scenes.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/base64.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/job/job.hpp>

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
  const int step = page_step(seen.size);
  return outline({seen.size.rows / step, seen.size.columns / step}, target_pixels(scene, seen));
}

// Its axis perceives in cells of a run alone: such an arm is drawn as its control.
bool is_of_plugin(const Arm& arm) {
  return std::any_of(arm.axes.begin(), arm.axes.end(), [](const PerturbationAxis* axis) { return axis->of_plugin; });
}

class Pictures {
 public:
  // {"picture": PNG, "masks": [PNG, ...], "ends": [PNG, ...], "perturbed": [PNG, PNG], "targets": path,
  // "oracle": action}, pictures in base64: the scene, goal masks of the request's Selections, the scene after each of
  // its actions (null where it could not be carried out, "" where nothing moved), the scene before and after its arm's
  // perturbation, or where that leaves colours alone its ids (null where it leaves both), the targets' outline, and
  // what the oracle would do (null without the cell's engine). @throws InputError where the scene is not the one asked
  // for.
  Json draw(const PictureRequest& request) {
    const PlayedScenes::Played& played = scenes_.cell(request.cell.string());
    const Scene scene = PlayedScenes::scene(played, request.arm, request.index, request.scene);
    const EnvironmentType& type = *played.scenario.environment;
    const Observation seen = type.draw(scene);
    const Arm& arm = played.scenario.arm(request.arm);
    const Perception perception =
        is_of_plugin(arm) ? nullptr : perception_of(played.scenario, arm, played.cell.scenes_of_seed());
    const View view = view_of(played.scenario, scene, played.cell.scenes_of_seed());
    Observation perceived = view == View() ? seen : type.draw(scene, view);
    if (perception) perceived = perception(perceived, scene, 0);
    Json masks = Json::array();
    for (const Json& one : request.selections) {
      const JsonReader selection(one, "selection");
      const auto mask = goal_mask(
          perceived, read_distribution(selection.at("distribution"), played.scenario.space, played.scenario.second),
          selection.at("instances").string() == "first" ? Instances::first : Instances::all);
      masks.push_back(png(seen.size, [&](std::size_t i) { return mask_colour(mask[i] != 0); }));
    }
    const std::string picture = picture_of(seen);
    Json perturbed;  // before the arm's perturbation, and after it
    if (played.scenario.arm(request.arm).perturbation) {
      if (perceived.rgb != seen.rgb)
        perturbed = {picture, picture_of(perceived)};
      else if (perceived.ids != seen.ids)
        perturbed = {ids_of(seen), ids_of(perceived)};
    }
    Json ends = Json::array();
    for (const PictureRequest::End& end : request.ends) {
      ends.push_back(after_actions(played.scenario, scene, end, picture));
    }
    Environment* const environment = scenes_.on(played.cell.engine, played.scenario);
    if (environment) environment->reset(scene);
    return {{"picture", picture},
            {"masks", masks},
            {"ends", ends},
            {"perturbed", perturbed},
            {"targets", targets(scene, seen)},
            {"oracle", environment ? Json(environment->expert_action()) : Json()}};
  }

 private:
  static std::string picture_of(const Observation& seen) {
    return png(seen.size, [&](std::size_t i) { return pixel_colour(seen, i); });
  }

  static std::string ids_of(const Observation& seen) {
    return png(seen.size, [&](std::size_t i) { return id_colour(seen.ids[i]); });
  }

  // The picture after the action, "" where nothing moved; of several steps a list. Null where the engine is not there,
  // or the actions are none of this environment's.
  Json after_actions(const Scenario& scenario, const Scene& scene, const PictureRequest::End& end,
                     const std::string& before) {
    Environment* const environment = scenes_.on(end.engine, scenario);
    if (!environment) return nullptr;
    environment->reset(scene);
    Json pictures = Json::array();
    try {
      carry_out(*environment, scene, end.actions, [&](const StepResult& result) {
        const std::string after = picture_of(result.observation);
        pictures.push_back(after == before ? "" : after);
      });
    } catch (const MethodError&) {
      return nullptr;
    } catch (const InputError&) {
      return nullptr;
    }
    return pictures.size() == 1 ? pictures[0] : pictures;
  }

  PlayedScenes scenes_;
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
    Pictures pictures;
    answer_requests("pictures",
                    [&](const JsonReader& request) { return pictures.draw(read_picture_request(request)); });
  });
}

}  // namespace lgabench::cli

// lgabench-worker strips: episodes as pictures, before and after their action, as a request on stdin lists them.
#include <vector>

#include <lgabench/cell/picture.hpp>
#include <lgabench/cli/played_scenes.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/job/job.hpp>

namespace lgabench::cli {
namespace {

constexpr Rgb black{0, 0, 0}, white{255, 255, 255}, yellow{255, 225, 0};

void draw_line(Picture& picture, Vec2 from, Vec2 to, double radius, const Rgb& colour) {
  constexpr int dots = 200;
  for (int i = 0; i <= dots; ++i) {
    const Vec2 at = from + static_cast<double>(i) / dots * (to - from);
    picture.dot(at.x, at.y, radius, colour);
  }
}

// A ring where the action begins, and a line to where it ends, white on black.
void draw_action(Picture& picture, const std::vector<Vec2>& places) {
  if (places.empty()) return;
  for (const auto& [radius, colour] : {std::pair(2., black), {1., white}})
    draw_line(picture, places.front(), places.back(), radius, colour);
  for (const auto& [radius, colour] : {std::pair(5., black), {4., white}, {2., black}})
    picture.dot(places.front().x, places.front().y, radius, colour);
}

// Left the scene, its targets outlined and the first action drawn; right how it ended. @throws InputError without the
// engine.
std::string strip(PlayedScenes& scenes, const PictureRequest& request, std::size_t most_bytes) {
  const PlayedScenes::Played& played = scenes.cell(request.cell.string());
  const Scene scene = PlayedScenes::scene(played, request.arm, request.index, request.scene);
  const PictureRequest::End& end = request.ends.at(0);
  Environment* const environment = scenes.on(end.engine, played.scenario);
  if (!environment) throw InputError("the run's engine is not installed: " + end.engine);
  const Observation before = environment->reset(scene);
  const ActionSpace& space = played.scenario.environment->action_space();
  const int step = page_step(before.size), columns = before.size.columns / step, rows = before.size.rows / step;
  const auto pixel = [&](int column, int row) {
    return static_cast<std::size_t>(step * row * before.size.columns + step * column);
  };
  const auto is_target = target_pixels(scene, before);
  constexpr int between = 4;
  Picture picture(2 * columns + between, rows);
  picture.paste(0, 0, columns, rows, 1, [&](int x, int y) {
    const bool is_edge =
        is_target(x, y) && !(is_target(x - 1, y) && is_target(x + 1, y) && is_target(x, y - 1) && is_target(x, y + 1));
    return is_edge ? yellow : pixel_colour(before, pixel(x, y));
  });
  std::vector<Vec2> places;
  if (const Action& first = end.actions.at(0); !first.empty())
    for (const PicturePlace& place : space.places)
      places.push_back(1. / step * in_picture(space, place, first, before.size));
  draw_action(picture, places);
  const Observation after = carry_out(*environment, scene, end.actions).observation;
  picture.paste(columns + between, 0, columns, rows, 1, [&](int x, int y) { return pixel_colour(after, pixel(x, y)); });
  return picture.png(most_bytes);
}

}  // namespace

void add_strips(CLI::App& app, int&) {
  CLI::App* verb =
      app.add_subcommand("strips", "Draw episodes listed as JSON on stdin, before and after, a line of JSON each");
  verb->group("");  // `lgabench leaderboard scenes` starts it
  verb->footer(
      "Example: echo '[{\"cell\": \"runs/x/cells/KEY/cell.json\", \"arm\": \"test\", \"index\": 0, \"scene\": "
      "\"HASH\",\n"
      "                \"selections\": [], \"ends\": [{\"engine\": \"mujoco\", \"actions\": [[...]]}], \"out\": "
      "\"a.png\", \"most_bytes\": 18000}]' | lgabench-worker strips");
  verb->callback([] {
    PlayedScenes scenes;
    answer_requests("strips", [&](const JsonReader& request) -> Json {
      const auto most_bytes = static_cast<std::size_t>(request.at("most_bytes").integer(1, 1'000'000));
      write_file(request.at("out").string(), strip(scenes, read_picture_request(request), most_bytes));
      return Json::object();
    });
  });
}

}  // namespace lgabench::cli

#include <lgabench/cli/reading_score.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/abstraction/reading.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/rounding.hpp>
#include <lgabench/core/suggest.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/expand.hpp>

namespace lgabench::cli {
namespace {

struct Score {
  int scenes = 0, exact = 0, objects = 0, segments = 0, types = 0, textures = 0;
};
using Confusions = std::map<std::pair<std::string, std::string>, int>;  // what it is, what was read

// Of each segment, the object that it shows most of, 0 for none, and the share of what both cover.
struct Match {
  std::uint8_t object = 0;
  double overlap = 0;
};
std::array<Match, 256> matches(const Observation& seen, const Observation& read) {
  std::array<std::array<int, 256>, 256> common{};
  std::array<int, 256> of_object{}, of_segment{};
  for (std::size_t i = 0; i < seen.ids.size(); ++i) {
    ++common[read.ids[i]][seen.ids[i]];
    ++of_object[seen.ids[i]];
    ++of_segment[read.ids[i]];
  }
  std::array<Match, 256> all{};
  for (std::size_t segment = 1; segment < all.size(); ++segment)
    for (std::size_t object = 1; object < all.size(); ++object) {
      const int both = common[segment][object];
      const double overlap =
          both == 0 ? 0 : static_cast<double>(both) / (of_object[object] + of_segment[segment] - both);
      if (overlap > all[segment].overlap) all[segment] = {static_cast<std::uint8_t>(object), overlap};
    }
  return all;
}

void add_scene(const Scene& scene, const Observation& seen, const Observation& read, const Meaning& truth, Score& score,
               Confusions& confusions) {
  constexpr double good = .8, same = .5;
  const std::array<Match, 256> shows = matches(seen, read);
  for (const Instance& object : seen.instances) {
    if (object.pixels == 0) continue;
    ++score.objects;
    for (const Instance& one : read.instances) {
      const Match& match = shows[one.id];
      if (match.object != object.id || match.overlap < same) continue;
      score.segments += match.overlap >= good;
      score.types += one.object_type == object.object_type;
      score.textures += one.texture == object.texture;
      if (one.object_type != object.object_type) ++confusions[{object.object_type, one.object_type}];
      if (one.texture != object.texture) ++confusions[{object.texture, one.texture}];
    }
  }
  std::vector<std::uint8_t> kept, meant;  // objects; 0 for a segment that shows none
  for (const std::uint8_t id : grounded(truth, read)) kept.push_back(shows[id].overlap < same ? 0 : shows[id].object);
  for (const SceneObject& object : scene.objects)
    for (const Instance& one : seen.instances)
      if (one.id == object.instance_id && one.pixels > 0 && object.role == role::target) meant.push_back(one.id);
  std::sort(kept.begin(), kept.end());
  std::sort(meant.begin(), meant.end());
  ++score.scenes;
  score.exact += kept == meant;
}

std::string share_of(int part, int of) { return of == 0 ? "-" : fixed(static_cast<double>(part) / of, 3); }

void print_confusions(const Confusions& confusions, const Reading& reading) {
  constexpr std::size_t most = 10;
  std::vector<std::pair<int, std::string>> sorted;
  for (const auto& [names, times] : confusions)
    sorted.emplace_back(times, fmt::format("{} for {}", names.second, names.first));
  std::sort(sorted.begin(), sorted.end(),
            [](const auto& a, const auto& b) { return a.first != b.first ? a.first > b.first : a.second < b.second; });
  if (sorted.empty()) return;
  to_stdout("\nnames{} segments={}: most often read", reading.names == Reading::simulator ? "" : "=" + reading.names,
            reading.segments);
  for (std::size_t i = 0; i < std::min(most, sorted.size()); ++i)
    to_stdout("{} {} ({})", i == 0 ? "" : ",", sorted[i].second, sorted[i].first);
  to_stdout("\n");
}

}  // namespace

void print_reading_scores(const Suite& suite, Truth truth, int scenes, bool json, const std::vector<std::string>& names,
                          const std::vector<std::string>& segments) {
  std::vector<std::string> known{Reading::simulator};
  known.insert(known.end(), names_read().begin(), names_read().end());
  for (const std::string& one : names)
    if (std::find(known.begin(), known.end(), one) == known.end())
      throw InputError(fmt::format("--names: {}, and no plugin's", none_named("names", one, known)));
  for (const std::string& one : segments)
    if (one != Reading::simulator && one != Reading::difference)
      throw InputError("--segments: " + none_named("segments", one, {Reading::simulator, Reading::difference}));
  if (!json)
    to_stdout(
        "{} scenes of each arm of each scenario; the true Selections\n\n{:<14} {:<10} {:<20} {:>6}  {:>7}  {:>8}  "
        "{:>7}  {:>8}\n",
        scenes, "names", "segments", "arm", "exact", "objects", "segments", "types", "textures");
  const std::vector<std::string> simulator{Reading::simulator};
  for (const std::string& of_names : names.empty() ? simulator : names)
    for (const std::string& of_segments : segments.empty() ? simulator : segments) {
      const Reading reading{of_names, of_segments};
      std::vector<std::pair<std::string, Score>> arms;  // in the order in which scenarios first have them
      Confusions confusions;
      for (const std::string& id : suite_scenario_ids(suite, suite.design)) {
        const Scenario scenario = suite_scenario(suite, id, truth);
        if (const std::string why = why_not_read(scenario, reading); !why.empty())
          throw InputError(fmt::format("{}: scenario {}: {}", suite.id, id, why));
        const ReadPicture read = reading_of(scenario, reading);
        const EnvironmentType& environment = find_environment(scenario.environment);
        for (const Arm& arm : scenario.tests) {
          auto row = std::find_if(arms.begin(), arms.end(), [&](const auto& one) { return one.first == arm.id; });
          if (row == arms.end()) row = arms.insert(arms.end(), {arm.id, {}});
          const Perception perceived = perception_of(scenario, arm);
          for (int i = 0; i < scenes; ++i) {
            const Scene scene = test_scene(scenario, suite.design.layouts.front(), arm.id, suite.design.scene_seed, i);
            Observation seen = environment.draw(scene, view_of(scenario, scene));
            const Observation shown = perceived ? perceived(seen, scene) : seen;
            const Meaning& meant = scenario.commands[static_cast<std::size_t>(scene.command)].truth.target;
            add_scene(scene, seen, read ? read(shown, scene) : shown, meant, row->second, confusions);
          }
        }
      }
      for (const auto& [arm, score] : arms)
        if (json)
          to_stdout("{}\n", canonical({{"names", reading.names},
                                       {"segments", reading.segments},
                                       {"arm", arm},
                                       {"scenes", score.scenes},
                                       {"exact_scenes", score.exact},
                                       {"objects", score.objects},
                                       {"segments_right", score.segments},
                                       {"types_right", score.types},
                                       {"textures_right", score.textures}}));
        else
          to_stdout("{:<14} {:<10} {:<20} {:>6}  {:>7}  {:>8}  {:>7}  {:>8}\n", reading.names, reading.segments, arm,
                    share_of(score.exact, score.scenes), score.objects, share_of(score.segments, score.objects),
                    share_of(score.types, score.objects), share_of(score.textures, score.objects));
      if (!json) print_confusions(confusions, reading);
    }
}

}  // namespace lgabench::cli

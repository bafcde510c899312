#include <lgabench/cli/reading_score.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/abstraction/reading.hpp>
#include <lgabench/abstraction/scene_score.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/picture.hpp>
#include <lgabench/cli/open_questions.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/rounding.hpp>
#include <lgabench/core/suggest.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/counted_progress.hpp>
#include <lgabench/harness/suite_scenario.hpp>

namespace lgabench::cli {
namespace {

struct Score {
  SceneScore kept{};
  int objects = 0, segments = 0, types = 0, textures = 0, unanswered = 0;
  SelectionCost cost{};
  std::string model{};  // who looked
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

void add_reading(const Scene& scene, const Observation& seen, const Observation& read,
                 const std::vector<std::uint8_t>& kept_segments, Score& score, Confusions& confusions) {
  constexpr double good = .8, same = .5;
  const std::array<Match, 256> shows = matches(seen, read);
  for (const Instance& object : seen.instances) {
    if (object.pixels == 0) continue;
    ++score.objects;
    for (const Instance& one : read.instances) {
      const Match& match = shows[one.id];
      if (match.object != object.id || match.overlap < same) continue;
      score.segments += match.overlap >= good;
      if (one.object_type.empty()) continue;  // looked at, and not named
      score.types += one.object_type == object.object_type;
      score.textures += one.texture == object.texture;
      if (one.object_type != object.object_type) ++confusions[{object.object_type, one.object_type}];
      if (one.texture != object.texture) ++confusions[{object.texture, one.texture}];
    }
  }
  std::vector<std::uint8_t> kept;  // objects
  bool astray = false;             // a segment that shows none of the scene's, or one that another segment shows
  for (const std::uint8_t segment : kept_segments) {
    const Match& match = shows[segment];
    const bool is_object = std::any_of(scene.objects.begin(), scene.objects.end(),
                                       [&](const SceneObject& one) { return one.instance_id == match.object; });
    if (match.overlap < same || !is_object || contains(kept, match.object))
      astray = true;
    else
      kept.push_back(match.object);
  }
  add_scene(scene, seen, kept, astray, score.kept);
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

// Each segment without a name, in the order of the ids, which is that of the marks.
std::vector<Instance> unnamed(const Observation& seen) {
  std::array<bool, 256> there{};
  for (const std::uint8_t id : seen.ids) there[id] = true;
  std::vector<Instance> all;
  for (std::size_t id = 1; id < there.size(); ++id)
    if (there[id]) all.push_back({static_cast<std::uint8_t>(id), "", "", 0});
  return all;
}

// The segments that the model takes the command to mean. Nothing where it has no answer, which is told; what asking
// cost counts in both cases.
std::optional<std::vector<std::uint8_t>> looked_at(ChatLanguageModel& model, const Command& command,
                                                   const Observation& read, Score& score, OpenQuestions& open,
                                                   const std::string& where) {
  std::vector<std::uint8_t> ids;
  for (const Instance& one : read.instances) ids.push_back(one.id);
  const Observation large = marked(read, ids);
  Picture picture(large.size.columns, large.size.rows);
  picture.paste(0, 0, large.size.columns, large.size.rows, 1, [&large](int column, int row) {
    return pixel_colour(large, static_cast<std::size_t>(row) * static_cast<std::size_t>(large.size.columns) +
                                   static_cast<std::size_t>(column));
  });
  const SelectionCost before = model.cost();
  const auto kept = open.answered(
      [&] {
        std::vector<std::uint8_t> segments;
        for (const int mark : model.look(command, picture.png(), static_cast<int>(ids.size())))
          segments.push_back(ids[static_cast<std::size_t>(mark) - 1]);
        return segments;
      },
      where);
  score.cost += model.cost() - before;
  score.model = model.model();
  score.unanswered += !kept;
  return kept;
}

void print_row(const Reading& reading, const std::string& arm, const Score& score, bool json) {
  const bool by_model = reading.names == looked;
  if (json) {
    Json row{{"names", reading.names},
             {"segments", reading.segments},
             {"arm", arm},
             {"scenes", score.kept.scenes},
             {"exact_scenes", score.kept.exact_scenes},
             {"objects", score.objects},
             {"segments_right", score.segments}};
    if (by_model)
      row.update({{"model", score.model},
                  {"unanswered", score.unanswered},
                  {"lm_queries", score.cost.lm_queries},
                  {"lm_tokens", score.cost.lm_tokens},
                  {"lm_seconds", score.cost.lm_seconds}});
    else
      row.update({{"types_right", score.types}, {"textures_right", score.textures}});
    return to_stdout("{}\n", canonical(row));
  }
  const auto named = [&](int right) { return by_model ? "-" : share_of(right, score.objects); };
  to_stdout("{:<14} {:<10} {:<20} {:>6}  {:>7}  {:>8}  {:>7}  {:>8}", reading.names, reading.segments, arm,
            share_of(score.kept.exact_scenes, score.kept.scenes), score.objects,
            share_of(score.segments, score.objects), named(score.types), named(score.textures));
  if (by_model)
    to_stdout("  {} questions, {} tokens, {:.1f} s, {}", score.cost.lm_queries, score.cost.lm_tokens,
              score.cost.lm_seconds, score.model);
  if (score.unanswered > 0)
    to_stdout("; {} of {} scenes have no answer", score.unanswered, score.unanswered + score.kept.scenes);
  to_stdout("\n");
}

// Of one reading.
int scenes_of(const Suite& suite, Truth truth, const ReadingArguments& a) {
  int scenes = 0;
  for (const std::string& id : suite_scenario_ids(suite, suite.design))
    for (const Arm& arm : suite_scenario(suite, id, truth).tests)
      if (a.arms.empty() || contains(a.arms, arm.id)) scenes += a.scenes;
  return scenes;
}

void expect_known(const Suite& suite, Truth truth, const ReadingArguments& a) {
  std::vector<std::string> known{Reading::simulator}, arms;
  known.insert(known.end(), names_read().begin(), names_read().end());
  known.emplace_back(looked);
  for (const std::string& one : a.names)
    if (!contains(known, one))
      throw InputError(fmt::format("--names: {}, and no plugin's", none_named("names", one, known)));
  for (const std::string& one : a.segments)
    if (one != Reading::simulator && one != Reading::difference)
      throw InputError("--segments: " + none_named("segments", one, {Reading::simulator, Reading::difference}));
  for (const std::string& id : suite_scenario_ids(suite, suite.design))
    for (const Arm& arm : suite_scenario(suite, id, truth).tests)
      if (!contains(arms, arm.id)) arms.push_back(arm.id);
  for (const std::string& one : a.arms)
    if (!contains(arms, one)) throw InputError("--arms: " + none_named("arm", one, arms));
}

}  // namespace

void print_reading_scores(const Suite& suite, Truth truth, const ReadingArguments& a, ChatLanguageModel* model) {
  expect_known(suite, truth, a);
  if (!a.json)
    to_stdout(
        "{} scenes of each arm of each scenario; the true Selections\n\n{:<14} {:<10} {:<20} {:>6}  {:>7}  {:>8}  "
        "{:>7}  {:>8}\n",
        a.scenes, "names", "segments", "arm", "exact", "objects", "segments", "types", "textures");
  const std::vector<std::string> simulator{Reading::simulator};
  OpenQuestions open;
  const std::vector<std::string>&names = a.names.empty() ? simulator : a.names,
        &segments = a.segments.empty() ? simulator : a.segments;
  CountedProgress progress("scenes scored:",
                           static_cast<int>(names.size() * segments.size()) * scenes_of(suite, truth, a));
  for (const std::string& of_names : names)
    for (const std::string& of_segments : segments) {
      const Reading reading{of_names, of_segments};
      const bool by_model = of_names == looked;
      const Reading by_reader = by_model ? Reading{Reading::simulator, of_segments} : reading;
      std::vector<std::pair<std::string, Score>> arms;  // in the order in which scenarios first have them
      Confusions confusions;
      for (const std::string& id : suite_scenario_ids(suite, suite.design)) {
        const Scenario scenario = suite_scenario(suite, id, truth);
        if (const std::string why = why_not_read(scenario, by_reader); !why.empty())
          throw InputError(fmt::format("{}: scenario {}: {}", suite.id, id, why));
        const ReadPicture read = reading_of(scenario, by_reader);
        const EnvironmentType& environment = *scenario.environment;
        for (const Arm& arm : scenario.tests) {
          if (!a.arms.empty() && !contains(a.arms, arm.id)) continue;
          auto row = std::find_if(arms.begin(), arms.end(), [&](const auto& one) { return one.first == arm.id; });
          if (row == arms.end()) row = arms.insert(arms.end(), {arm.id, {}});
          const Perception perceived = perception_of(scenario, arm);
          for (int i = 0; i < a.scenes; ++i) {
            const Scene scene = test_scene(scenario, suite.design.layouts.front(), arm.id, suite.design.scene_seed, i);
            Observation seen = environment.draw(scene, view_of(scenario, scene));
            const Observation shown = perceived ? perceived(seen, scene, 0) : seen;
            Observation there = read ? read(shown, scene) : shown;
            if (by_model) there.instances = unnamed(there);
            const auto kept =
                by_model ? looked_at(*model, scenario.command(scene.command), there, row->second, open,
                                     fmt::format("{}, {}, scene {}: ", id, arm.id, i))
                         : grounded(scenario.commands[static_cast<std::size_t>(scene.command)].truth.target, there);
            if (kept) add_reading(scene, seen, there, *kept, row->second, confusions);
            progress.tell_next();
          }
        }
      }
      for (const auto& [arm, score] : arms) print_row(reading, arm, score, a.json);
      if (!a.json) print_confusions(confusions, reading);
    }
  open.expect_none("scenes have no answer and are in no mean");
}

}  // namespace lgabench::cli

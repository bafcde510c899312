#include <tabletop/cue.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include <common/objects.hpp>

#include <lgabench/core/contains.hpp>

namespace lgabench::tabletop {
namespace {

constexpr double near_m = .10;  // of the centre of what it lies beside: a policy sees no farther
constexpr double far_m = .20;   // from the target's, where it lies beside another one
constexpr int most_cues = 3;
constexpr double widest_m = .10;  // of the types that are drawn

// Why no object of that look may be the cue, else "".
std::string taken(const Scenario& scenario, const Content& content, const std::string& type,
                  const std::string& texture) {
  const auto holds = [&](const std::vector<FeatureSet>& sets) { return any_contains(sets, type, texture); };
  for (const ScenarioCommand& command : scenario.commands) {
    const Meaning& truth = command.truth.target;
    if (truth.belongs(type, texture) || (truth.which && truth.which->of && truth.which->of->contains(type, texture)))
      return fmt::format("what \"{}\" means", command.utterance);
  }
  if (content.words && content.words->belongs(type, texture)) return "\"words\"";
  if (holds(content.undecided)) return "\"undecided\"";
  if (holds(content.near_miss_sets)) return "\"near_miss_sets\"";
  if (content.never_distractor && content.never_distractor->contains(type, texture)) return "\"never_distractor\"";
  return type == goal_type ? "what things are brought to" : "";
}

FeatureSet drawn_look(const JsonReader& reader, const Scenario& scenario, const Content& content) {
  std::vector<FeatureSet> all;
  for (const std::string& type : scenario.space.object_types) {
    const Vec2 size = common::object_model(type).size_m;
    if (std::max(size.x, size.y) > widest_m) continue;
    for (const std::string& texture : scenario.space.textures)
      if (taken(scenario, content, type, texture).empty()) all.push_back({{type}, {texture}});
  }
  if (all.empty()) reader.fail("a scenario whose commands leave out a small object");
  RandomStream random("cue/" + scenario.id);
  return all[random.below(static_cast<std::uint32_t>(all.size()))];
}

Cue read_look(const JsonReader& reader, const Scenario& scenario, const Content& content) {
  if (reader.json() == Json(true)) return {drawn_look(reader, scenario, content)};
  if (!reader.json().is_object()) reader.fail("true, or an object");
  reader.only({"object_type", "texture", "count"});
  const int count = reader.has("count") ? static_cast<int>(reader.at("count").integer(1, most_cues)) : 1;
  if (!reader.has("object_type") && !reader.has("texture")) return {drawn_look(reader, scenario, content), count};
  const auto name = [](const JsonReader& one, const char* what, const std::vector<std::string>& known) {
    if (!contains(known, one.string())) one.fail(fmt::format("{} of the feature space", what));
    return one.string();
  };
  const std::string type = name(reader.at("object_type"), "an object type", scenario.space.object_types);
  const std::string texture = name(reader.at("texture"), "a texture", scenario.space.textures);
  if (const std::string by = taken(scenario, content, type, texture); !by.empty())
    reader.fail("an object outside of " + by);
  return {{{type}, {texture}}, count};
}

bool is_cue(const Cue& cue, const SceneObject& object) { return cue.look.contains(object.object_type, object.texture); }

}  // namespace

Cue read_cue(const JsonReader& scenes, const JsonReader& file, const Scenario& scenario, const Content& content,
             bool training) {
  const JsonReader reader = scenes.at("cue");
  const int most = find_task(scenario.task).most_distractors();
  if (most <= 2) reader.fail("the task pick_and_place, whose scenes have room for it");
  if (content.distractors.first == 0) reader.fail("\"distractors\" beside it, one or more");
  if (training && scenario.as_method_asks) reader.fail("\"as_method_asks\": false beside it");
  if (!training && (!file.has("train") || !file.at("train").has("cue"))) reader.fail("\"cue\" in \"train\"");
  Cue cue = read_look(training ? reader : file.at("train").at("cue"), scenario, content);
  if (content.others() + cue.count > most)
    reader.fail(fmt::format("at most {} \"distractors\" beside it",
                            content.distractors.second + most - content.others() - cue.count));
  if (training) return cue;
  static const std::map<std::string, Cue::Place> places{
      {"kept", Cue::Place::kept}, {"moved", Cue::Place::moved}, {"gone", Cue::Place::gone}};
  const auto place = places.find(reader.string());
  if (place == places.end()) reader.fail("kept, moved or gone");
  cue.place = place->second;
  return cue;
}

bool add_cue(const Task& task, const Layout& layout, const Cue& cue, std::vector<SceneObject>& objects,
             RandomStream random) {
  const std::size_t others = objects.size();
  const Room room = [&](const SceneObject& target) { return task.room(layout, target); };
  const SceneObject one{cue.look.object_types.front(), cue.look.textures.front(), role::distractor, {}, 0, 0};
  const auto beside = [&](std::size_t i) {
    std::vector<SceneObject> all = objects;
    for (int n = 0; n < cue.count; ++n) {
      all.push_back(one);
      if (!place_beside(layout, room, all, i, near_m, far_m, random)) return std::vector<SceneObject>();
    }
    return all;
  };
  std::vector<SceneObject> kept = beside(0), moved;
  for (std::size_t i = 1; i < others && !kept.empty() && moved.empty(); ++i) moved = beside(i);
  if (moved.empty()) return false;
  objects = std::move(cue.place == Cue::Place::moved ? moved : kept);
  return true;
}

void place_with_cue(const Task& task, const Layout& layout, const Content& content, std::vector<SceneObject>& objects,
                    const Streams& stream) {
  if (!content.cue) return task.place(layout, content, objects, stream);
  constexpr int placements = 40;
  for (int n = 0; n < placements; ++n) {
    task.place(layout, content, objects,
               [&](const std::string& purpose) { return stream(n == 0 ? purpose : fmt::format("{}/{}", purpose, n)); });
    if (add_cue(task, layout, *content.cue, objects, stream(fmt::format("cue/{}", n)))) return;
  }
  throw NoRoom(fmt::format("layout {}: no room found for the cue in {} placements", layout.id, placements));
}

void take_cue_away(const Cue& cue, std::vector<SceneObject>& objects) {
  objects.erase(std::remove_if(objects.begin(), objects.end(), [&cue](const auto& one) { return is_cue(cue, one); }),
                objects.end());
  for (std::size_t i = 0; i < objects.size(); ++i) objects[i].instance_id = static_cast<std::uint8_t>(i + 1);
}

}  // namespace lgabench::tabletop

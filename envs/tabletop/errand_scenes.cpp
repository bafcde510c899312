#include <tabletop/errand_scenes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include <common/scene_members.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/sampling.hpp>
#include <tabletop/errand.hpp>
#include <tabletop/errand_tables.hpp>
#include <tabletop/task.hpp>

namespace lgabench::tabletop {

struct Errands {
  std::string scenes_of;                                    // the scenario in whose name scenes are drawn
  std::vector<Meaning> pair;                                // in the order in which scenes give them
  std::shared_ptr<const std::vector<ErrandClass>> classes;  // one list for training and all arms
  std::vector<std::size_t> class_of;                        // of each command
  std::vector<std::pair<int, int>> needed;                  // takes of the one and of the other; none in training
  bool appears = false;
  bool training = false;
  bool refusing = false;  // one command and class: what is meant may not be there
  bool is_there = false;  // then, in tests; in training it is in every other scene
};

namespace {

constexpr int tries = 20'000;

// The pair that the command's, or two of the commands, are of.
std::vector<Meaning> read_pair(const Scenario& scenario, const JsonReader& file) {
  const std::vector<JsonReader> commands = file.at("commands").elements();
  std::vector<Meaning> pair;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const Meaning& target = scenario.commands[i].truth.target;
    if (target.turns.empty()) commands[i].at("truth").at("target").fail("\"turns\": how the objects are used");
    if (!scenario.commands[i].seen) pair.push_back(target);
  }
  if (!file.has("pair")) {
    if (pair.size() != 2 || pair[0] == pair[1])
      file.at("commands").fail("two commands with \"seen\": false of different meanings, or a \"pair\" beside them");
    return pair;
  }
  const JsonReader given = file.at("pair");
  if (commands.size() != 1) file.at("commands").fail("one command beside \"pair\"");
  pair.clear();
  for (const JsonReader& one : given.elements()) {
    pair.push_back(read_meaning(one, scenario.space));
    if (pair.back().turns.empty()) one.fail("\"turns\": how the objects are used");
  }
  if (pair.size() != 2 || pair[0] == pair[1]) given.fail("two meanings");
  if (!contains(pair, scenario.commands.front().truth.target)) given.fail("the command's meaning as one of them");
  return pair;
}

bool same_sets(const std::vector<FeatureSet>& a, const std::vector<FeatureSet>& b) {
  return std::is_permutation(a.begin(), a.end(), b.begin(), b.end());
}

std::vector<FeatureSet> read_list(const JsonReader& reader, const FeatureSpace& space) {
  std::vector<FeatureSet> sets;
  for (const JsonReader& set : reader.elements()) sets.push_back(read_feature_set(set, space));
  return sets;
}

// What scenes can show of the parts' sets, of what is near them, and of all else; of what is undecided nothing.
ErrandClass pools_of(const std::vector<std::vector<FeatureSet>>& parts, const std::vector<FeatureSet>& near,
                     const std::vector<FeatureSet>& undecided, const FeatureSpace& space) {
  ErrandClass all;
  for (const std::vector<FeatureSet>& part : parts) all.sets.insert(all.sets.end(), part.begin(), part.end());
  all.members.resize(parts.size());
  all.others.resize(1);
  for (const std::string& type : space.object_types) {
    if (!can_show(type, Content::widest_in_crowd_m)) continue;
    for (const std::string& texture : space.textures) {
      if (any_contains(undecided, type, texture)) continue;
      for (std::size_t i = 0; i < parts.size(); ++i)
        if (any_contains(parts[i], type, texture)) all.members[i].add(type, texture);
      if (any_contains(all.sets, type, texture)) continue;
      all.others.front().add(type, texture);
      if (any_contains(near, type, texture)) all.near.add(type, texture);
    }
  }
  return all;
}

bool shows_all(const std::vector<Pool>& parts) {
  return !parts.empty() && std::none_of(parts.begin(), parts.end(), [](const Pool& part) { return part.empty(); });
}

ErrandClass read_class(const JsonReader& reader, const Scenario& scenario) {
  reader.only({"parts", "near_miss_sets", "undecided", "belong"});
  std::vector<std::vector<FeatureSet>> parts;
  for (const JsonReader& part : reader.at("parts").elements()) parts.push_back(read_list(part, scenario.space));
  ErrandClass read = pools_of(parts, read_list(reader.at("near_miss_sets"), scenario.space),
                              read_list(reader.at("undecided"), scenario.space), scenario.space);
  read.belong = read_distractors(reader.at("belong"), test_things - 1);
  if (read.belong.first == 0) reader.at("belong").fail("one that belongs, at least");
  if (!shows_all(read.members)) reader.at("parts").fail("lists of sets of what scenes can show");
  if (read.near.empty()) reader.at("near_miss_sets").fail("what scenes can show and no command of the class means");
  return read;
}

void read_classes(const Scenario& scenario, const JsonReader& file, Errands& errands) {
  std::vector<ErrandClass> classes;
  for (const JsonReader& one : file.at("classes").elements()) classes.push_back(read_class(one, scenario));
  const auto class_of = [&classes](const Meaning& meaning, const JsonReader& place) {
    const auto found = std::find_if(classes.begin(), classes.end(),
                                    [&](const ErrandClass& one) { return same_sets(one.sets, meaning.sets); });
    if (found == classes.end()) place.fail("the sets of all parts of one of \"classes\"");
    return static_cast<std::size_t>(found - classes.begin());
  };
  const std::vector<JsonReader> commands = file.at("commands").elements();
  for (std::size_t i = 0; i < commands.size(); ++i)
    errands.class_of.push_back(class_of(scenario.commands[i].truth.target, commands[i].at("truth").at("target")));
  const JsonReader place = file.at(file.has("pair") ? "pair" : "commands");
  if (class_of(errands.pair[0], place) != class_of(errands.pair[1], place)) place.fail("a pair of one class");

  std::vector<std::vector<Pool>> meant;  // by commands of other classes
  for (std::size_t i = 0; i < classes.size(); ++i) {
    meant.emplace_back();
    const Pool& all = classes[i].others.front();
    for (std::size_t k = 0; k < classes.size(); ++k) {
      if (k == i) continue;
      Pool pool = all.only([&](const Named& one) {
        const std::vector<Pool>& members = classes[k].members;
        return std::any_of(members.begin(), members.end(), [&one](const Pool& part) { return part.holds(one); });
      });
      if (!pool.empty()) meant.back().push_back(std::move(pool));
    }
  }
  for (std::size_t i = 0; i < meant.size(); ++i)
    if (!meant[i].empty()) classes[i].others = std::move(meant[i]);
  errands.classes = std::make_shared<const std::vector<ErrandClass>>(std::move(classes));
}

void read_needed(const JsonReader& reader, Errands& errands) {
  const int most = errands.appears ? 4 : 5;  // one step less than there are says that nothing is left to do
  for (const JsonReader& one : reader.elements()) {
    const std::vector<JsonReader> takes = one.elements();
    if (takes.size() != 2) one.fail("takes of the one and of the other command");
    const auto number = [&](const JsonReader& n) { return static_cast<int>(n.integer(errands.appears ? 1 : 0, most)); };
    errands.needed.emplace_back(number(takes[0]), number(takes[1]));
  }
  if (errands.needed.empty()) reader.fail("at least one pair of numbers");
}

// A command that means one thing, which may not be there.
void read_to_refuse(const Scenario& scenario, const JsonReader& file, Errands& errands) {
  const std::vector<JsonReader> commands = file.at("commands").elements();
  const Meaning& meant = scenario.commands.front().truth.target;
  if (commands.size() != 1) file.at("commands").fail("one command");
  if (meant.which || !meant.turns.empty()) commands.front().at("truth").at("target").fail("sets of objects alone");
  ErrandClass all =
      pools_of({meant.sets}, read_list(file.at("near_miss_sets"), scenario.space),
               file.has("undecided") ? read_list(file.at("undecided"), scenario.space) : std::vector<FeatureSet>(),
               scenario.space);
  if (!shows_all(all.members)) commands.front().at("truth").at("target").fail("sets of what scenes can show");
  if (all.near.empty()) file.at("near_miss_sets").fail("what scenes can show and the command does not mean");
  errands.classes = std::make_shared<const std::vector<ErrandClass>>(1, std::move(all));
  errands.class_of.push_back(0);
}

// What training and all arms have in common.
std::shared_ptr<const Errands> read_training(const Scenario& scenario, const JsonReader& file) {
  auto errands = std::make_shared<Errands>();
  errands->scenes_of = file.has("scenes_of") ? file.at("scenes_of").string() : scenario.id;
  errands->training = true;
  errands->refusing = find_task(scenario.task).most_steps() == 1;
  if (errands->refusing) {
    read_to_refuse(scenario, file, *errands);
  } else {
    errands->pair = read_pair(scenario, file);
    read_classes(scenario, file, *errands);
  }
  return errands;
}

}  // namespace

std::shared_ptr<const Errands> read_errands(const Scenario& scenario, const JsonReader& file, const JsonReader* scenes,
                                            bool training) {
  if (training) return read_training(scenario, file);
  auto errands = std::make_shared<Errands>(*content_of(*scenario.train).errands);
  errands->training = false;
  if (errands->refusing) {
    errands->is_there = scenes->at("is_there").boolean();
    return errands;
  }
  const bool unseen = scenes->has("unseen") && scenes->at("unseen").boolean();
  if (unseen == file.has("pair"))
    scenes->at("arm").fail(unseen ? "no \"unseen\" where a \"pair\" is given" : "\"unseen\": true beside it");
  errands->appears = scenes->has("appears") && scenes->at("appears").boolean();
  read_needed(scenes->at("needed"), *errands);
  return errands;
}

int objects_of(const Errands& errands) {
  return (errands.training ? training_things : test_things) + (errands.appears ? 1 : 0);
}

namespace {

// The table's things where they find room, all on the pallet too, since any may be brought. Of a table to refuse, both
// that may stand in the last one's place do, and the others' places are the same with either.
std::vector<SceneObject> placed_things(const Scenario& scenario, const SceneRequest& request, const Things& table,
                                       bool meant_is_there, const Streams& stream) {
  const Content& content = content_of(scenario, request.arm);
  const Task& task = find_task(scenario.task);
  const Layout layout = find_layout(task, request.layout);
  const auto object = [](const Named& name, const Role& role) {
    return SceneObject{name.object_type, name.texture, role, {}, 0, 0};
  };
  std::vector<Named> names = table.things;
  if (table.later) names.push_back(*table.later);
  if (table.meant) names.pop_back();
  std::vector<SceneObject> objects;
  const std::vector<int> order = stream("order").permutation(static_cast<int>(names.size()));
  for (const int i : order) objects.push_back(object(names[static_cast<std::size_t>(i)], role::target));
  task.place(layout, content, objects, stream);
  objects.push_back({goal_type, goal_texture, role::goal, *layout.pallet, 0, 0});
  if (table.meant) {
    const auto with = [&](const Named& last) {
      std::vector<SceneObject> all = objects;
      all.push_back(object(last, role::target));
      RandomStream random = stream("last");
      const Room room = [&](const SceneObject& one) { return task.room(layout, one); };
      if (!place_last(room, all, random)) throw NoRoom("no room for the thing that is exchanged");
      return all;
    };
    std::vector<SceneObject> one = with(table.things.back()), other = with(*table.meant);
    objects = std::move(meant_is_there ? other : one);
  }
  for (std::size_t i = 0; i < order.size(); ++i)
    objects[i].role = static_cast<std::size_t>(order[i]) < table.things.size() ? role::distractor : role::later;
  if (table.meant) objects.back().role = role::distractor;
  return objects;
}

// What is not there yet has the last id: a gap would tell that something comes.
void let_later_be_last(std::vector<SceneObject>& objects) {
  const auto later = std::find_if(objects.begin(), objects.end(),
                                  [](const SceneObject& object) { return object.role == role::later; });
  if (later == objects.end()) return;
  std::swap(later->instance_id, objects.back().instance_id);
  std::iter_swap(later, objects.end() - 1);
}

}  // namespace

Scene errand_scene(const Scenario& scenario, const SceneRequest& request, int index) {
  Scene scene = without_objects(scenario, request, index);
  const Errands& errands = *content_of(scenario, request.arm).errands;
  const auto command = static_cast<std::size_t>(scene.command);
  const auto commands = static_cast<int>(scenario.commands_of(request.arm).size());
  scene.errand = scenario.commands[command].truth.target;
  if (!errands.training && !errands.refusing) scene.pair = index / commands;
  const Streams stream = streams_of(errands.scenes_of, request, scene.drawn_as());
  const bool is_there = errands.training ? index / commands % 2 == 0 : errands.is_there;

  RandomStream random = stream("errand");
  const auto draw = [&]() -> std::optional<Things> {
    const ErrandClass& of = (*errands.classes)[errands.class_of[command]];
    if (errands.refusing) return draw_to_refuse(of, objects_of(errands), random);
    if (errands.training) return draw_training(of, *scene.errand, random);
    const std::size_t which = static_cast<std::size_t>(*scene.pair) % errands.needed.size();
    return draw_test(of, errands.pair, errands.needed[which], errands.appears, random);
  };
  int placements = 0;
  for (int n = 0; n < tries && scene.objects.empty(); ++n) {
    const std::optional<Things> table = draw();
    if (!table) continue;
    ++placements;
    const auto once_more = [&](const std::string& purpose) {
      return stream(fmt::format("{}/{}", purpose, placements));
    };
    try {
      scene.objects = placed_things(scenario, request, *table, is_there, once_more);
    } catch (const NoRoom&) {
      continue;
    }
  }
  if (scene.objects.empty())
    throw NothingToShow(fmt::format("scenario \"{}\", arm {}: expected a scene that shows how \"{}\" is meant",
                                    scenario.id, request.arm, scenario.commands[command].utterance));
  permute_ids(scene.objects, stream("ids"));
  let_later_be_last(scene.objects);
  for (const std::size_t i : Errand(scene).wanted()) scene.objects[i].role = role::target;
  return scene;
}

}  // namespace lgabench::tabletop

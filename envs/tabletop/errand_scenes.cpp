#include <tabletop/errand_scenes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include <common/scene_members.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/sampling.hpp>
#include <lgabench/core/turns.hpp>
#include <tabletop/errand.hpp>
#include <tabletop/task.hpp>

namespace lgabench::tabletop {
namespace {

constexpr int test_things = 7, training_things = 5;
constexpr std::pair<int, int> training_members{2, 3};

bool holds(const std::vector<FeatureSet>& sets, const Named& one) {
  return std::any_of(sets.begin(), sets.end(),
                     [&one](const FeatureSet& set) { return set.contains(one.object_type, one.texture); });
}

// Things to draw from: a type with equal odds, then a texture.
class Pool {
 public:
  void add(const std::string& type, const std::string& texture) {
    if (types_.empty() || types_.back() != type) {
      types_.push_back(type);
      textures_.emplace_back();
    }
    textures_.back().push_back(texture);
  }
  bool empty() const { return types_.empty(); }
  bool holds(const Named& one) const {
    const auto found = std::find(types_.begin(), types_.end(), one.object_type);
    return found != types_.end() && contains(textures_[static_cast<std::size_t>(found - types_.begin())], one.texture);
  }

  Named draw(RandomStream& random) const {
    const auto type = random.below(static_cast<std::uint32_t>(types_.size()));
    return {types_[type], any_of(textures_[type], random)};
  }
  template <class Which>
  Pool only(const Which& which) const {
    Pool some;
    for (std::size_t i = 0; i < types_.size(); ++i)
      for (const std::string& texture : textures_[i])
        if (which(Named{types_[i], texture})) some.add(types_[i], texture);
    return some;
  }
  // Of its type or, as often, of its texture, where there are such.
  Named draw_like(const Named& other, RandomStream& random) const {
    std::vector<std::size_t> like;
    const bool by_type = random.coin();
    for (std::size_t i = 0; i < types_.size(); ++i)
      if (by_type ? types_[i] == other.object_type : contains(textures_[i], other.texture)) like.push_back(i);
    if (like.empty()) return draw(random);
    const std::size_t type = like[random.below(static_cast<std::uint32_t>(like.size()))];
    return {types_[type], by_type ? any_of(textures_[type], random) : other.texture};
  }

 private:
  std::vector<std::string> types_;
  std::vector<std::vector<std::string>> textures_;  // of each type
};

const Named& one_of(const std::vector<Named>& things, RandomStream& random) {
  return things[random.below(static_cast<std::uint32_t>(things.size()))];
}

}  // namespace

// What some commands are about, and what else stands on their tables.
struct ErrandClass {
  std::vector<FeatureSet> sets;
  std::vector<Pool> members;     // of each of its parts: what turns of their own take
  Pool near;                     // what is nearly a member
  std::vector<Pool> others;      // what commands of each other class mean; where there is none, all else
  std::pair<int, int> belong{};  // so many members, fewest and most, stand in a test scene
};

struct Errands {
  std::string scenes_of;      // the scenario in whose name scenes are drawn
  std::vector<Meaning> pair;  // in the order in which scenes give them
  std::vector<ErrandClass> classes;
  std::vector<std::size_t> class_of;  // of each command
  std::size_t class_of_pair = 0;
  std::vector<std::pair<int, int>> needed;  // takes of the one and of the other; none in training
  bool appears = false;
  bool training = false;
};

namespace {

struct Things {
  std::vector<Named> things;
  std::optional<Named> later;
};

int between(std::pair<int, int> fewest_and_most, RandomStream& random) {
  const auto [fewest, most] = fewest_and_most;
  return fewest + static_cast<int>(random.below(static_cast<std::uint32_t>(most - fewest + 1)));
}

// Half of them share the type or the texture of one before, so that some kind is there twice.
Named draw_member(const ErrandClass& of, const std::vector<Named>& before, RandomStream& random) {
  const Pool& pool = of.members[random.below(static_cast<std::uint32_t>(of.members.size()))];
  std::vector<Named> alike;
  std::copy_if(before.begin(), before.end(), std::back_inserter(alike), [&](const Named& o) { return pool.holds(o); });
  if (alike.empty() || random.coin()) return pool.draw(random);
  const Named other = one_of(alike, random);
  return pool.draw_like(other, random);
}

Named draw_near_miss(const ErrandClass& of, const std::vector<Named>& members, RandomStream& random) {
  const Named other = one_of(members, random);
  return of.near.draw_like(other, random);
}

// Members one by one, then near misses and what other commands mean, in turn; the first by a coin.
Things draw_table(const ErrandClass& of, int members, int count, RandomStream& random) {
  Things table;
  while (static_cast<int>(table.things.size()) < members) table.things.push_back(draw_member(of, table.things, random));
  const std::vector<Named> belong = table.things;
  bool near = random.coin();
  for (int i = members; i < count; ++i, near = !near)
    table.things.push_back(near ? draw_near_miss(of, belong, random)
                                : of.others[random.below(static_cast<std::uint32_t>(of.others.size()))].draw(random));
  return table;
}

// Names of what is taken, in order.
using Sequence = std::vector<std::pair<std::string, std::string>>;
using Sequences = std::set<Sequence>;

Sequence sequence_of(const std::vector<Named>& brought) {
  Sequence names;
  for (const Named& one : brought) names.emplace_back(one.object_type, one.texture);
  return names;
}

// All right ones; false where a wanted take leads nowhere, or one is of another number of takes.
bool find_right(const Meaning& meaning, const Things& table, std::optional<int> takes, std::vector<Named>& brought,
                Sequences& right) {
  constexpr std::size_t most = 5;
  if (is_done(meaning, table.things, brought)) {
    right.insert(sequence_of(brought));
    return !takes || static_cast<int>(brought.size()) == *takes;
  }
  const std::vector<Named> next = wanted(meaning, table.things, brought);
  if (next.empty() || brought.size() == static_cast<std::size_t>(takes.value_or(most))) return false;
  for (const Named& one : next) {
    Things left{table.things, {}};
    left.things.erase(std::find(left.things.begin(), left.things.end(), one));
    if (table.later) left.things.push_back(*table.later);
    brought.push_back(one);
    const bool leads = find_right(meaning, left, takes, brought, right);
    brought.pop_back();
    if (!leads) return false;
  }
  return true;
}

std::optional<Sequences> right_sequences(const Meaning& meaning, const Things& table,
                                         std::optional<int> takes = std::nullopt) {
  Sequences right;
  std::vector<Named> brought;
  if (!find_right(meaning, table, takes, brought, right)) return std::nullopt;
  return right;
}

Sequence in_order_of_names(Sequence names) {
  std::sort(names.begin(), names.end());
  return names;
}

// Whether taking all that is wanted at first is right, in some order.
bool right_at_first(const Meaning& meaning, const std::vector<Named>& things, const Sequences& right) {
  const std::vector<Named> names = wanted(meaning, things, {});
  std::vector<Named> first;
  std::copy_if(things.begin(), things.end(), std::back_inserter(first),
               [&names](const Named& one) { return contains(names, one); });
  const Sequence all = in_order_of_names(sequence_of(first));
  return std::any_of(right.begin(), right.end(), [&all](const Sequence& one) { return in_order_of_names(one) == all; });
}

// The draw tells the pair's commands apart, and each needs so many takes of what stands there.
bool is_kept(const Errands& errands, const Things& table, std::pair<int, int> needed) {
  std::vector<Sequences> right;
  for (std::size_t i = 0; i < errands.pair.size(); ++i) {
    const Meaning& meaning = errands.pair[i];
    auto found = right_sequences(meaning, {table.things, {}}, i == 0 ? needed.first : needed.second);
    if (found && table.later) found = right_sequences(meaning, table);
    if (!found) return false;
    right.push_back(std::move(*found));
  }
  const auto in_both = [&right](const Sequence& one) { return right[1].count(one) > 0; };
  if (std::any_of(right[0].begin(), right[0].end(), in_both)) return false;
  return !right_at_first(errands.pair[0], table.things, right[0]) ||
         !right_at_first(errands.pair[1], table.things, right[1]);
}

bool shows_takes(const Meaning& meaning, const Things& table) {
  const auto right = right_sequences(meaning, table);
  return right && right->count({}) == 0;
}

std::optional<Things> draw_test(const Errands& errands, std::pair<int, int> needed, RandomStream& random) {
  const ErrandClass& of = errands.classes[errands.class_of_pair];
  const int members = between(of.belong, random);
  Things table = draw_table(of, members, test_things, random);
  const std::vector<Named> belong(table.things.begin(), table.things.begin() + members);
  if (errands.appears)
    table.later = random.coin() ? draw_member(of, belong, random) : draw_near_miss(of, belong, random);
  if (!is_kept(errands, table, needed)) return std::nullopt;
  return table;
}

// Somebody takes something in a demonstration.
std::optional<Things> draw_training(const ErrandClass& of, const Meaning& meaning, RandomStream& random) {
  Things table = draw_table(of, between(training_members, random), training_things, random);
  if (!shows_takes(meaning, table)) return std::nullopt;
  return table;
}

constexpr int tries = 20'000, tries_at_reading = 5'000;

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

ErrandClass read_class(const JsonReader& reader, const Scenario& scenario) {
  reader.only({"parts", "near_miss_sets", "undecided", "belong"});
  const FeatureSpace& space = scenario.space;
  std::vector<std::vector<FeatureSet>> parts;
  ErrandClass read;
  for (const JsonReader& part : reader.at("parts").elements()) {
    parts.push_back(read_list(part, space));
    read.sets.insert(read.sets.end(), parts.back().begin(), parts.back().end());
  }
  const std::vector<FeatureSet> near = read_list(reader.at("near_miss_sets"), space),
                                undecided = read_list(reader.at("undecided"), space);
  read.belong = read_distractors(reader.at("belong"), test_things - 1);
  if (read.belong.first == 0) reader.at("belong").fail("one that belongs, at least");
  read.members.resize(parts.size());
  read.others.resize(1);
  for (const std::string& type : space.object_types) {
    if (!can_show(type, Content::widest_in_crowd_m)) continue;
    for (const std::string& texture : space.textures) {
      const Named one{type, texture};
      if (holds(undecided, one)) continue;
      for (std::size_t i = 0; i < parts.size(); ++i)
        if (holds(parts[i], one)) read.members[i].add(type, texture);
      if (holds(read.sets, one)) continue;
      read.others.front().add(type, texture);
      if (holds(near, one)) read.near.add(type, texture);
    }
  }
  if (parts.empty() || std::any_of(read.members.begin(), read.members.end(), [](const Pool& p) { return p.empty(); }))
    reader.at("parts").fail("lists of sets of what scenes can show");
  if (read.near.empty()) reader.at("near_miss_sets").fail("what scenes can show and no command of the class means");
  return read;
}

void read_classes(const Scenario& scenario, const JsonReader& file, Errands& errands) {
  for (const JsonReader& one : file.at("classes").elements()) errands.classes.push_back(read_class(one, scenario));
  const auto class_of = [&errands](const Meaning& meaning, const JsonReader& place) {
    const auto found = std::find_if(errands.classes.begin(), errands.classes.end(),
                                    [&](const ErrandClass& one) { return same_sets(one.sets, meaning.sets); });
    if (found == errands.classes.end()) place.fail("the sets of all parts of one of \"classes\"");
    return static_cast<std::size_t>(found - errands.classes.begin());
  };
  const std::vector<JsonReader> commands = file.at("commands").elements();
  for (std::size_t i = 0; i < commands.size(); ++i)
    errands.class_of.push_back(class_of(scenario.commands[i].truth.target, commands[i].at("truth").at("target")));
  const JsonReader place = file.at(file.has("pair") ? "pair" : "commands");
  errands.class_of_pair = class_of(errands.pair[0], place);
  if (class_of(errands.pair[1], place) != errands.class_of_pair) place.fail("a pair of one class");

  std::vector<std::vector<Pool>> meant;  // by commands of other classes
  for (std::size_t i = 0; i < errands.classes.size(); ++i) {
    meant.emplace_back();
    const Pool& all = errands.classes[i].others.front();
    for (std::size_t k = 0; k < errands.classes.size(); ++k) {
      if (k == i) continue;
      Pool pool = all.only([&](const Named& one) {
        const std::vector<Pool>& members = errands.classes[k].members;
        return std::any_of(members.begin(), members.end(), [&one](const Pool& part) { return part.holds(one); });
      });
      if (!pool.empty()) meant.back().push_back(std::move(pool));
    }
  }
  for (std::size_t i = 0; i < meant.size(); ++i)
    if (!meant[i].empty()) errands.classes[i].others = std::move(meant[i]);
}

void read_needed(const JsonReader& reader, Errands& errands) {
  const int most = errands.appears ? 4 : 5;  // one step less than there are says that nothing is left to do
  for (const JsonReader& one : reader.elements()) {
    const std::vector<JsonReader> takes = one.elements();
    if (takes.size() != 2) one.fail("takes of the one and of the other command");
    const auto number = [&](const JsonReader& n) { return static_cast<int>(n.integer(errands.appears ? 1 : 0, most)); };
    errands.needed.emplace_back(number(takes[0]), number(takes[1]));
    RandomStream random(fmt::format("errands/{}/{}", takes[0].json().dump(), takes[1].json().dump()));
    int n = 0;
    while (n < tries_at_reading && !draw_test(errands, errands.needed.back(), random)) ++n;
    if (n == tries_at_reading) one.fail("takes that some scene needs which tells the pair's commands apart");
  }
  if (errands.needed.empty()) reader.fail("at least one pair of numbers");
}

}  // namespace

std::shared_ptr<const Errands> read_errands(const Scenario& scenario, const JsonReader& file, const JsonReader* scenes,
                                            bool training) {
  auto errands = std::make_shared<Errands>();
  errands->scenes_of = file.has("scenes_of") ? file.at("scenes_of").string() : scenario.id;
  errands->training = training;
  errands->pair = read_pair(scenario, file);
  read_classes(scenario, file, *errands);
  if (training) return errands;
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

Scene errand_scene(const Scenario& scenario, const SceneRequest& request, int index) {
  Scene scene = without_objects(scenario, request, index);
  const Content& content = content_of(scenario, request.arm);
  const Errands& errands = *content.errands;
  const Task& task = find_task(scenario.task);
  const Layout layout = find_layout(task, request.layout);
  const auto command = static_cast<std::size_t>(scene.command);
  scene.errand = scenario.commands[command].truth.target;
  if (!errands.training) scene.pair = index / static_cast<int>(scenario.commands_of(request.arm).size());
  const Streams stream = streams_of(errands.scenes_of, request, scene.drawn_as());

  RandomStream random = stream("errand");
  const auto draw = [&] {
    const std::size_t which = errands.training ? 0 : static_cast<std::size_t>(*scene.pair) % errands.needed.size();
    return errands.training ? draw_training(errands.classes[errands.class_of[command]], *scene.errand, random)
                            : draw_test(errands, errands.needed[which], random);
  };
  int placements = 0;
  for (int n = 0; n < tries && scene.objects.empty(); ++n) {
    const std::optional<Things> table = draw();
    if (!table) continue;
    ++placements;
    const auto once_more = [&](const std::string& purpose) {
      return stream(fmt::format("{}/{}", purpose, placements));
    };
    std::vector<Named> names = table->things;
    if (table->later) names.push_back(*table->later);
    std::vector<SceneObject> objects;
    const std::vector<int> order = once_more("order").permutation(static_cast<int>(names.size()));
    for (const int i : order) {  // any may be brought, so all need room on the pallet
      const Named& name = names[static_cast<std::size_t>(i)];
      objects.push_back({name.object_type, name.texture, role::target, {}, 0, 0});
    }
    try {
      task.place(layout, content, objects, once_more);
    } catch (const NoRoom&) {
      continue;
    }
    for (std::size_t i = 0; i < objects.size(); ++i)
      objects[i].role = static_cast<std::size_t>(order[i]) < table->things.size() ? role::distractor : role::later;
    scene.objects = std::move(objects);
  }
  if (scene.objects.empty())
    throw NothingToShow(fmt::format("scenario \"{}\", arm {}: expected a scene that shows how \"{}\" is meant",
                                    scenario.id, request.arm, scenario.commands[command].utterance));
  scene.objects.push_back({goal_type, goal_texture, role::goal, *layout.pallet, 0, 0});
  permute_ids(scene.objects, stream("ids"));
  for (const std::size_t i : Errand(scene).wanted()) scene.objects[i].role = role::target;
  return scene;
}

}  // namespace lgabench::tabletop

#include <tabletop/rivals.hpp>

#include <fmt/format.h>

#include <utility>

#include <lgabench/core/shipped.hpp>
#include <lgabench/drawn/persons.hpp>
#include <tabletop/raster.hpp>

namespace lgabench::tabletop {

struct Persons {
  struct One {
    const drawn::PersonGrammar::Words* words;
    drawn::PersonRule rule;
  };
  const drawn::PersonGrammar& grammar;
  std::vector<One> all;
};

namespace {

using drawn::Thing;

// Of words of a grammar, which lives as long as the process.
const std::vector<drawn::PersonRule>& rules_of(const drawn::PersonGrammar& grammar,
                                               const drawn::PersonGrammar::Words* words) {
  static MadeOnce<std::vector<drawn::PersonRule>, const drawn::PersonGrammar::Words*> all;
  return all.of(words, [&] { return drawn::rules_of(grammar, words->types); });
}

// Objects with the looks of things, where they were placed last.
class Table {
 public:
  Table(const FeatureSpace& space, const Task& task, const Layout& layout, const Content& content,
        const Streams& stream)
      : space_(space), task_(task), layout_(layout), content_(content), stream_(stream) {
    const Vec2 at = in_picture(layout.pallet->x, layout.pallet->y);
    goal_ = {0, 0, at.x, at.y};
  }

  const Thing& goal() const { return goal_; }

  // In random order: what is placed later stands farther out.
  bool place(std::vector<Thing>& things) {
    ++placements_;
    const auto stream_for = [this](const std::string& purpose) {
      return stream_(fmt::format("{}/{}", purpose, placements_));
    };
    const std::vector<int> order = stream_for("order").permutation(static_cast<int>(things.size()));
    std::vector<SceneObject> placed;
    for (const int i : order) {
      const Thing& thing = things[static_cast<std::size_t>(i)];
      placed.push_back({space_.object_types[thing.type], space_.textures[thing.texture], role::distractor, {}, 0, 0});
    }
    try {
      task_.place(layout_, content_, placed, stream_for);
    } catch (const NoRoom&) {
      return false;
    }
    objects_.resize(things.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
      const auto i = static_cast<std::size_t>(order[k]);
      objects_[i] = placed[k];
      const Vec2 at = in_picture(placed[k].position_m.x, placed[k].position_m.y);
      things[i].row = at.x;
      things[i].column = at.y;
    }
    return true;
  }

  // As a picture shows them; the things keep their order.
  drawn::Standing seen() const {
    Scene scene;
    scene.task = task_.id();
    scene.objects = objects_;
    scene.objects.push_back({goal_type, goal_texture, role::goal, *layout_.pallet, 0, 0});
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
      scene.objects[i].instance_id = static_cast<std::uint8_t>(i + 1);
    return drawn::standing(placed(tabletop::drawn(scene)), space_);
  }

  std::vector<SceneObject> objects(std::size_t target) const {
    std::vector<SceneObject> all = objects_;
    all[target].role = role::target;
    return all;
  }

 private:
  const FeatureSpace& space_;
  const Task& task_;
  const Layout& layout_;
  const Content& content_;
  const Streams& stream_;
  Thing goal_;
  int placements_ = 0;
  std::vector<SceneObject> objects_;
};

}  // namespace

std::shared_ptr<const Persons> read_persons(const Scenario& scenario, const JsonReader& file) {
  const auto persons = std::make_shared<Persons>(Persons{drawn::person_grammar(scenario.space), {}});
  const std::vector<JsonReader> commands = file.at("commands").elements();
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const ScenarioCommand& command = scenario.commands[i];
    const auto* const words = drawn::words_in(persons->grammar, command.utterance);
    if (!words)
      commands[i].at("utterance").fail("words of the grammar of persons, followed by nothing or by one of its hints");
    if (command.truth.target.empty()) commands[i].at("truth").fail("a rule that fits an object");
    const std::vector<drawn::PersonRule>& rules = rules_of(persons->grammar, words);
    const auto meant = drawn::rule_of(command.truth.target, scenario.space);
    const auto rule = std::find_if(rules.begin(), rules.end(),
                                   [&meant](const auto& one) { return meant && drawn::same(one, *meant); });
    if (rule == rules.end()) commands[i].at("truth").fail("a rule of the grammar of persons for these words");
    const auto* const hint = drawn::hint_in(persons->grammar, command.utterance);
    if (hint && !drawn::leaves(*hint, *rule)) commands[i].at("truth").fail("a rule that the command's hint allows");
    persons->all.push_back({words, *rule});
  }
  return persons;
}

std::vector<SceneObject> rival_objects(const Scenario& scenario, const Task& task, const Layout& layout,
                                       const Content& content, int person, bool training, const Streams& stream) {
  constexpr int pictures = 50, tries = 200'000;
  if (!layout.target_places.empty() || !layout.pallet)  // places for fewer objects than rivals are
    throw InputError(
        fmt::format("scenario \"{}\": persons: expected layout continuous, got {}", scenario.id, layout.id));
  const auto& [words, rule] = content.persons->all.at(static_cast<std::size_t>(person));
  Table table(scenario.space, task, layout, content, stream);
  RandomStream random = stream(training ? "natural" : "rivals");
  const auto places = [&table](std::vector<Thing>& things) { return table.place(things); };
  for (int i = 0; i < pictures; ++i) {
    if (training) {
      const auto scene =
          drawn::draw_natural(content.persons->grammar, *words, rule, table.goal(), random, places, tries);
      if (!scene) break;
      const drawn::Standing seen = table.seen();
      const auto taken = drawn::taken_by(rule, seen.things, seen.goal);
      if (taken == drawn::taken_by(rule, scene->things, table.goal())) return table.objects(scene->taken);
      continue;
    }
    const auto scene =
        drawn::draw_rivals(rules_of(content.persons->grammar, words), &rule, table.goal(), random, places, tries);
    if (!scene) break;
    const drawn::Standing seen = table.seen();
    bool plain = true;
    for (std::size_t k = 0; k < scene->rules.size(); ++k)
      plain = plain && drawn::taken_by(scene->rules[k], seen.things, seen.goal) == std::vector<std::size_t>{k};
    if (plain) return table.objects(0);
  }
  throw NothingToShow(fmt::format("scenario \"{}\": expected a scene in which \"{}\" is told from its rivals",
                                  scenario.id, scenario.commands[static_cast<std::size_t>(person)].utterance));
}

}  // namespace lgabench::tabletop

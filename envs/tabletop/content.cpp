#include <tabletop/content.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include <tabletop/cue.hpp>
#include <tabletop/errand_scenes.hpp>
#include <tabletop/placement.hpp>
#include <tabletop/rivals.hpp>
#include <tabletop/task.hpp>

#include <lgabench/core/contains.hpp>

namespace lgabench::tabletop {
namespace {

void append(std::vector<std::string>& names, std::vector<std::string> more) {
  names.insert(names.end(), more.begin(), more.end());
}

// `second`: the id of the task's second set, of which the choice then is; "" where the choice is of targets.
void read_choice(const JsonReader& scenes, const std::string& second, const FeatureSpace& space, Content& content) {
  constexpr std::size_t most = 5;  // with the goal's or the target's, the bodies that an engine holds ready
  for (const std::string& drawn :
       {std::string("distractors"), std::string("outside_all_commands"), std::string("hard"),
        std::string("later_letters"), std::string("near_miss"), std::string("members"), std::string("decoys"),
        std::string("cue"), second.empty() ? std::string("target") : second})
    if (scenes.has(drawn)) scenes.at(drawn).fail("no such member beside \"choice\"");  // it would do nothing
  const JsonReader reader = scenes.at("choice");
  content.choice = reader.strings();
  if (content.choice.empty()) reader.fail("at least one object type");
  if (content.choice.size() > most) reader.fail(fmt::format("at most {} object types", most));
  for (const JsonReader& type : reader.elements()) {
    if (!contains(space.object_types, type.string())) type.fail("an object type of the feature space");
    if (std::count(content.choice.begin(), content.choice.end(), type.string()) > 1) type.fail("each object type once");
  }
}

// `file`: the scenario's; `content` gets what the member says of its scenes.
void read_members(const JsonReader& scenes, const JsonReader& file, const Scenario& scenario, bool training,
                  Content& content) {
  constexpr int most = 1'000'000;
  const JsonReader members = scenes.at("members");
  if (scenes.has("target")) scenes.at("target").fail("no such member beside \"members\"");
  if (training) {
    content.members = static_cast<int>(members.integer(1, most));
    if (scenario.as_method_asks) members.fail("\"as_method_asks\": false beside it");
  } else {
    content.members_tested = members.string();
    const std::vector<std::string> known{"seen", "new", "new_decisive", "new_other"};
    if (!contains(known, content.members_tested)) members.fail(fmt::format("{}", fmt::join(known, ", ")));
    if (!file.has("train") || !file.at("train").has("members")) members.fail("\"members\" in \"train\"");
  }
  const long long count = training ? content.members : file.at("train").at("members").integer(1, most);
  for (const ScenarioCommand& command : scenario.commands) {
    const FeatureSet& meant = command.truth.target.product();
    const auto all = static_cast<long long>(meant.object_types.size() * meant.textures.size());
    const bool others = !training && content.members_tested != "seen";
    if (count > all || (others && count == all))
      (training ? members : file.at("train").at("members"))
          .fail(fmt::format("{} {}, the pairs of type and texture that \"{}\" means", others ? "fewer than" : "at most",
                            all, command.utterance));
    if (content.members_tested != "new_decisive") continue;
    for (const auto& [names, in_space, what] :
         {std::tuple(&meant.object_types, &scenario.space.object_types, "object types"),
          {&meant.textures, &scenario.space.textures, "textures"}})
      if (names->size() < in_space->size() && static_cast<long long>(names->size()) <= count)
        members.fail(fmt::format("a command that means more than {} {}: \"{}\" means {}", count, what,
                                 command.utterance, names->size()));
  }
}

void read_scenes(const JsonReader& reader, const Scenario& scenario, Content& content) {
  const int most = find_task(scenario.task).most_distractors();
  const FeatureSpace& space = scenario.space;
  if (reader.has("target")) content.target = read_feature_set(reader.at("target"), space);
  if (scenario.second && reader.has(scenario.second->id))
    content.second = read_feature_set(reader.at(scenario.second->id), space);
  if (reader.has("distractors")) content.distractors = read_distractors(reader.at("distractors"), most);
  if (reader.has("outside_all_commands")) content.outside_all_commands = reader.at("outside_all_commands").boolean();
  if (reader.has("hard")) content.hard = reader.at("hard").boolean();
  if (reader.has("near_miss") && reader.at("near_miss").json() != Json(false)) {
    for (const char* other : {"hard", "later_letters"})
      if (reader.has(other)) reader.at(other).fail("no such member beside \"near_miss\"");
    if (content.distractors.second == 0) reader.at("near_miss").fail("\"distractors\" beside it");
    if (content.by_meaning && reader.at("near_miss").json() != Json(true))
      reader.at("near_miss")
          .fail("true or false where a command has several sets or a rule, or the scenario \"near_miss_sets\"");
    content.near_miss = read_near_miss(reader.at("near_miss"), scenario);
  }
  if (reader.has("later_letters")) content.later_letters = reader.at("later_letters").boolean();
  if (reader.has("choice")) read_choice(reader, scenario.second ? scenario.second->id : "", space, content);
}

std::vector<FeatureSet> read_sets(const JsonReader& reader, const FeatureSpace& space) {
  std::vector<FeatureSet> sets;
  for (const JsonReader& set : reader.elements()) sets.push_back(read_feature_set(set, space));
  if (sets.empty()) reader.fail("at least one set");
  return sets;
}

// Whether a scene can show one of the set's objects that is not `meant` and on which people agree.
bool shows_another(const FeatureSet& set, const Meaning& meant, const std::vector<FeatureSet>& undecided) {
  for (const std::string& type : set.object_types) {
    if (!can_show(type, std::numeric_limits<double>::infinity())) continue;
    for (const std::string& texture : set.textures)
      if (!meant.belongs(type, texture) && !any_contains(undecided, type, texture)) return true;
  }
  return false;
}

// What a careless reading keeps, and which scenes show it.
void read_meant(const Scenario& scenario, const JsonReader& file, const JsonReader* scenes, bool training,
                Content& content) {
  const Meaning& truth = scenario.commands.front().truth.target;
  if (!content.by_meaning) {
    for (const char* member : {"words", "undecided"})
      if (file.has(member)) file.at(member).fail("\"near_miss_sets\" beside it");
    if (scenes && scenes->has("misleading")) scenes->at("misleading").fail("\"near_miss_sets\" in the scenario");
    return;
  }
  if (file.has("words")) content.words = read_meaning(file.at("words"), scenario.space);
  if (file.has("undecided")) content.undecided = read_sets(file.at("undecided"), scenario.space);
  if (file.has("near_miss_sets")) {
    content.near_miss_sets = read_sets(file.at("near_miss_sets"), scenario.space);
    const std::vector<JsonReader> sets = file.at("near_miss_sets").elements();
    for (std::size_t i = 0; i < sets.size(); ++i)
      if (!shows_another(content.near_miss_sets[i], truth, content.undecided))
        sets[i].fail("objects that scenes can show and that the command does not mean");
  }
  if (find_task(scenario.task).most_distractors() < content.others())
    file.at("task").fail(
        "pick_and_place where a command has several sets or a rule, or the scenario \"near_miss_sets\"");
  if (scenario.as_method_asks)
    file.fail(
        "\"as_method_asks\": false in \"train\" where a command has several sets or a rule, or the scenario "
        "\"near_miss_sets\"");
  for (const ScenarioCommand& command : scenario.commands)
    if (!(command.truth.target == truth)) file.at("commands").fail("commands of one meaning");
  if (training) content.misleading = .5;
  if (!scenes) return;
  for (const char* other : {"target", "outside_all_commands", "hard", "members", "later_letters", "choice", "decoys"})
    if (scenes->has(other))
      scenes->at(other).fail(
          "no such member where a command has several sets or a rule, or the scenario \"near_miss_sets\"");
  if (scenes->has("misleading")) {
    content.misleading = scenes->at("misleading").number();
    if (!(content.misleading >= 0 && content.misleading <= 1)) scenes->at("misleading").fail("a share from 0 to 1");
  }
}

// A scenario of persons says nothing else of its scenes.
Content read_persons_content(const Scenario& scenario, const JsonReader& file, const JsonReader* scenes) {
  if (scenario.as_method_asks) file.at("persons").fail("\"as_method_asks\": false in \"train\" beside it");
  if (scenario.task != find_task("pick_and_place").id()) file.at("persons").fail("the task pick_and_place beside it");
  for (const std::string& member : scenario_members(find_task(scenario.task)))
    if (member != "persons" && file.has(member)) file.at(member).fail("no such member beside \"persons\"");
  for (const std::string& member : scene_members(find_task(scenario.task)))
    if (scenes && scenes->has(member)) scenes->at(member).fail("no such member beside \"persons\"");
  Content content;
  content.persons = read_persons(scenario, file);
  content.distractors = {4, 4};
  return content;
}

// What is judged as an errand says of its scenes what its task's own members say, and nothing else.
Content read_errands_content(const Scenario& scenario, const JsonReader& file, const JsonReader* scenes,
                             bool training) {
  if (scenario.as_method_asks) file.at("task").fail("\"as_method_asks\": false in \"train\" beside it");
  if (!file.has("may_stop") || !file.at("may_stop").boolean()) file.at("task").fail("\"may_stop\": true beside it");
  const Task& task = find_task(scenario.task);
  const auto refuse = [&task](const JsonReader& reader, const std::vector<std::string>& members,
                              const std::vector<std::string>& known) {
    for (const std::string& member : members)
      if (!contains(known, member) && reader.has(member))
        reader.at(member).fail(fmt::format("no such member in a scenario of {}", task.id()));
  };
  refuse(file, scenario_members(task), task.scenario_members());
  const std::vector<std::string> of_scenes = training ? std::vector<std::string>() : task.scene_members();
  std::vector<std::string> no_scenes = scene_members(task);
  no_scenes.emplace_back("perturbation");
  if (scenes) refuse(*scenes, no_scenes, of_scenes);
  Content content;
  content.errands = read_errands(scenario, file, scenes, training);
  const int others = objects_of(*content.errands) - 1;
  content.distractors = {others, others};
  return content;
}

// `decoys`: of the scenario, for the scenes that ask for them.
void read_decoys(const JsonReader& file, const JsonReader& scenes, const std::vector<FeatureSet>& decoys,
                 Content& content) {
  if (!scenes.has("decoys") || !scenes.at("decoys").boolean()) return;
  for (const char* other : {"hard", "later_letters", "near_miss"})
    if (scenes.has(other)) scenes.at(other).fail("no such member beside \"decoys\"");
  if (decoys.empty()) scenes.at("decoys").fail("\"decoys\", a list of sets, in the scenario");
  content.decoys = decoys;
  content.unheard_decoys = file.has("unheard_decoys") && file.at("unheard_decoys").boolean() && scenes.has("unseen") &&
                           scenes.at("unseen").boolean();
}

// Where the method says what is shown, the scenario does not.
void expect_method_asks(const Scenario& scenario, const JsonReader& train, const Content& content) {
  if (!scenario.as_method_asks) return;
  if (content.target || content.second)
    train.fail("\"as_method_asks\": false beside \"target\"" +
               (scenario.second ? fmt::format(" or \"{}\"", scenario.second->id) : ""));
  if (content.near_miss)  // else an answer would decide what is near
    train.at("near_miss").fail("\"as_method_asks\": false beside it");
}

}  // namespace

const Content& content_of(const SceneContent& scenes) { return dynamic_cast<const Content&>(scenes); }

const Content& content_of(const Scenario& scenario, const std::string& arm) {
  return content_of(arm == "train" ? *scenario.train : *scenario.arm(arm).scenes);
}

std::vector<std::string> scenario_members(const Task& task) {
  std::vector<std::string> names{"never_distractor", "decoys",         "unheard_decoys", "words",
                                 "undecided",        "near_miss_sets", "persons"};
  append(names, task.scenario_members());
  return names;
}

std::vector<std::string> scene_members(const Task& task) {
  std::vector<std::string> names{
      "target", "distractors", "outside_all_commands", "hard", "near_miss", "members", "later_letters",
      "choice", "decoys",      "misleading",           "cue"};
  if (const auto second = task.second()) names.push_back(second->id);
  append(names, task.scene_members());
  return names;
}

Content read_content(const Scenario& scenario, const JsonReader& file, const JsonReader* scenes, bool training) {
  if (find_task(scenario.task).has_errand()) return read_errands_content(scenario, file, scenes, training);
  if (file.has("persons") && file.at("persons").boolean()) return read_persons_content(scenario, file, scenes);
  Content content;
  if (training) content.distractors = {1, 1};
  content.by_meaning = !scenario.commands.front().truth.target.is_product() || file.has("near_miss_sets");
  if (file.has("never_distractor"))
    content.never_distractor = read_feature_set(file.at("never_distractor"), scenario.space);
  std::vector<FeatureSet> decoys;
  if (file.has("decoys"))
    for (const JsonReader& set : file.at("decoys").elements()) decoys.push_back(read_feature_set(set, scenario.space));
  if (scenes) read_scenes(*scenes, scenario, content);
  read_meant(scenario, file, scenes, training, content);
  if (scenes) read_decoys(file, *scenes, decoys, content);
  if (scenes && scenes->has("members")) read_members(*scenes, file, scenario, training, content);
  if (scenes && scenes->has("cue")) content.cue = read_cue(*scenes, file, scenario, content, training);
  find_task(scenario.task).read(file, scenes, content);
  if (training && scenes) expect_method_asks(scenario, *scenes, content);
  return content;
}

}  // namespace lgabench::tabletop

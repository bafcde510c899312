#include <lgabench/core/scenario.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <cctype>

#include <lgabench/core/files.hpp>
#include <lgabench/core/scenario_files.hpp>
#include <lgabench/core/suggest.hpp>

namespace lgabench {
namespace {

Task read_task(const JsonReader& reader) {
  for (const Task task : {Task::pick_and_place, Task::rotate, Task::sweep})
    if (reader.string() == to_string(task)) return task;
  reader.fail("pick_and_place, rotate or sweep");
}

ScenarioCommand read_command(const JsonReader& reader, Task task, const FeatureSpace& space) {
  reader.only({"utterance", "truth", "seen"});
  ScenarioCommand command{reader.at("utterance").string(), read_distribution(reader.at("truth"), space), true};
  command.truth.provenance = Provenance::truth;
  command.truth.source = "true distribution";
  command.truth.asked_as = command.utterance;
  if (command.truth.target.empty()) reader.at("truth").fail("at least one object type and one texture");
  if ((task == Task::sweep) != command.truth.avoid.has_value())
    reader.at("truth").fail("\"avoid\" for sweep, and only there");
  if (reader.has("seen")) command.seen = reader.at("seen").boolean();
  return command;
}

// In degrees; positive: counter-clockwise.
double read_angle(const JsonReader& scenario) {
  const double angle_deg = scenario.at("angle_deg").number();
  if (!(angle_deg > 0 && angle_deg <= 180)) scenario.at("angle_deg").fail("above 0, at most 180");
  if (!scenario.has("direction")) return angle_deg;
  const std::string direction = scenario.at("direction").string();
  if (direction != "clockwise" && direction != "counter_clockwise")
    scenario.at("direction").fail("clockwise or counter_clockwise");
  return direction == "clockwise" ? -angle_deg : angle_deg;
}

const std::vector<std::string> content_members{"target", "avoid",         "distractors", "outside_all_commands",
                                               "hard",   "later_letters", "choice",      "barrier_distances_m"};

// Members of the content that the reader gives, over those of `content`.
SceneContent read_content(const JsonReader& reader, SceneContent content, const FeatureSpace& space) {
  constexpr int most = 2;                  // more than that do not fit beside the widest target
  constexpr std::size_t most_choices = 5;  // with the goal's or the target's, the bodies that an engine holds ready
  if (reader.has("target")) content.target = read_feature_set(reader.at("target"), space);
  if (reader.has("avoid")) content.avoid = read_feature_set(reader.at("avoid"), space);
  if (reader.has("distractors")) {
    const auto range = reader.at("distractors").elements();
    if (range.size() != 2) reader.at("distractors").fail("[fewest, most]");
    content.distractors.first = static_cast<int>(range[0].integer(0, most));
    content.distractors.second = static_cast<int>(range[1].integer(content.distractors.first, most));
  }
  if (reader.has("outside_all_commands")) content.outside_all_commands = reader.at("outside_all_commands").boolean();
  if (reader.has("hard")) content.hard = reader.at("hard").boolean();
  if (reader.has("later_letters")) content.later_letters = reader.at("later_letters").boolean();
  if (reader.has("choice")) {
    content.choice = reader.at("choice").strings();
    if (content.choice.size() > most_choices)
      reader.at("choice").fail(fmt::format("at most {} object types", most_choices));
    for (const JsonReader& type : reader.at("choice").elements())
      if (std::find(space.object_types.begin(), space.object_types.end(), type.string()) == space.object_types.end())
        type.fail("an object type of the feature space");
  }
  if (reader.has("barrier_distances_m")) {
    constexpr double nearest_m = .15, farthest_m = .3;  // outlines apart, and within the picture beside any target
    content.barrier_distances_m.clear();
    for (const JsonReader& distance : reader.at("barrier_distances_m").elements()) {
      content.barrier_distances_m.push_back(distance.number());
      if (!(distance.number() >= nearest_m && distance.number() <= farthest_m))
        distance.fail(fmt::format("{} to {}", nearest_m, farthest_m));
    }
    if (content.barrier_distances_m.empty()) reader.at("barrier_distances_m").fail("at least one distance");
  }
  return content;
}

double read_probability(const JsonReader& reader) {
  const double p = reader.number();
  if (!(p >= 0 && p <= 1)) reader.fail("a probability");
  return p;
}

Arm read_arm(const JsonReader& reader, const FeatureSpace& space) {
  std::vector<std::string> members = content_members;
  members.insert(members.end(), {"arm", "unseen", "label_noise", "missed_segment"});
  reader.only(members);
  Arm arm;
  arm.id = reader.at("arm").string();
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.';
  };
  if (arm.id.empty() || arm.id.size() > 64 || !std::all_of(arm.id.begin(), arm.id.end(), plain))
    reader.at("arm").fail("a name of letters, digits, '_', '-' and '.'");
  if (arm.id == "train") reader.at("arm").fail("another name than train");
  arm.scenes = read_content(reader, {}, space);
  if (reader.has("unseen")) arm.unseen = reader.at("unseen").boolean();
  if (reader.has("label_noise")) arm.label_noise = read_probability(reader.at("label_noise"));
  if (reader.has("missed_segment")) arm.missed_segment = read_probability(reader.at("missed_segment"));
  return arm;
}

SceneContent read_train(const JsonReader& scenario, const FeatureSpace& space) {
  SceneContent content;
  content.distractors = {1, 1};
  content.as_method_asks = true;
  if (!scenario.has("train")) return content;
  std::vector<std::string> members = content_members;
  members.emplace_back("as_method_asks");
  const JsonReader reader = scenario.at("train");
  reader.only(members);
  content = read_content(reader, content, space);
  if (reader.has("as_method_asks")) content.as_method_asks = reader.at("as_method_asks").boolean();
  if (content.as_method_asks && (content.target || content.avoid))
    reader.fail("\"as_method_asks\": false beside \"target\" or \"avoid\"");
  return content;
}

// Whose answers are the scenario's recorded ones, and which of them are given to people.
void read_answers(const JsonReader& reader, Scenario& scenario) {
  reader.only({"recorded", "edited"});
  std::error_code none_to_list;
  const std::vector<std::string> known = json_names(data_directory() / "answers", none_to_list);
  const auto file = [&known](const JsonReader& name) {
    if (std::find(known.begin(), known.end(), name.string()) == known.end())
      name.fail(fmt::format("one of: {}", fmt::join(known, ", ")));
    return name.string();
  };
  scenario.recorded = file(reader.at("recorded"));
  scenario.edited = reader.has("edited") ? file(reader.at("edited")) : scenario.recorded;
}

// The file's members with the appendix's in place of the released ones.
Json as_printed(Json json) {
  const Json printed = json.value("printed", Json());
  if (printed.is_null()) return json;
  json.erase("printed");
  json.update(printed);
  json["truth"] = "printed";
  return json;
}

}  // namespace

Truth read_truth(const std::string& word) {
  if (word == "released") return Truth::released;
  if (word == "printed") return Truth::printed;
  throw InputError(fmt::format("truth: expected released or printed, got \"{}\"", word));
}

Scenario read_scenario(const Json& json, const std::string& file) {
  const JsonReader reader(json, file);
  reader.only({"id", "environment", "task", "angle_deg", "direction", "feature_space", "commands", "answers_of",
               "answers", "never_distractor", "train", "tests", "truth", "printed", "note"});
  if (reader.has("printed")) reader.at("printed").only({"commands", "never_distractor", "note"});
  Scenario s;
  s.id = reader.at("id").string();
  s.environment = reader.at("environment").string();
  s.task = read_task(reader.at("task"));
  if (s.task == Task::rotate)
    s.angle_deg = read_angle(reader);
  else if (reader.has("direction"))
    reader.at("direction").fail("no direction for another task than rotate");
  s.space = load_feature_space(reader.at("feature_space").string());
  for (const JsonReader& command : reader.at("commands").elements())
    s.commands.push_back(read_command(command, s.task, s.space));
  s.answers_of = reader.has("answers_of") ? reader.at("answers_of").string() : s.id;
  if (reader.has("answers")) read_answers(reader.at("answers"), s);
  if (reader.has("never_distractor")) s.never_distractor = read_feature_set(reader.at("never_distractor"), s.space);
  s.train = read_train(reader, s.space);
  for (const JsonReader& arm : reader.at("tests").elements()) {
    s.tests.push_back(read_arm(arm, s.space));
    const auto same = [&](const Arm& other) { return other.id == s.tests.back().id; };
    if (std::count_if(s.tests.begin(), s.tests.end(), same) > 1) arm.at("arm").fail("each arm once");
    if (s.commands_of(s.tests.back().id).empty()) arm.fail("a scenario with commands for this arm");
  }
  if (s.tests.empty()) reader.at("tests").fail("at least one arm");
  if (s.commands_of("train").empty()) reader.at("commands").fail("at least one seen command");
  s.json = json;
  return s;
}

std::vector<std::string> Scenario::utterances() const {
  std::vector<std::string> all;
  for (const ScenarioCommand& command : commands) all.push_back(command.utterance);
  return all;
}

const Arm& Scenario::arm(const std::string& name) const {
  for (const Arm& test : tests)
    if (test.id == name) return test;
  throw InputError(fmt::format("arm \"{}\": expected train or a test arm of scenario \"{}\"", name, id));
}

std::vector<int> Scenario::commands_of(const std::string& name) const {
  const bool seen = name == "train" || !arm(name).unseen;
  std::vector<int> indices;
  for (std::size_t i = 0; i < commands.size(); ++i)
    if (commands[i].seen == seen) indices.push_back(static_cast<int>(i));
  return indices;
}

int Scenario::training_scenes(int demonstrations) const {
  return demonstrations * static_cast<int>(commands_of("train").size());
}

std::vector<std::string> scenario_ids() {
  std::vector<std::string> ids;
  for (const auto& [id, file] : scenario_files()) ids.push_back(id);
  return ids;
}

Scenario load_scenario(const std::string& id, Truth truth) {
  const auto files = scenario_files();
  if (files.count(id) == 0) throw InputError(none_named("scenario", id, scenario_ids()));
  const fs::path& file = files.at(id);
  const Json json = read_json(file);
  Scenario s = read_scenario(truth == Truth::printed ? as_printed(json) : json, file.string());
  if (s.id != id)
    throw InputError(
        fmt::format("{}: /id: expected \"{}\", as the file is named, got \"{}\"", file.string(), id, s.id));
  return s;
}

}  // namespace lgabench

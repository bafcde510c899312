#include <lgabench/core/scenario.hpp>

#include <fmt/format.h>
#include <algorithm>

#include <lgabench/core/files.hpp>

namespace lgabench {
namespace {

Task read_task(const JsonReader& reader) {
  for (const Task task : {Task::pick_and_place, Task::rotate, Task::sweep})
    if (reader.string() == to_string(task)) return task;
  reader.fail("pick_and_place, rotate or sweep");
}

}  // namespace

Scenario read_scenario(const Json& json, const std::string& file) {
  const JsonReader reader(json, file);
  reader.only({"id", "environment", "task", "utterance", "angle_deg", "feature_space", "truth", "never_distractor",
               "earliest_letter", "tests", "note"});
  Scenario s;
  s.id = reader.at("id").string();
  s.environment = reader.at("environment").string();
  s.command = {reader.at("utterance").string(), read_task(reader.at("task"))};
  s.space = load_feature_space(reader.at("feature_space").string());
  s.truth = read_distribution(reader.at("truth"), s.space);
  s.truth.provenance = Provenance::truth;
  s.truth.source = "true distribution";
  s.truth.asked_as = s.command.utterance;
  if (s.truth.target.empty()) reader.at("truth").fail("at least one object type and one texture");
  if ((s.command.task == Task::sweep) != s.truth.avoid.has_value())
    reader.at("truth").fail("\"avoid\" for sweep, and only there");
  if (s.command.task == Task::rotate) s.angle_deg = reader.at("angle_deg").number();
  if (reader.has("never_distractor")) s.never_distractor = read_feature_set(reader.at("never_distractor"), s.space);
  if (reader.has("earliest_letter")) s.earliest_letter = reader.at("earliest_letter").boolean();
  for (const JsonReader& arm : reader.at("tests").elements()) {
    arm.only({"arm"});
    s.tests.push_back({arm.at("arm").string()});
  }
  if (s.tests.empty()) reader.at("tests").fail("at least one arm");
  s.json = json;
  return s;
}

std::vector<std::string> scenario_ids() {
  std::error_code none_to_list;
  return json_names(data_directory() / "scenarios", none_to_list);
}

Scenario load_scenario(const std::string& id) {
  const auto known = scenario_ids();
  if (std::find(known.begin(), known.end(), id) == known.end())
    throw InputError(fmt::format("scenario \"{}\": expected one of: {}", id, fmt::join(known, ", ")));
  const fs::path file = data_directory() / "scenarios" / (id + ".json");
  Scenario s = read_scenario(read_json(file), file.string());
  if (s.id != id)
    throw InputError(
        fmt::format("{}: /id: expected \"{}\", as the file is named, got \"{}\"", file.string(), id, s.id));
  return s;
}

}  // namespace lgabench

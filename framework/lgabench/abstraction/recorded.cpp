#include <lgabench/abstraction/recorded.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/files.hpp>

namespace lgabench {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

fs::path answers_file(const char* name) { return data_directory() / "answers" / name; }

// What answers there are: the `member` of each entry that is about the space.
std::string known(const fs::path& file, const char* member, const std::string& space) {
  const Json document = read_json(file);
  std::vector<std::string> names;
  const JsonReader reader(document, file.string());
  for (const JsonReader& entry : reader.at("answers").elements())
    if (!entry.has("space") || entry.at("space").string() == space) names.push_back(entry.at(member).string());
  return fmt::format("{} has: {}", file.filename().string(), fmt::join(names, " | "));
}

}  // namespace

RecordedLanguageModel::RecordedLanguageModel(const Scenario& scenario, const std::string& answers)
    : utterance_(scenario.command.utterance), space_(scenario.space) {
  if (answers != "recorded" && answers != "gpt4" && answers != "claude")
    throw InputError(fmt::format("answers: expected recorded, gpt4 or claude, got \"{}\"", answers));
  if (answers != "claude" && find_gpt4(scenario)) return;
  if (answers != "gpt4" && find_claude(scenario)) return;
  const fs::path gpt4 = answers_file("gpt4.json"), claude = answers_file("claude.json");
  const std::string name = scenario.id.empty() ? "" : fmt::format("scenario {}, ", scenario.id);
  throw InputError(fmt::format(
      "answers={}: expected recorded answers for {}\"{}\" in the space {}; {}", answers, name, utterance_, space_.id,
      answers == "gpt4" ? known(gpt4, "scenario", space_.id) : known(claude, "command", space_.id)));
}

bool RecordedLanguageModel::find_gpt4(const Scenario& scenario) {
  const fs::path file = answers_file("gpt4.json");
  const Json document = read_json(file);
  const JsonReader reader(document, file.string());
  if (reader.at("space").string() != space_.id) return false;
  for (const JsonReader& entry : reader.at("answers").elements()) {
    if (entry.at("scenario").string() != scenario.id) continue;
    const Json sets{{"object_types", entry.at("object_types").json()}, {"textures", entry.at("textures").json()}};
    yes_.target = read_feature_set(JsonReader(sets, file.string(), "/answers: " + scenario.id), space_);
    asked_as_ = entry.at("utterance").string();
    model_ = reader.at("model").string();
    return true;
  }
  return false;
}

bool RecordedLanguageModel::find_claude(const Scenario& scenario) {
  const fs::path file = answers_file("claude.json");
  const Json document = read_json(file);
  const JsonReader reader(document, file.string());
  for (const JsonReader& entry : reader.at("answers").elements()) {
    if (entry.at("space").string() != space_.id || entry.at("command").string() != scenario.command.utterance) continue;
    yes_.target = read_feature_set(entry.at("target"), space_);
    if (entry.has("avoid")) yes_.avoid = read_feature_set(entry.at("avoid"), space_);
    asked_as_ = entry.at("command").string();
    model_ = reader.at("model").string();
    return true;
  }
  return false;
}

std::vector<bool> RecordedLanguageModel::answer(const Command& command, const FeatureSpace&,
                                                const std::vector<Question>& questions) {
  expect_own(command);
  std::vector<bool> answers;
  for (const Question& q : questions) {
    const bool is_type = q.group == Question::Group::object_type;
    if (!contains(is_type ? space_.object_types : space_.textures, q.candidate))
      throw MethodError(fmt::format("{}: \"{}\" is not in the space {}", model_, q.candidate, space_.id));
    const bool is_target = q.about == Question::About::target;
    if (!is_target && !yes_.avoid)
      throw MethodError(fmt::format("{}: no recorded answer on what to avoid in \"{}\"", model_, asked_as_));
    const FeatureSet& set = is_target ? yes_.target : *yes_.avoid;
    answers.push_back(contains(is_type ? set.object_types : set.textures, q.candidate));
  }
  cost_.lm_queries += static_cast<int>(questions.size());
  return answers;
}

std::string RecordedLanguageModel::asked_as(const Command& command) const {
  expect_own(command);
  return asked_as_;
}

void RecordedLanguageModel::expect_own(const Command& command) const {
  if (command.utterance != utterance_)
    throw MethodError(
        fmt::format("{}: answers are recorded for \"{}\", asked \"{}\"", model_, utterance_, command.utterance));
}

}  // namespace lgabench

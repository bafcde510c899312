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

RecordedLanguageModel::RecordedLanguageModel(FeatureSpace space, std::string scenario, std::string answers)
    : space_(std::move(space)), scenario_(std::move(scenario)), answers_(std::move(answers)) {
  if (answers_ != "recorded" && answers_ != "gpt4" && answers_ != "claude")
    throw InputError(fmt::format("answers: expected recorded, gpt4 or claude, got \"{}\"", answers_));
}

const RecordedLanguageModel::Recorded& RecordedLanguageModel::find(const std::string& utterance) const {
  const auto before = found_.find(utterance);
  if (before != found_.end()) return before->second;
  std::optional<Recorded> found;
  if (answers_ != "claude") found = find_gpt4();
  if (!found && answers_ != "gpt4") found = find_claude(utterance);
  if (found) return found_.emplace(utterance, *std::move(found)).first->second;
  const fs::path gpt4 = answers_file("gpt4.json"), claude = answers_file("claude.json");
  const std::string name = scenario_.empty() ? "" : fmt::format("scenario {}, ", scenario_);
  throw InputError(fmt::format(
      "answers={}: expected recorded answers for {}\"{}\" in the space {}; {}", answers_, name, utterance, space_.id,
      answers_ == "gpt4" ? known(gpt4, "scenario", space_.id) : known(claude, "command", space_.id)));
}

std::optional<RecordedLanguageModel::Recorded> RecordedLanguageModel::find_gpt4() const {
  const fs::path file = answers_file("gpt4.json");
  const Json document = read_json(file);
  const JsonReader reader(document, file.string());
  if (reader.at("space").string() != space_.id) return std::nullopt;
  for (const JsonReader& entry : reader.at("answers").elements()) {
    if (entry.at("scenario").string() != scenario_) continue;
    const Json sets{{"object_types", entry.at("object_types").json()}, {"textures", entry.at("textures").json()}};
    Recorded recorded{{}, entry.at("utterance").string(), reader.at("model").string()};
    recorded.yes.target = read_feature_set(JsonReader(sets, file.string(), "/answers: " + scenario_), space_);
    return recorded;
  }
  return std::nullopt;
}

std::optional<RecordedLanguageModel::Recorded> RecordedLanguageModel::find_claude(const std::string& utterance) const {
  const fs::path file = answers_file("claude.json");
  const Json document = read_json(file);
  const JsonReader reader(document, file.string());
  for (const JsonReader& entry : reader.at("answers").elements()) {
    if (entry.at("space").string() != space_.id || entry.at("command").string() != utterance) continue;
    Recorded recorded{{}, utterance, reader.at("model").string()};
    recorded.yes.target = read_feature_set(entry.at("target"), space_);
    if (entry.has("avoid")) recorded.yes.avoid = read_feature_set(entry.at("avoid"), space_);
    return recorded;
  }
  return std::nullopt;
}

std::vector<bool> RecordedLanguageModel::answer(const Command& command, const FeatureSpace&,
                                                const std::vector<Question>& questions) {
  const Recorded& recorded = find(command.utterance);
  model_ = recorded.model;
  std::vector<bool> answers;
  for (const Question& q : questions) {
    const bool is_type = q.group == Question::Group::object_type;
    if (!contains(is_type ? space_.object_types : space_.textures, q.candidate))
      throw MethodError(fmt::format("{}: \"{}\" is not in the space {}", model_, q.candidate, space_.id));
    const bool is_target = q.about == Question::About::target;
    if (!is_target && !recorded.yes.avoid)
      throw MethodError(fmt::format("{}: no recorded answer on what to avoid in \"{}\"", model_, recorded.asked_as));
    const FeatureSet& set = is_target ? recorded.yes.target : *recorded.yes.avoid;
    answers.push_back(contains(is_type ? set.object_types : set.textures, q.candidate));
  }
  cost_.lm_queries += static_cast<int>(questions.size());
  return answers;
}

std::string RecordedLanguageModel::asked_as(const Command& command) const { return find(command.utterance).asked_as; }

}  // namespace lgabench

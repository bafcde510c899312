#include <lgabench/abstraction/recorded.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/files.hpp>

namespace lgabench {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::vector<std::string> recorded_sources() {
  std::error_code none_to_list;
  return json_names(data_directory() / "answers", none_to_list);
}

std::string recorded_source(const Scenario& scenario, const std::string& answers, bool to_edit) {
  if (answers != "recorded") return answers;
  return to_edit ? scenario.edited : scenario.recorded;
}

RecordedLanguageModel::RecordedLanguageModel(FeatureSpace space, std::string scenario, std::string source)
    : space_(std::move(space)), scenario_(std::move(scenario)), source_(std::move(source)) {
  if (const auto sources = recorded_sources(); !contains(sources, source_))
    throw InputError(
        fmt::format("answers: expected recorded or one of {}, got \"{}\"", fmt::join(sources, ", "), source_));
}

void RecordedLanguageModel::read() const {
  if (read_) return;
  const fs::path file = data_directory() / "answers" / (source_ + ".json");
  const Json document = read_json(file);
  const JsonReader reader(document, file.string());
  model_ = reader.at("model").string();
  for (const JsonReader& entry : reader.at("answers").elements()) {
    if ((entry.has("space") ? entry : reader).at("space").string() != space_.id) continue;
    Recorded recorded{entry.has("scenario") ? entry.at("scenario").string() : "",
                      entry.at("command").string(),
                      read_feature_set(entry.at("target"), space_),
                      {}};
    for (const auto& item : entry.json().items())
      if (item.value().is_object() && item.key() != "target")
        recorded.second[item.key()] = read_feature_set(entry.at(item.key()), space_);
    all_.push_back(std::move(recorded));
  }
  read_ = true;
}

const RecordedLanguageModel::Recorded* RecordedLanguageModel::find(const std::string& utterance) const {
  read();
  for (const Recorded& one : all_)
    if (!one.scenario.empty() && one.scenario == scenario_) return &one;
  for (const Recorded& one : all_)
    if (one.asked_as == utterance) return &one;
  return nullptr;
}

std::vector<std::string> RecordedLanguageModel::known() const {
  read();
  std::vector<std::string> names;
  for (const Recorded& one : all_) names.push_back(one.scenario.empty() ? one.asked_as : one.scenario);
  return names;
}

const RecordedLanguageModel::Recorded& RecordedLanguageModel::expect(const std::string& utterance) const {
  if (const Recorded* found = find(utterance)) return *found;
  throw InputError(
      fmt::format("answers of {}: expected some for {}\"{}\" in the space {}; there are: {}; a model is "
                  "asked with --answers openai (docs/language-models.md)",
                  source_, scenario_.empty() ? "" : fmt::format("scenario {}, ", scenario_), utterance, space_.id,
                  fmt::join(known(), " | ")));
}

std::vector<bool> RecordedLanguageModel::answer(const Command& command, const FeatureSpace&,
                                                const std::vector<Question>& questions) {
  const Recorded& recorded = expect(command.utterance);
  std::vector<bool> answers;
  for (const Question& q : questions) {
    const bool is_type = q.group == Question::Group::object_type;
    if (!contains(is_type ? space_.object_types : space_.textures, q.candidate))
      throw MethodError(fmt::format("{}: \"{}\" is not in the space {}", model_, q.candidate, space_.id));
    const bool is_target = q.about == Question::About::target;
    const auto second = command.second ? recorded.second.find(command.second->id) : recorded.second.end();
    if (!is_target && second == recorded.second.end())
      throw MethodError(fmt::format("{}: no recorded answer on {} in \"{}\"", model_,
                                    command.second ? command.second->phrase : "a second set", recorded.asked_as));
    const FeatureSet& set = is_target ? recorded.target : second->second;
    answers.push_back(contains(is_type ? set.object_types : set.textures, q.candidate));
  }
  cost_.lm_queries += static_cast<int>(questions.size());
  return answers;
}

std::string RecordedLanguageModel::asked_as(const Command& command) const { return expect(command.utterance).asked_as; }

}  // namespace lgabench

#include <lgabench/abstraction/recorded.hpp>

#include <fmt/format.h>

#include <set>
#include <tuple>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/read_space.hpp>
#include <lgabench/core/shipped.hpp>
#include <lgabench/core/suggest.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench {
namespace {

constexpr std::size_t most_bytes = 16 << 20;

std::string line(const JsonReader& reader) {
  std::string text = reader.string();
  if (text.empty() || text != one_line(text)) reader.fail("words, in a line");
  return text;
}

const FeatureSpace& space_of(const JsonReader& reader, std::map<std::string, FeatureSpace>& known) {
  const std::string id = reader.string();
  if (const auto found = known.find(id); found != known.end()) return found->second;
  return known.emplace(id, read_space(reader)).first->second;
}

// Members that are sets belong to the second role of some task; which one, a command says.
RecordedAnswer read_answer(const JsonReader& entry, const FeatureSpace& space, const std::vector<std::string>& roles) {
  std::vector<std::string> members{"space",      "scenario",   "command", "target",
                                   "structured", "hypotheses", "note",    "rationale"};
  members.insert(members.end(), roles.begin(), roles.end());
  entry.only(members);
  RecordedAnswer answer{space.id,
                        entry.has("scenario") ? line(entry.at("scenario")) : "",
                        entry.at("command").json() == "" ? "" : line(entry.at("command")),
                        read_feature_set(entry.at("target"), space),
                        {},
                        {},
                        {}};
  if (entry.has("structured")) {
    answer.structured = read_meaning(entry.at("structured"), space);
    expect_possible(*answer.structured, entry.at("structured"));
  }
  if (entry.has("hypotheses")) answer.hypotheses = read_hypotheses(entry.at("hypotheses"), space);
  for (const std::string& role : roles)
    if (entry.has(role)) answer.second[role] = read_feature_set(entry.at(role), space);
  return answer;
}

}  // namespace

std::vector<std::string> recorded_sources() { return shipped_answers(); }

std::string recorded_source(const Scenario& scenario, const std::string& answers, bool to_edit) {
  if (answers != "recorded") return answers;
  return to_edit ? scenario.edited : scenario.recorded;
}

RecordedFile read_recorded(const fs::path& file) {
  const Json document = parse_json(read_file(file, Links::followed, most_bytes), file.string());
  const JsonReader reader(document, file.string());
  reader.only({"model", "space", "answers", "source", "note", "recorded", "how", "reading", "near_coin_flips"});
  RecordedFile recorded{line(reader.at("model")), {}};
  std::map<std::string, FeatureSpace> spaces;
  std::vector<std::string> roles;
  for (const TaskInfo& task : installed_tasks())
    if (task.second) roles.push_back(task.second->id);
  std::set<std::tuple<std::string, std::string, std::string>> seen;
  for (const JsonReader& entry : reader.at("answers").elements()) {
    const JsonReader space = (entry.has("space") ? entry : reader).at("space");
    recorded.answers.push_back(read_answer(entry, space_of(space, spaces), roles));
    const RecordedAnswer& one = recorded.answers.back();
    if (!seen.insert({one.space, one.scenario, one.scenario.empty() ? one.asked_as : ""}).second)
      entry.fail("each scenario, and each command without a scenario, once in a space");
  }
  if (recorded.answers.empty()) reader.at("answers").fail("at least one");
  return recorded;
}

RecordedLanguageModel::RecordedLanguageModel(FeatureSpace space, std::string scenario, std::string source)
    : RecordedLanguageModel(OfFile(), std::move(space), std::move(scenario),
                            data_directory() / "answers" / (source + ".json")) {
  if (const auto sources = recorded_sources(); !contains(sources, source))
    throw InputError(
        fmt::format("answers: expected recorded or one of {}, got \"{}\"", fmt::join(sources, ", "), source));
}

RecordedLanguageModel::RecordedLanguageModel(OfFile, FeatureSpace space, std::string scenario, fs::path file)
    : space_(std::move(space)), scenario_(std::move(scenario)), file_(std::move(file)) {}

RecordedLanguageModel RecordedLanguageModel::of_file(FeatureSpace space, std::string scenario, fs::path file) {
  return {OfFile(), std::move(space), std::move(scenario), std::move(file)};
}

void RecordedLanguageModel::read() const {
  if (read_) return;
  static MadeOnce<RecordedFile> shipped;
  const auto keep = [this](const RecordedFile& recorded) {
    model_ = recorded.model;
    for (const RecordedAnswer& one : recorded.answers)
      if (one.space == space_.id) all_.push_back(one);
  };
  if (is_shipped(file_))
    keep(shipped.of(file_.string(), [this] { return read_recorded(file_); }));
  else
    keep(read_recorded(file_));
  read_ = true;
}

const RecordedAnswer* RecordedLanguageModel::find(const std::string& utterance) const {
  read();
  for (const RecordedAnswer& one : all_)
    if (!one.scenario.empty() && one.scenario == scenario_) return &one;
  for (const RecordedAnswer& one : all_)
    if (one.asked_as == utterance) return &one;
  return nullptr;
}

std::vector<std::string> RecordedLanguageModel::known() const {
  read();
  std::vector<std::string> names;
  for (const RecordedAnswer& one : all_) names.push_back(one.scenario.empty() ? one.asked_as : one.scenario);
  return names;
}

const RecordedAnswer& RecordedLanguageModel::expect(const std::string& utterance) const {
  if (const RecordedAnswer* found = find(utterance)) return *found;
  throw InputError(
      fmt::format("answers of {}: none for {}\"{}\" in the space {}, only for: {}; --answers openai asks "
                  "a model (docs/language-models.md)",
                  file_.stem().string(), scenario_.empty() ? "" : fmt::format("scenario {}, ", scenario_), utterance,
                  space_.id, some_of(known(), " | ")));
}

std::vector<bool> RecordedLanguageModel::answer(const Command& command, const FeatureSpace&,
                                                const std::vector<Question>& questions) {
  const RecordedAnswer& recorded = expect(command.utterance);
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

bool RecordedLanguageModel::has_meaning(const Command& command) const {
  const RecordedAnswer* recorded = find(command.utterance);
  return recorded && recorded->structured;
}

Meaning RecordedLanguageModel::mean(const Command& command, const FeatureSpace&) {
  const RecordedAnswer& recorded = expect(command.utterance);
  if (!recorded.structured)
    throw InputError(fmt::format("answers of {}: expected \"structured\" for \"{}\", which meaning=structured asks for",
                                 file_.stem().string(), recorded.asked_as));
  ++cost_.lm_queries;
  return *recorded.structured;
}

std::vector<Hypothesis> RecordedLanguageModel::hypotheses(const Command& command, const FeatureSpace&) {
  const RecordedAnswer* recorded = find(command.utterance);
  if (!recorded || recorded->hypotheses.empty()) return {};
  ++cost_.lm_queries;
  return recorded->hypotheses;
}

std::string RecordedLanguageModel::asked_as(const Command& command) const {
  const RecordedAnswer* recorded = find(command.utterance);
  return recorded ? recorded->asked_as : command.utterance;
}

}  // namespace lgabench

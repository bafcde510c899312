#include <lgabench/harness/answers.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/abstraction/chat_model.hpp>
#include <lgabench/abstraction/human.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>

namespace lgabench {
namespace {

// The file of that hash, if it still has it.
fs::path kept_file(const fs::path& kept, const std::string& hash, const char* ending) {
  const fs::path file = kept / (hash + ending);
  if (sha256_file(file) != hash) throw InputError(file.string() + ": does not have the bytes that its name says");
  return file;
}

std::string only_model(const Cassette& cassette, const fs::path& file) {
  const std::set<std::string> models = cassette.models();
  if (models.size() != 1)
    throw InputError(fmt::format("{}: expected replies of one model, it has {}", file.string(),
                                 models.empty() ? "none" : fmt::format("those of {}", fmt::join(models, ", "))));
  return *models.begin();
}

}  // namespace

std::vector<AnswerFile> kept_answers(const fs::path& run) {
  std::vector<AnswerFile> files;
  std::error_code none_there;
  for (const auto& entry : fs::directory_iterator(run / "answers", none_there))
    if (!is_temporary(entry.path()) && entry.symlink_status().type() == fs::file_type::regular)
      files.push_back({entry.path().filename(), entry.path(), Json::object()});
  return files;
}

void keep_answers(const std::vector<AnswerFile>& files, const fs::path& run) {
  for (const AnswerFile& file : files) {
    const fs::path to = run / "answers" / file.name;
    const std::string bytes = read_file(file.path);
    if (sha256(bytes) != to.stem().string())
      throw InputError(fmt::format("{}: changed since it was read, or does not have the bytes that its name says",
                                   file.path.string()));
    if (!fs::exists(to) || read_file(to) != bytes) write_file(to, bytes);
  }
}

CassetteAnswers check_cassette(const fs::path& file, const std::vector<std::string>& scenarios) {
  if (!fs::exists(file)) throw InputError(file.string() + ": cannot be read: no such cassette");
  Cassette cassette(file);
  const std::string model = only_model(cassette, file);
  ChatLanguageModel lm(cassette, nullptr, {model});
  for (const std::string& id : scenarios) {
    const Scenario scenario = load_scenario(id);
    for (int c = 0; c < static_cast<int>(scenario.commands.size()); ++c)
      select_features(scenario.command(c), scenario.space, lm);
  }
  const std::string hash = sha256_file(file);
  return {cassette_prefix + hash, {hash + ".jsonl", file, {{"model", model}}}};
}

void check_recorded(const std::string& answers, const std::vector<std::string>& scenarios) {
  std::vector<std::string> lacking, known;
  for (const std::string& id : scenarios) {
    const Scenario scenario = load_scenario(id);
    const RecordedLanguageModel lm(scenario, recorded_source(scenario, answers));
    const auto knows = [&](const ScenarioCommand& c) { return lm.knows({c.utterance, scenario.task}); };
    if (std::all_of(scenario.commands.begin(), scenario.commands.end(), knows)) continue;
    lacking.push_back(id);
    known = lm.known();
  }
  if (!lacking.empty())
    throw InputError(fmt::format("--answers {}: expected answers for {}; there are those for: {}", answers,
                                 fmt::join(lacking, ", "), fmt::join(known, " | ")));
}

std::vector<AnswerFile> read_participants(const fs::path& directory, std::vector<Participant>& all) {
  std::error_code error;
  const std::vector<std::string> names = json_names(directory, error);
  if (error || names.empty())
    throw InputError(fmt::format("{}: expected participants' .json files, {}", directory.string(),
                                 error ? error.message() : "there are none"));
  std::vector<AnswerFile> files;
  for (const std::string& name : names) {
    const fs::path file = directory / (name + ".json");
    Participant participant = read_participant(file);
    for (const Participant& other : all)
      if (other.id == participant.id)
        throw InputError(
            fmt::format("{}: /participant: \"{}\" has another file there, expected one each", file.string(), other.id));
    files.push_back({participant.sha256 + ".json", file, {{"participant", participant.id}}});
    all.push_back(std::move(participant));
  }
  return files;
}

Answers answers_for(const Cell& cell, const Scenario& scenario, const fs::path& kept) {
  Answers answers;
  if (const std::string prefix = cassette_prefix; cell.answers.rfind(prefix, 0) == 0) {
    const fs::path file = kept_file(kept, cell.answers.substr(prefix.size()), ".jsonl");
    answers.cassette = std::make_unique<Cassette>(file);
    answers.lm = std::make_unique<ChatLanguageModel>(*answers.cassette, nullptr,
                                                     ChatOptions{only_model(*answers.cassette, file)});
  } else {
    answers.lm = std::make_unique<RecordedLanguageModel>(
        scenario, recorded_source(scenario, cell.answers, cell.method.asks == "edit"));
  }
  std::unique_ptr<HumanAnswers> human;
  if (cell.participant)
    human = std::make_unique<ParticipantAsHuman>(read_participant(kept_file(kept, cell.participant->sha256, ".json")),
                                                 scenario);
  else
    human = std::make_unique<TruthAsHuman>(scenario.commands);
  answers.human = std::make_unique<DeclaredHuman>(std::move(human), cell.method.asks);
  answers.truth = declared_truth(scenario.commands, cell.method.asks);
  return answers;
}

}  // namespace lgabench

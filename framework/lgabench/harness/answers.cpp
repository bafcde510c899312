#include <lgabench/harness/answers.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>
#include <string_view>
#include <unordered_set>

#include <lgabench/abstraction/chat_model.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/suggest.hpp>

namespace lgabench {
namespace {

void expect_all_commands(const RecordedAnswers& answers, const std::vector<std::string>& scenarios,
                         const std::function<RecordedLanguageModel(const Scenario&)>& who_answers) {
  std::vector<std::string> lacking, known;
  for (const std::string& id : scenarios) {
    const Scenario scenario = load_scenario(id);
    const RecordedLanguageModel lm = who_answers(scenario);
    const auto knows = [&](const ScenarioCommand& c) { return lm.knows({c.utterance, scenario.task}); };
    if (std::all_of(scenario.commands.begin(), scenario.commands.end(), knows)) continue;
    lacking.push_back(id);
    known = lm.known();
  }
  if (!lacking.empty())
    throw InputError(fmt::format(
        "--answers {}: expected answers for {}; it has {}. Give --answers FILE.json, cassette:FILE or openai "
        "(docs/language-models.md), or, with methods that ask no language model, --answers {}",
        answers.source, some_of(lacking),
        known.empty() ? "none in their feature space" : "those for: " + some_of(known, " | "), to_string(NoAnswers())));
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
      throw InputError(
          fmt::format("{}: changed since it was read, or its SHA-256 is not the one in its name", file.path.string()));
    if (!fs::exists(to) || read_file(to) != bytes) write_file(to, bytes);
  }
}

std::optional<AnswerFile> kept_replies(const fs::path& run) {
  std::optional<AnswerFile> longest;
  for (const AnswerFile& file : kept_answers(run))
    if (file.path.extension() == ".jsonl" && (!longest || fs::file_size(file.path) > fs::file_size(longest->path)))
      longest = file;
  return longest;
}

bool holds_lines(const fs::path& all, const fs::path& some) {
  const auto lines_of = [](const std::string& text) {
    std::unordered_set<std::string_view> lines;
    for (std::size_t begin = 0, end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
      lines.insert(std::string_view(text).substr(begin, end - begin));
    return lines;
  };
  const std::string there = read_file(all), wanted = read_file(some);
  const auto lines = lines_of(there);
  for (const std::string_view line : lines_of(wanted))
    if (lines.count(line) == 0) return false;
  return true;
}

std::optional<AnswerFile> keep_replies(const fs::path& cassette, const Json& about, const fs::path& run) {
  if (!fs::exists(cassette)) return std::nullopt;
  std::string bytes = read_file(cassette);
  bytes.resize(bytes.rfind('\n') + 1);  // another run may be adding to it
  if (bytes.empty()) return std::nullopt;
  const AnswerFile file{sha256(bytes) + ".jsonl", cassette, about};
  if (const fs::path to = run / "answers" / file.name; !fs::exists(to) || read_file(to) != bytes) write_file(to, bytes);
  return file;
}

void drop_other_replies(const std::string& but, const fs::path& run) {
  for (const AnswerFile& file : kept_answers(run))
    if (file.path.extension() == ".jsonl" && file.name != but) fs::remove(file.path);
}

AnswerFile check_cassette(const fs::path& file, const std::vector<std::string>& scenarios) {
  if (!fs::exists(file)) throw InputError(file.string() + ": cannot be read: no such cassette");
  Cassette cassette(file);
  const std::string model = cassette.only_model();
  ChatLanguageModel lm(cassette, nullptr, {model});
  for (const std::string& id : scenarios) {
    const Scenario scenario = load_scenario(id);
    for (int c = 0; c < static_cast<int>(scenario.commands.size()); ++c)
      select_features(scenario.command(c), scenario.space, lm);
  }
  return {sha256_file(file) + ".jsonl", file, {{"model", model}}};
}

void check_recorded(const RecordedAnswers& answers, const std::vector<std::string>& scenarios) {
  expect_all_commands(answers, scenarios, [&](const Scenario& scenario) {
    return RecordedLanguageModel(scenario, recorded_source(scenario, answers.source));
  });
}

AnswerFile check_written(const fs::path& file, const std::vector<std::string>& scenarios) {
  const std::string model = read_recorded(file).model;
  expect_all_commands(RecordedAnswers{file.string()}, scenarios,
                      [&](const Scenario& s) { return RecordedLanguageModel::of_file(s.space, s.answers_of, file); });
  return {sha256_file(file) + ".json", file, {{"model", model}}};
}

Answerer::Answerer(const AnswerSource& source, const fs::path& file) : source_(source), file_(file) {
  const auto* live = std::get_if<LiveAnswers>(&source);
  if (!live && !std::holds_alternative<CassetteAnswers>(source)) return;
  cassette_.emplace(file);
  ChatOptions options;
  options.model = live ? live->model : cassette_->only_model();
  replies_ = std::make_unique<ChatLanguageModel>(*cassette_, nullptr, options);
}

LanguageModel& Answerer::of(const Scenario& scenario, bool to_edit) {
  if (replies_) return *replies_;
  if (const auto* recorded = std::get_if<RecordedAnswers>(&source_))
    return recorded_.emplace(scenario, recorded_source(scenario, recorded->source, to_edit));
  if (std::holds_alternative<FileAnswers>(source_))
    return recorded_.emplace(RecordedLanguageModel::of_file(scenario.space, scenario.answers_of, file_));
  return nobody_;
}

LackingAnswers lacking_answers(const std::vector<Cell>& cells, const Catalogue& catalogue, const AnswerSource& answers,
                               const fs::path& file) {
  Answerer answerer(answers, file);
  std::set<std::pair<const Json*, std::string>> seen;  // scenario, row
  LackingAnswers lacking;
  const auto add = [](const std::string& name, std::vector<std::string>& all) {
    if (!contains(all, name)) all.push_back(name);
  };
  for (const Cell& cell : cells) {
    if (cell.method.is_reference() || !catalogue.find("method", cell.method.id).questionnaire) continue;
    if (!seen.insert({cell.scenario.get(), cell.method.name}).second) continue;
    const Scenario scenario = read_scenario(*cell.scenario, "scenario");
    try {
      LanguageModel& model = answerer.of(scenario, cell.method.asks == "edit");
      for (int c = 0; c < static_cast<int>(scenario.commands.size()); ++c)
        select_as_asked(cell.method.options.value("meaning", "flat"), scenario.command(c), scenario.space, model);
    } catch (const Error& e) {
      if (lacking.reason.empty()) lacking.reason = e.what();
      add(cell.method.name, lacking.rows);
      add(scenario.id, lacking.scenarios);
    }
  }
  return lacking;
}

std::vector<AnswerFile> read_participants(const fs::path& directory, bool rehearsal, std::vector<Participant>& all) {
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
        throw InputError(fmt::format("{}: /participant: \"{}\" has a second file there, expected one a person",
                                     file.string(), other.id));
    if (participant.rehearsal && !rehearsal)
      throw InputError(fmt::format("{}: /rehearsal: answers of a rehearsal; --rehearsal runs on them and marks the run",
                                   file.string()));
    participant.rehearsal = rehearsal;
    files.push_back({participant.sha256 + ".json", file, {{"participant", participant.id}}});
    if (rehearsal) files.back().about["rehearsal"] = true;
    all.push_back(std::move(participant));
  }
  return files;
}

}  // namespace lgabench

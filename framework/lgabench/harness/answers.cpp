#include <lgabench/harness/answers.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <unordered_set>

#include <lgabench/abstraction/human.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench {
namespace {

// The file of that hash, if it still has it.
fs::path kept_file(const fs::path& kept, const std::string& hash, const char* ending) {
  const fs::path file = kept / (hash + ending);
  if (sha256_file(file) != hash) throw InputError(file.string() + ": does not have the bytes that its name says");
  return file;
}

// The model of a run. Its answers are live whichever cell was the first to ask, and a server that fails is not the
// method's fault.
class AskedByCells : public ChatLanguageModel {
 public:
  using ChatLanguageModel::ChatLanguageModel;
  std::vector<bool> answer(const Command& command, const FeatureSpace& space,
                           const std::vector<Question>& questions) override {
    try {
      return ChatLanguageModel::answer(command, space, questions);
    } catch (const MethodError& e) {
      throw InputError(e.what());
    }
  }
  Provenance provenance() const override { return Provenance::live; }
};

// Of a run in which nobody is asked.
class NobodyAnswers : public LanguageModel {
 public:
  std::vector<bool> answer(const Command& command, const FeatureSpace&, const std::vector<Question>&) override {
    throw InputError(fmt::format("the method asks a language model about \"{}\", and --answers {} has none",
                                 command.utterance, no_answers));
  }
  std::string model() const override { return no_answers; }
  Provenance provenance() const override { return Provenance::none; }
  SelectionCost cost() const override { return {}; }
};

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

Json to_json(const LiveModel& live) {
  return {{"cassette", fs::absolute(live.cassette).string()}, {"asks", live.asks}, {"max_queries", live.max_queries}};
}

LiveModel read_live_model(const JsonReader& reader) {
  LiveModel live;
  live.cassette = reader.at("cassette").string();
  live.asks = reader.at("asks").boolean();
  live.max_queries = static_cast<int>(reader.at("max_queries").integer(-1, 1 << 30));
  return live;
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

std::optional<AnswerFile> keep_replies(const LiveModel& live, const fs::path& run) {
  if (!fs::exists(live.cassette)) return std::nullopt;
  std::string bytes = read_file(live.cassette);
  bytes.resize(bytes.rfind('\n') + 1);  // another run may be adding to it
  if (bytes.empty()) return std::nullopt;
  const AnswerFile file{sha256(bytes) + ".jsonl", live.cassette, live.about};
  if (const fs::path to = run / "answers" / file.name; !fs::exists(to) || read_file(to) != bytes) write_file(to, bytes);
  return file;
}

void drop_other_replies(const std::string& but, const fs::path& run) {
  for (const AnswerFile& file : kept_answers(run))
    if (file.path.extension() == ".jsonl" && file.name != but) fs::remove(file.path);
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
    throw InputError(fmt::format(
        "--answers {}: expected answers for {}; there are those for: {}. Others: --answers cassette:FILE or "
        "openai (docs/language-models.md); with methods that ask no language model: --answers {}",
        answers, fmt::join(lacking, ", "), fmt::join(known, " | "), no_answers));
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

Answers answers_for(const Cell& cell, const Scenario& scenario, const fs::path& kept, const LiveModel& live) {
  Answers answers;
  if (is_live(cell.answers)) {
    ChatOptions options{cell.answers.substr(std::string_view(live_prefix).size())};
    options.max_queries = live.max_queries;
    options.waiting = [](const std::string& why) { to_stderr("{}\n", one_line(why)); };
    answers.cassette = std::make_unique<Cassette>(live.cassette);
    answers.lm = std::make_unique<AskedByCells>(*answers.cassette, live.server, options);
  } else if (const std::string prefix = cassette_prefix; cell.answers.rfind(prefix, 0) == 0) {
    const fs::path file = kept_file(kept, cell.answers.substr(prefix.size()), ".jsonl");
    answers.cassette = std::make_unique<Cassette>(file);
    answers.lm = std::make_unique<ChatLanguageModel>(*answers.cassette, nullptr,
                                                     ChatOptions{only_model(*answers.cassette, file)});
  } else if (cell.answers == no_answers) {
    answers.lm = std::make_unique<NobodyAnswers>();
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

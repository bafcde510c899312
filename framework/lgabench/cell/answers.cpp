#include <lgabench/cell/answers.hpp>

#include <lgabench/abstraction/human.hpp>
#include <lgabench/abstraction/nobody.hpp>
#include <lgabench/abstraction/participant.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench {
namespace {

// The file of that hash, if it still has it.
fs::path kept_file(const fs::path& kept, const std::string& hash, const char* ending) {
  const fs::path file = kept / (hash + ending);
  if (sha256_file(file) != hash) throw InputError(file.string() + ": its SHA-256 is not the one in its name");
  return file;
}

// Returns ask(); a server that fails is not the method's fault.
template <class Ask>
auto not_of_the_method(Ask&& ask) {
  try {
    return ask();
  } catch (const MethodError& e) {
    throw InputError(e.what());
  }
}

// The model of a run. Its answers are live whichever cell was the first to ask.
class AskedByCells : public ChatLanguageModel {
 public:
  using ChatLanguageModel::ChatLanguageModel;
  std::vector<bool> answer(const Command& command, const FeatureSpace& space,
                           const std::vector<Question>& questions) override {
    return not_of_the_method([&] { return ChatLanguageModel::answer(command, space, questions); });
  }
  Meaning mean(const Command& command, const FeatureSpace& space) override {
    return not_of_the_method([&] { return ChatLanguageModel::mean(command, space); });
  }
  std::vector<Hypothesis> hypotheses(const Command& command, const FeatureSpace& space) override {
    return not_of_the_method([&] { return ChatLanguageModel::hypotheses(command, space); });
  }
  Provenance provenance() const override { return Provenance::live; }
};

}  // namespace

Answers answers_for(const CellJob& job, const Scenario& scenario, ChatClient* server,
                    const std::function<void(bool)>& in_line) {
  const Cell& cell = job.cell;
  Answers answers;
  if (const auto* asked = std::get_if<LiveAnswers>(&cell.answers)) {
    ChatOptions options{asked->model};
    const LiveModel live = job.live.value_or(LiveModel());
    options.max_queries = live.max_queries;
    options.concurrency = live.concurrency;
    options.any_served = live.any_served;
    options.prompt = live.prompt;
    options.in_line = in_line;
    options.waiting = [](const std::string& why) { to_stderr("{}\n", one_line(why)); };
    answers.cassette = std::make_unique<Cassette>(live.cassette);
    answers.lm = std::make_unique<AskedByCells>(*answers.cassette, server, options);
  } else if (const auto* replies = std::get_if<CassetteAnswers>(&cell.answers)) {
    const fs::path file = kept_file(job.answers, replies->file, ".jsonl");
    answers.cassette = std::make_unique<Cassette>(file);
    answers.lm =
        std::make_unique<ChatLanguageModel>(*answers.cassette, nullptr, ChatOptions{answers.cassette->only_model()});
  } else if (const auto* written = std::get_if<FileAnswers>(&cell.answers)) {
    answers.lm = std::make_unique<RecordedLanguageModel>(RecordedLanguageModel::of_file(
        scenario.space, scenario.answers_of, kept_file(job.answers, written->file, ".json")));
  } else if (const auto* recorded = std::get_if<RecordedAnswers>(&cell.answers)) {
    answers.lm = std::make_unique<RecordedLanguageModel>(
        scenario, recorded_source(scenario, recorded->source, cell.method.asks == "edit"));
  } else {
    answers.lm = std::make_unique<Nobody>();
  }
  std::unique_ptr<HumanAnswers> human;
  if (cell.participant)
    human = std::make_unique<ParticipantAsHuman>(
        read_participant(kept_file(job.answers, cell.participant->sha256, ".json")), scenario);
  else
    human = people_of(scenario, cell.layout, cell.training_seed, cell.demonstrations, cell.method.options);
  answers.human = std::make_unique<DeclaredHuman>(std::move(human), cell.method.asks);
  answers.truth = declared_truth(scenario.commands, cell.method.asks);
  return answers;
}

std::unique_ptr<HumanAnswers> people_of(const Scenario& scenario, const std::string& layout,
                                        std::uint64_t training_seed, int demonstrations, const Json& options) {
  if (!scenario.questions) return std::make_unique<TruthAsHuman>(scenario.commands);
  return std::make_unique<AskedInScenes>(
      scenario, demonstrations, options.value("questions", 0), [&scenario, layout, training_seed](int command, int n) {
        const int index = n * static_cast<int>(scenario.commands.size()) + command;
        return placed(scenario.environment->draw(training_scene(scenario, layout, {}, training_seed, index)));
      });
}

}  // namespace lgabench

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include <lgabench/abstraction/chat_model.hpp>
#include <lgabench/abstraction/nobody.hpp>
#include <lgabench/abstraction/openai_client.hpp>
#include <lgabench/abstraction/quality.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/abstraction/selection_text.hpp>
#include <lgabench/cli/commands.hpp>
#include <lgabench/cli/open_questions.hpp>
#include <lgabench/cli/reading_score.hpp>
#include <lgabench/cli/select_score.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/rounding.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/counted_progress.hpp>
#include <lgabench/harness/questions.hpp>
#include <lgabench/harness/suite.hpp>

namespace lgabench::cli {
namespace {

struct SelectArguments {
  std::string command, suite, answers = "recorded", truth = "released", task = "pick_and_place", space, model, cassette,
                              request, prompt, best_product;
  long reply_timeout_s = OpenAiOptions().timeout_s;
  int concurrency = 4, max_queries = -1;
  bool json = false, score = false, show_prompt = false, any_served = false;
  int scenes = 30;
  std::vector<std::string> names, segments, arms;
  std::vector<fs::path> plugin_path;
};

// What is asked: the words, and the truth where a scenario has one for them.
struct Asked {
  std::string scenario;              // its id; empty for words alone
  std::string answers_of, recorded;  // the scenario's, see there
  FeatureSpace space;
  Command command;
  std::optional<Selection> truth;
};

// Over all commands: each begins to count anew. How many questions a score asks depends on the replies.
class Progress {
 public:
  void begin(int open) { line_.emplace("asked", open, CountedProgress::Brief::told); }
  void tell(int asked, int of_command) {
    if (!line_) line_.emplace("asked");
    line_->tell(before_ + asked);
    if (asked == of_command) before_ += asked;
  }

 private:
  std::optional<CountedProgress> line_;
  int before_ = 0;
};

// Whoever answers all commands, and what it stands on; no model for recorded answers, which go by the scenario.
struct Answerer {
  std::shared_ptr<Progress> progress = std::make_shared<Progress>();
  std::unique_ptr<ChatClient> client;
  std::unique_ptr<Cassette> cassette;
  std::unique_ptr<ChatLanguageModel> model;
};

// The one of those that replied that has the name, or the only one where there is none.
std::string kept_model(const Cassette& cassette, const std::string& name) {
  const std::set<std::string> all = cassette.models();
  std::vector<std::string> named;
  std::copy_if(all.begin(), all.end(), std::back_inserter(named), [&name](const std::string& text) {
    return name.empty() || name == text || name == read_asked_model(text).name;
  });
  if (named.size() != 1)
    throw InputError(
        fmt::format("--model: expected one; {} holds replies of: {}", cassette.file().string(), fmt::join(all, ", ")));
  return named.front();
}

Answerer make_answerer(const SelectArguments& a) {
  Answerer answerer;
  const AnswerSource source = read_answer_source(a.answers);
  const bool live = std::holds_alternative<LiveAnswers>(source);
  const auto* kept = std::get_if<CassetteAnswers>(&source);
  const std::string file = live ? a.cassette : kept ? kept->file : "";
  if (live && file.empty()) throw InputError("--answers openai: expected --cassette FILE too");
  if (!live && !a.cassette.empty()) throw InputError("--cassette: expected --answers openai with it");
  if (file.empty() && !a.model.empty())
    throw InputError(fmt::format("--model: expected --answers openai or cassette:FILE with it, not {}", a.answers));
  if (!live && (a.max_queries >= 0 || !a.request.empty() || !a.prompt.empty() ||
                a.reply_timeout_s != OpenAiOptions().timeout_s || a.any_served))
    throw InputError(
        "--max-queries, --request, --prompt, --reply-timeout and --any-served: expected --answers openai with them");
  if (std::holds_alternative<NoAnswers>(source) && !a.score)
    throw InputError("--answers none: expected --score with it");
  if (file.empty()) return answerer;
  answerer.cassette = std::make_unique<Cassette>(file);
  if (live && a.model.empty()) throw InputError("--model: expected one with --answers openai");
  const std::string prompt = read_prompt(a.prompt);
  ChatOptions options{live ? to_text(asked_model(a.model, a.request, prompt)) : kept_model(*answerer.cassette, a.model),
                      a.concurrency,
                      a.max_queries,
                      {}};
  options.prompt = prompt;
  options.any_served = a.any_served;
  options.expects_read = a.score;
  if (live) {
    OpenAiOptions server = openai_from_environment();
    server.timeout_s = a.reply_timeout_s;
    server.waiting =
        options.waiting = [](const std::string& why) { to_stderr("{}{}\n", ::isatty(2) ? "\n" : "", one_line(why)); };
    answerer.client = std::make_unique<OpenAiClient>(std::move(server));
    options.progress = [progress = answerer.progress](int asked, int of_command) { progress->tell(asked, of_command); };
  }
  answerer.model = std::make_unique<ChatLanguageModel>(*answerer.cassette, answerer.client.get(), options);
  return answerer;
}

std::vector<Asked> commands_of(const Scenario& scenario) {
  std::vector<Asked> asked;
  for (const ScenarioCommand& c : scenario.commands)
    asked.push_back({scenario.id,
                     scenario.answers_of,
                     scenario.recorded,
                     scenario.space,
                     {c.utterance, scenario.task, scenario.second},
                     c.truth});
  return asked;
}

// Who answers for one command: recorded answers go by the scenario.
LanguageModel& answerer_of(const Asked& asked, LanguageModel* model, const SelectArguments& arguments,
                           std::optional<RecordedLanguageModel>& recorded) {
  const AnswerSource source = read_answer_source(arguments.answers);
  if (const auto* written = std::get_if<FileAnswers>(&source))
    return recorded.emplace(RecordedLanguageModel::of_file(asked.space, asked.answers_of, written->file));
  if (model) return *model;
  return recorded.emplace(asked.space, asked.answers_of,
                          arguments.answers == "recorded" ? asked.recorded : arguments.answers);
}

// All commands of the suite, or of the scenario of that id, or the one with that utterance; else the words alone, which
// have no truth.
std::vector<Asked> find_commands(const SelectArguments& arguments) {
  const Truth truth = read_truth(arguments.truth);
  if (!arguments.suite.empty()) {
    std::vector<Asked> all;
    for (const std::string& id : load_suite(arguments.suite).design.scenarios)
      for (Asked& asked : commands_of(load_scenario(id, truth))) all.push_back(std::move(asked));
    return all;
  }
  const std::string space =
      arguments.space.empty() ? environment_with_task(arguments.task).spaces().front() : arguments.space;
  std::vector<Asked> same_words;
  for (const std::string& id : scenario_ids()) {
    const Scenario scenario = load_scenario(id, truth);
    if (id == arguments.command) return commands_of(scenario);
    for (Asked& asked : commands_of(scenario))
      if (asked.command.utterance == arguments.command) same_words.push_back(std::move(asked));
  }
  for (const Asked& asked : same_words)  // two scenarios may say the same in two spaces
    if (asked.space.id == space) return {asked};
  if (!same_words.empty()) return {same_words.front()};
  if (arguments.command.find(' ') == std::string::npos) load_scenario(arguments.command);  // says which there are
  Asked asked{"",
              "",
              Scenario().recorded,
              load_feature_space(space),
              {arguments.command, arguments.task, std::nullopt},
              std::nullopt};
  for (const TaskInfo& task : installed_tasks())
    if (task.id == arguments.task) asked.command.second = task.second;
  return {asked};
}

void say_what_is_open(const Answerer& answerer, const std::vector<Asked>& commands, int at_once) {
  Questions all{0, 0, at_once, answerer.cassette->mean_seconds()};
  for (const Asked& asked : commands) all.add(*answerer.model, asked.command, asked.space);
  answerer.progress->begin(all.open);
  to_stderr("{}\n", all.text());
}

std::string list(const std::vector<std::string>& names, const std::vector<std::string>& all) {
  if (names.empty()) return "(none)";
  return names == all ? fmt::format("any of the {}", all.size()) : fmt::format("{}", fmt::join(names, ", "));
}

// "precision .71, recall 1.00 of 4 true ones", where there is a truth.
std::string describe(const NameQuality& quality) {
  const auto share = [](const std::optional<double>& value) { return value ? fixed(*value) : "-"; };
  return fmt::format("{} selected, {} true: precision {}, recall {}", quality.size, quality.true_size,
                     share(quality.precision), share(quality.recall));
}

void print_set(const char* name, const FeatureSet& set, const FeatureSpace& space, const Quality& quality) {
  const auto judged = quality.find(name);
  to_stdout("{}\n  object types  {}\n", name, list(set.object_types, space.object_types));
  if (judged != quality.end()) to_stdout("                {}\n", describe(judged->second.object_types));
  to_stdout("  textures      {}\n", list(set.textures, space.textures));
  if (judged != quality.end()) to_stdout("                {}\n", describe(judged->second.textures));
}

void select(const Asked& asked, LanguageModel* answering, const SelectArguments& arguments) {
  std::optional<RecordedLanguageModel> recorded;
  LanguageModel& model = answerer_of(asked, answering, arguments, recorded);
  const auto start = std::chrono::steady_clock::now();
  const Selection selection = select_features(asked.command, asked.space, model);
  const double passed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Quality judged = asked.truth ? quality(selection, *asked.truth) : Quality{};
  const std::string text = selection_text(selection, asked.space);
  if (const std::string why = empty_text(selection); !why.empty())
    to_stderr("{}\"{}\" keeps no object: {}\n", asked.scenario.empty() ? "" : asked.scenario + ": ",
              asked.command.utterance, why);
  if (arguments.json) {
    to_stdout("{}\n", canonical({{"utterance", asked.command.utterance},
                                 {"selection", to_json(selection)},
                                 {"text", text},
                                 {"true_text", asked.truth ? Json(selection_text(*asked.truth, asked.space)) : Json()},
                                 {"quality", to_json(judged)}}));
    return;
  }
  to_stdout("command     {}\n", asked.command.utterance);
  if (selection.asked_as != asked.command.utterance) to_stdout("asked as    {}\n", selection.asked_as);
  to_stdout("answers     {} ({})\n", selection.source, to_string(selection.provenance));
  to_stdout("cost        {} queries", selection.cost.lm_queries);
  if (selection.cost.lm_tokens > 0)
    to_stdout(", {} tokens, {:.1f} s of waiting", selection.cost.lm_tokens, selection.cost.lm_seconds);
  if (selection.provenance == Provenance::live) to_stdout(", {:.1f} s by the clock", passed_s);
  to_stdout("\n");
  to_stdout("in words    {}\n", text);
  for (const FeatureSet& set : selection.target.sets) print_set("target", set, asked.space, judged);
  if (const auto& second = selection.second) print_set(second->role.c_str(), *second, asked.space, judged);
}

// What a server would be asked first about the command: whether the target could have the space's first object type.
void show_prompt(const Asked& asked, const PromptTemplate& words) {
  const Question first = feature_questions(asked.command, asked.space).front();
  const Prompt prompt = words.fill(asked.command, asked.space, first);
  to_stdout("{}\n---\n{}", prompt.system, prompt.user);
}

// Whether who answers is asked about pictures.
bool looks(const SelectArguments& a) { return contains(a.names, looked); }

void score_reading(const SelectArguments& a) {
  const Answerer answerer = looks(a) ? make_answerer(a) : Answerer();
  if (looks(a) && !answerer.model)
    throw InputError("--names looked: expected --answers openai or cassette:FILE with it");
  print_reading_scores(load_suite(a.suite), read_truth(a.truth), {a.scenes, a.json, a.names, a.segments, a.arms},
                       answerer.model.get());
}

}  // namespace

void add_select(CLI::App& app, int&) {
  auto arguments = std::make_shared<SelectArguments>();
  Verb verb(app, "select", worker_summary("select"));
  auto* command = verb.option("command COMMAND", arguments->command, "A scenario's id, or a command in quotes");
  verb.option("--json", arguments->json,
              "Print one line of JSON per command, as in a cell's selection.json, or per row of --score");
  verb.below("What is asked");
  verb.option("--suite SUITE", arguments->suite, "Ask about every command of this suite's scenarios instead")
      ->excludes(command);
  verb.option("--truth released|printed", arguments->truth,
              "Which true distribution to compare with where released and printed ones differ",
              one_of("truth", {"released", "printed"}), with_default);
  verb.option(fmt::format("--task {}", fmt::join(installed_task_ids(), "|")), arguments->task,
              "The task, for a command in quotes", one_of("task", installed_task_ids()), with_default);
  verb.option("--space SPACE", arguments->space,
              "The feature space, for a command in quotes (default: the usual one of the task's environment)",
              feature_space());
  add_plugin_path(verb, arguments->plugin_path, any_plugin);
  add_scenario_path(verb);
  auto* score = verb.option("--score", arguments->score,
                            "With --suite: score, without a policy, how exactly the answers keep the meant objects in "
                            "test scenes: asked yes or no about each feature, asked what the command means, and "
                            "the names in the command alone")
                    ->needs("--suite");
  verb.option("--scenes N", arguments->scenes, "With --score: test scenes of each arm", CLI::Range(1, 100000),
              with_default)
      ->needs(score);
  verb.option("--names SOURCE,...", arguments->names,
              "With --score: score the reading of test scenes instead, with the true Selections: simulator, read, "
              "read_balanced, read_drawn, read_robust; looked: a model sees each picture and says which of its "
              "objects the command could mean (--answers openai or cassette:FILE)")
      ->needs(score);
  verb.option("--segments SOURCE,...", arguments->segments,
              "With --score: read from segments of: simulator, difference")
      ->needs(score);
  verb.option("--arms ARM,...", arguments->arms, "With --names or --segments: score only these arms")->needs(score);
  verb.option("--best-product FILE", arguments->best_product,
              "With --suite: write a reference for --answers FILE instead: for each command the product of types and "
              "textures that keeps the meant objects in most training scenes (found by ascent, from the truth)")
      ->needs("--suite")
      ->excludes(score);
  verb.option(
          "--show-prompt", arguments->show_prompt,
          "Print the first question that a server would get, system prompt, a line ---, user prompt, and ask nobody")
      ->excludes(score);
  verb.below("Who answers");
  verb.option(
      "--answers SOURCE", arguments->answers,
      "recorded: the scenario's recorded answers; another name from lgabench list sources: only that source; "
      "openai: ask a server now; cassette:FILE: a server's recorded replies; FILE.json: your own answers; none "
      "(with --score): the names in the commands alone",
      [](const std::string& word) { return answers_complaint(word, true); }, with_default);
  verb.option("--cassette FILE", arguments->cassette,
              "With --answers openai: the file to append the server's replies to");
  verb.option("--model MODEL", arguments->model,
              "The server's model; for a cassette, the model whose replies to use (default: its only one)");
  verb.option("--concurrency N", arguments->concurrency, "How many questions to ask at once", CLI::Range(1, 64),
              with_default);
  add_server(verb, arguments->request, arguments->reply_timeout_s, arguments->any_served);
  add_prompt(verb, arguments->prompt);
  verb.option("--max-queries N", arguments->max_queries, "The most questions to ask a server; -1: no limit",
              CLI::Range(-1, 1000000), with_default);
  verb->footer(
      "With --answers openai, select asks the server at OPENAI_BASE_URL (any with OpenAI's API) one question for each "
      "object type and texture; OPENAI_API_KEY holds the key. Run an interrupted command again, and it continues from "
      "the cassette, which `lgabench run --answers cassette:M.jsonl` reads.\n\n"
      "Examples\n"
      "  lgabench select red_heart                              the recorded answers about a scenario\n"
      "  lgabench select --suite words --score                  how exact answers are, as a table\n"
      "  lgabench select --suite pictures --score --names read,read_robust       what is read from pictures\n"
      "  lgabench select --suite q1 --answers openai --model M --cassette M.jsonl      asks a model\n"
      "  lgabench select \"Bring a fruit.\" --space household --answers openai --model M --cassette M.jsonl");
  verb->callback([arguments] {
    if (arguments->command.empty() && arguments->suite.empty())
      throw InputError("select: expected a command, a scenario's id, or --suite");
    if (!arguments->best_product.empty())
      return write_best_products(load_suite(arguments->suite), read_truth(arguments->truth), arguments->best_product);
    if (!arguments->arms.empty() && arguments->names.empty() && arguments->segments.empty())
      throw InputError("--arms: expected --names or --segments with it");
    if (!arguments->names.empty() || !arguments->segments.empty()) return score_reading(*arguments);
    if (arguments->show_prompt) {
      const PromptTemplate words = PromptTemplate::of_text(read_prompt(arguments->prompt));
      for (const Asked& asked : find_commands(*arguments)) show_prompt(asked, words);
      return;
    }
    const Answerer answerer = make_answerer(*arguments);
    if (arguments->score) {
      const auto with_answers = [&](const Scenario& scenario, const std::function<void(LanguageModel&)>& use) {
        std::optional<RecordedLanguageModel> recorded;
        if (Nobody nobody; arguments->answers == nobody.model()) return use(nobody);
        use(answerer_of(commands_of(scenario).front(), answerer.model.get(), *arguments, recorded));
      };
      return print_scores(load_suite(arguments->suite), read_truth(arguments->truth), arguments->scenes,
                          arguments->json, arguments->answers != Nobody().model(), with_answers);
    }
    const std::vector<Asked> commands = find_commands(*arguments);
    if (answerer.client) say_what_is_open(answerer, commands, arguments->concurrency);
    bool first = true;
    OpenQuestions open;
    for (const Asked& asked : commands) {
      if (!first && !arguments->json) to_stdout("\n");
      first = false;
      try {
        select(asked, answerer.model.get(), *arguments);
      } catch (const Unanswered& e) {
        open.add(e);
      }
    }
    open.expect_none(
        fmt::format("questions have no answer; all others are answered in {}, and the same command asks these again",
                    arguments->cassette));
  });
}

}  // namespace lgabench::cli

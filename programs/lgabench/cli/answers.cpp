// lgabench answers: a suite's questions for another program to ask, and that program's replies as a cassette.
#include <fmt/format.h>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/abstraction/chat_model.hpp>
#include <lgabench/abstraction/completion.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/shell.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/suite.hpp>
#include <lgabench/harness/suite_scenario.hpp>
#include <lgabench/record/answer_source.hpp>

namespace lgabench::cli {
namespace {

const std::vector<std::string> forms{"flat", "structured"};

struct AnswersArguments {
  std::string suite, form = forms.front(), model, request, prompt;
  fs::path questions, from, cassette;
  bool batch = false, any_served = false;
  std::vector<fs::path> plugin_path;
};

template <class Use>
void with_each_command(const std::string& suite_id, Use&& use) {
  const Suite suite = load_suite(suite_id);
  for (const std::string& id : suite_scenario_ids(suite, suite.design)) {
    const Scenario scenario = suite_scenario(suite, id, Truth::released);
    for (int c = 0; c < static_cast<int>(scenario.commands.size()); ++c) use(scenario.command(c), scenario.space);
  }
}

// What names a question: its words, so that a reply to other words is none to it.
std::string id_of(const std::string& system, const std::string& user) {
  constexpr std::size_t digits = 16;
  return sha256(canonical({{"system", system}, {"user", user}})).substr(0, digits);
}

// A line of a batch file, as OpenAI's API and those that follow it take it. Its name is all that comes back.
Json batch_line(const AnswersArguments& a, const AskedModel& model, const std::string& id, const Prompt& prompt) {
  return {{"custom_id", fmt::format("{}/{}/{}", a.suite, a.form, id)},
          {"method", "POST"},
          {"url", "/v1/chat/completions"},
          {"body", model.request(messages_of(prompt))}};
}

// Each question once, a line each: what names it, what it is about, and the two messages that a model is shown.
void write_questions(const AnswersArguments& a) {
  const bool structured = a.form == "structured";
  const AskedModel model = a.batch ? asked_model(a.model, a.request) : AskedModel{};
  const PromptTemplate yes_or_no = PromptTemplate::of_text(read_prompt(a.prompt)), of_meaning("meaning.txt");
  std::string lines;
  std::set<std::string> seen;
  with_each_command(a.suite, [&](const Command& command, const FeatureSpace& space) {
    const auto add = [&](const Prompt& prompt, const std::string& about) {
      const std::string id = id_of(prompt.system, prompt.user);
      if (!seen.insert(id).second) return;
      const Json line =
          a.batch ? batch_line(a, model, id, prompt) : Json{{"suite", a.suite},   {"form", a.form},
                                                            {"id", id},           {"command", command.utterance},
                                                            {"about", about},     {"system", prompt.system},
                                                            {"user", prompt.user}};
      lines += canonical(line) + '\n';
    };
    if (structured) add(of_meaning.fill(command, space), "what it means");
    for (const Question& question : feature_questions(command, space))
      if (!structured || question.about == Question::About::second)
        add(yes_or_no.fill(command, space, question), question.candidate);
  });
  write_file(a.questions, lines);
  to_stdout("{}: {} questions\n", a.questions.string(), seen.size());
}

// @throws NoAnswer for a line that failed.
ChatReply reply_of_batch(const JsonReader& line) {
  if (line.has("error") && !line.at("error").json().is_null()) {
    const std::string says = completion_error(line.json());
    throw NoAnswer("the server says: " + (says.empty() ? canonical(line.at("error").json()) : says));
  }
  if (!line.has("response") || line.at("response").json().is_null()) throw NoAnswer("the line has no response");
  const JsonReader response = line.at("response");
  const Json body = response.at("body").json();
  const long long status = response.has("status_code") ? response.at("status_code").integer(0, 1 << 20) : 200;
  if (status != 200) throw NoAnswer(fmt::format("status {}: {}", status, completion_error(body)));
  try {
    return read_completion(canonical(body));
  } catch (const InputError& e) {
    throw NoAnswer(e.what());
  }
}

// In place of a server: says of a question what the file has. Asked again, as after a reply that cannot be read, it
// says the same.
class GivenReplies : public ChatClient {
 public:
  explicit GivenReplies(const fs::path& file) : file_(file) {
    int number = 0;
    for (const Json& line : parse_json_lines(mended_json(read_file(file)), file.string())) {
      const JsonReader reader(line, fmt::format("{}: line {}", file.string(), ++number));
      if (reader.has("custom_id")) {
        read_batch_line(reader);
        continue;
      }
      const std::string form = reader.at("form").string();
      if (form != forms[0] && form != forms[1]) reader.at("form").fail("flat or structured");
      asked_.insert({reader.at("suite").string(), form});
      const std::string id = reader.at("id").string();
      if (reader.has("system") && id_of(reader.at("system").string(), reader.at("user").string()) != id)
        reader.fail("the messages of --questions; the model was shown others");
      ChatReply reply{reader.at("reply").string()};
      for (const auto& [member, tokens] : {std::pair("tokens", &reply.tokens),
                                           {"prompt_tokens", &reply.prompt_tokens},
                                           {"reply_tokens", &reply.reply_tokens}})
        if (reader.has(member)) *tokens = reader.at(member).integer(0, 1LL << 40);
      if (reader.has("seconds")) reply.seconds = read_reply_seconds(reader.at("seconds"));
      for (const auto& [member, word] : {std::pair("served", &reply.served), {"day", &reply.day}})
        if (reader.has(member)) *word = read_word(reader.at(member));
      keep(reader, id, reply);
    }
    if (asked_.empty()) throw InputError(fmt::format("{}: expected a line for each question", file.string()));
  }

  ChatReply complete(const Json& request) override {
    const Json& messages = request.at("messages");
    const std::string id = id_of(messages.at(0).at("content"), messages.at(1).at("content"));
    const auto found = replies_.find(id);
    if (found != replies_.end()) return found->second;
    const auto why = failed_.find(id);
    throw NoAnswer(why == failed_.end() ? fmt::format("no reply in {}", file_.string()) : why->second);
  }

  /// Suite and form of its questions.
  const std::set<std::pair<std::string, std::string>>& asked() const { return asked_; }

 private:
  void keep(const JsonReader& line, const std::string& id, const ChatReply& reply) {
    const auto [there, is_new] = replies_.insert({id, reply});
    if (!is_new && there->second.text != reply.text) line.fail("one reply to each question");
  }

  // {"custom_id", "response": {"status_code", "body"}, "error"}: a line that failed has an error, another status, or
  // nothing to read in its body. A later line of the same question, as of a second batch, may have its reply.
  void read_batch_line(const JsonReader& line) {
    const std::string name = line.at("custom_id").string();
    const std::size_t of_id = name.rfind('/'), of_form = of_id == name.npos ? name.npos : name.rfind('/', of_id - 1);
    if (of_form == name.npos || of_form == 0) line.at("custom_id").fail("SUITE/FORM/ID, as --batch writes it");
    const std::string form = name.substr(of_form + 1, of_id - of_form - 1), id = name.substr(of_id + 1);
    if (form != forms[0] && form != forms[1]) line.at("custom_id").fail("SUITE/FORM/ID, as --batch writes it");
    asked_.insert({name.substr(0, of_form), form});
    try {
      keep(line, id, reply_of_batch(line));
    } catch (const NoAnswer& e) {
      failed_.insert({id, e.what()});
    }
  }

  fs::path file_;
  std::set<std::pair<std::string, std::string>> asked_;
  std::map<std::string, ChatReply> replies_;   // by id
  std::map<std::string, std::string> failed_;  // why, by id
};

void keep_replies(const AnswersArguments& a) {
  GivenReplies replies(a.from);
  Cassette cassette(a.cassette);
  const std::string prompt = read_prompt(a.prompt);
  ChatOptions options{to_text(asked_model(a.model, a.request, prompt))};
  options.prompt = prompt;
  options.concurrency = 1;
  options.any_served = a.any_served;
  ChatLanguageModel model(cassette, &replies, options);
  std::vector<std::string> unanswered;
  std::string next;
  for (const auto& [suite, form] : replies.asked()) {
    with_each_command(suite, [&, &way = form](const Command& command, const FeatureSpace& space) {
      try {
        select_as_asked(way, command, space, model);
      } catch (const Unanswered& e) {
        unanswered.insert(unanswered.end(), e.questions.begin(), e.questions.end());
      }
    });
    next = shell_line({"lgabench", "select", "--suite", suite, "--score", "--answers",
                       to_string(CassetteAnswers{a.cassette.string()})});
  }
  for (const std::string& question : unanswered) to_stderr("no answer: {}\n", one_line(question));
  if (!unanswered.empty())
    throw MethodError(fmt::format("{} questions have no answer; the replies to all others are in {}", unanswered.size(),
                                  a.cassette.string()));
  to_stdout("{}: replies of {}\nTheir score: {}\n", a.cassette.string(), options.model, next);
}

}  // namespace

void add_answers(CLI::App& app, int& exit) {
  auto a = std::make_shared<AnswersArguments>();
  Verb verb(app, "answers", "Write a suite's questions for another program to ask, or keep the replies that it got");
  auto* suite = verb.option("suite SUITE", a->suite, "The suite whose commands the questions are about");
  verb.below("Questions");
  auto* questions = verb.option("--questions FILE", a->questions,
                                "Write a line of JSON for each question, with the messages for the model")
                        ->needs(suite);
  verb.option("--form flat|structured", a->form,
              "flat: ask yes or no about each object type and texture; structured: ask what each command means",
              one_of("form", forms), with_default)
      ->needs(questions);
  verb.option("--batch", a->batch,
              "Write a batch file for OpenAI's API instead, with one request to --model in each line")
      ->needs(questions);
  add_plugin_path(verb, a->plugin_path, any_plugin);
  add_scenario_path(verb);
  verb.below("Replies");
  auto* from = verb.option("--from FILE", a->from,
                           "The file of replies: the lines of --questions, each with its `reply`; a batch's output; "
                           "or, with the Python package, a log of Inspect or lm-evaluation-harness")
                   ->excludes(questions)
                   ->excludes(suite);
  verb.option("--cassette FILE", a->cassette, "The file to append the replies to, for --answers cassette:FILE")
      ->needs(from);
  verb.option("--any-served", a->any_served,
              "Keep replies of all the models that the replies name, as in lgabench select")
      ->needs(from);
  verb.option("--model MODEL", a->model, "The model that replied; with --batch the one to ask");
  verb.option("--request JSON", a->request, "A JSON merge patch applied to each request, as in lgabench select");
  add_prompt(verb, a->prompt);
  verb->footer(
      "A question without an answer is named and left out. A reply whose meaning cannot be read selects nothing.\n"
      "docs/language-models.md says how an evaluation harness asks.\nExample: lgabench answers words --form structured "
      "--questions words.jsonl\n         lgabench answers words --batch --model M --questions batch.jsonl\n"
      "         lgabench answers --from replied.jsonl --model M --cassette M.jsonl");
  verb->callback([a, &exit] {
    if (a->questions.empty() == a->from.empty())
      throw InputError("answers: expected SUITE and --questions FILE, or --from FILE");
    if (!a->from.empty() && (a->model.empty() || a->cassette.empty()))
      throw InputError("answers --from: expected --model MODEL and --cassette FILE too");
    if (a->from.empty() && a->batch == a->model.empty())
      throw InputError("answers --questions: expected --batch and --model MODEL, or neither");
    if (!a->batch && a->from.empty() && !a->request.empty())
      throw InputError("answers --request: expected --batch or --from with it");
    a->questions.empty() ? keep_replies(*a) : write_questions(*a);
    exit = ok;
  });
}

}  // namespace lgabench::cli

#include <lgabench/abstraction/chat_model.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include <lgabench/abstraction/final_answer.hpp>
#include <lgabench/abstraction/meaning_reply.hpp>
#include <lgabench/core/base64.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/refused.hpp>

namespace lgabench {
namespace {

constexpr int most_tries = 3;      // of a question whose reply has no final answer
constexpr int hopeless_from = 20;  // questions without any answer

// What can be read. @throws NoAnswer where the last of the tries cannot be, or says again what the one before said;
// tokens and seconds are those of all tries.
ChatReply complete(ChatClient& client, const Json& request) {
  ChatReply all;
  for (int attempt = 1;; ++attempt) {
    const ChatReply reply = client.complete(request);
    const bool again = attempt > 1 && reply.text == all.text;
    all.add(reply);
    try {
      final_answer(reply.text);
      return all;
    } catch (const MethodError& e) {
      if (again || attempt == most_tries) throw NoAnswer(fmt::format("{} (asked {} times)", e.what(), attempt));
    }
  }
}

// A command line's words before --answers that ask about the command.
std::string asks_about(const Command& command, const FeatureSpace& space) {
  return fmt::format("select \"{}\" --task {} --space {}", command.utterance, command.task, space.id);
}

constexpr const char* json_again = "the JSON object again, after a line \"Final answer:\"";

}  // namespace

Json messages_of(const Prompt& prompt) {
  return {{{"role", "system"}, {"content", prompt.system}}, {{"role", "user"}, {"content", prompt.user}}};
}

ChatLanguageModel::ChatLanguageModel(Cassette& cassette, ChatClient* client, ChatOptions options)
    : cassette_(cassette),
      client_(client),
      options_(std::move(options)),
      asked_model_(read_asked_model(options_.model)) {
  if (options_.prompt.empty() && !asked_model_.prompt.empty()) options_.prompt = cassette.prompt();
  cassette.expect_prompt(options_.prompt);
  template_ = PromptTemplate::of_text(options_.prompt);
  if (!asked_model_.prompt.empty() && asked_model_.prompt != template_.version())
    throw InputError(fmt::format("{}: expected replies to the prompt {}, it has none", cassette.file().string(),
                                 asked_model_.prompt));
}

// The picture stands in the place of its hash.
Json ChatLanguageModel::Request::sent() const {
  Json body = json;
  if (!picture.empty())
    body["messages"][1]["content"][1]["image_url"]["url"] = "data:image/png;base64," + base64(picture);
  return body;
}

// Several at once. A server that fails stops the rest, which has not begun; a question without an answer does not,
// unless none has had one.
void ChatLanguageModel::ask(const std::vector<Request>& requests, const std::string& utterance) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::condition_variable changed;
  std::size_t finished = 0, working = 0;
  std::map<std::size_t, std::string> unanswered;  // by request: why
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i; (i = next++) < requests.size();) {
      std::exception_ptr thrown;
      std::string no_answer;
      try {
        const Json sent = requests[i].sent();
        cassette_.add(requests[i].key, requests[i].json,
                      requests[i].yes_or_no ? complete(*client_, sent) : client_->complete(sent), options_.any_served);
      } catch (const NoAnswer& e) {
        no_answer = e.what();  // and is not kept, but asked again another time
      } catch (const MethodError& e) {
        thrown = std::make_exception_ptr(
            MethodError(fmt::format("{}, asked about {}: {}", asked_model_.name, requests[i].candidate, e.what())));
      } catch (...) {
        thrown = std::current_exception();
      }
      const std::lock_guard lock(mutex);
      if (!no_answer.empty() && ++without_answer_ >= hopeless_from && cassette_.models().empty())
        thrown = std::make_exception_ptr(MethodError(
            fmt::format("{}: none of its first {} replies has an answer, lgabench stopped asking; the last: {}",
                        asked_model_.name, without_answer_, no_answer)));
      if (thrown) next = requests.size();
      if (thrown && !failure) failure = thrown;
      if (!no_answer.empty()) unanswered[i] = no_answer;
      if (!thrown) ++finished;
      changed.notify_one();
    }
    const std::lock_guard lock(mutex);
    --working;
    changed.notify_one();
  };

  const std::size_t wanted = std::min(requests.size(), static_cast<std::size_t>(std::max(options_.concurrency, 1)));
  working = wanted;
  std::vector<std::thread> threads = start_helpers(wanted, work);
  if (threads.empty() && wanted > 0) throw Refused("no thread can be started that asks", EAGAIN);
  {
    std::unique_lock lock(mutex);
    working -= wanted - threads.size();
    std::size_t shown = 0;
    while (working > 0) {
      const bool quiet = changed.wait_for(lock, std::chrono::seconds(10)) == std::cv_status::timeout;
      if ((finished == shown && !quiet) || !options_.progress) continue;
      shown = finished;
      options_.progress(static_cast<int>(finished), static_cast<int>(requests.size()));
    }
  }
  for (std::thread& thread : threads) thread.join();
  asked_ += static_cast<int>(finished);
  if (failure) std::rethrow_exception(failure);
  if (unanswered.empty()) return;
  std::vector<std::string> candidates, lines;
  for (const auto& [i, why] : unanswered) {
    candidates.push_back(requests[i].candidate);
    lines.push_back(fmt::format("\"{}\", asked about {}: {}", utterance, requests[i].candidate, why));
  }
  throw Unanswered(fmt::format("{} of {} questions have no answer from {}: {}; the first: {}", unanswered.size(),
                               requests.size(), asked_model_.name, fmt::join(candidates, ", "), lines.front()),
                   lines);
}

std::vector<ChatLanguageModel::Request> ChatLanguageModel::requests_of(const Command& command,
                                                                       const FeatureSpace& space,
                                                                       const std::vector<Question>& questions) const {
  std::vector<Request> requests;
  for (const Question& question : questions) {
    const Prompt prompt = template_.fill(command, space, question);
    const Json request = asked_model_.request(messages_of(prompt));
    const bool of_target = question.about == Question::About::target || !command.second;
    requests.push_back({Cassette::key(request, template_.version()),
                        fmt::format("\"{}\"{}", question.candidate, of_target ? "" : " (" + command.second->id + ")"),
                        request});
  }
  return requests;
}

int ChatLanguageModel::open_questions(const Command& command, const FeatureSpace& space,
                                      const std::vector<Question>& questions) const {
  const std::vector<Request> requests = requests_of(command, space, questions);
  return static_cast<int>(std::count_if(requests.begin(), requests.end(),
                                        [this](const Request& request) { return !cassette_.find(request.key); }));
}

// Asks for what the cassette lacks.
void ChatLanguageModel::expect_replies(const std::vector<Request>& requests, const Command& command,
                                       const std::string& asks) {
  const auto without_reply = [&] {
    std::vector<Request> some;
    std::copy_if(requests.begin(), requests.end(), std::back_inserter(some),
                 [this](const Request& request) { return !cassette_.find(request.key); });
    return some;
  };
  if (const std::size_t missing = without_reply().size(); missing > 0) {
    if (!client_)
      throw InputError(fmt::format(
          "{0}: expected replies of {1} to \"{2}\", {3} of {4} are missing; to ask: lgabench {5} --answers openai {6} "
          "--cassette {0}",
          cassette_.file().string(), options_.model, command.utterance, missing, requests.size(), asks,
          command_words(asked_model_)));
    bool waited = false;
    const Cassette::Turn turn(cassette_, [&](const std::string& why) {
      waited = true;
      if (options_.in_line) options_.in_line(true);
      if (options_.waiting) options_.waiting(why);
    });
    if (waited && options_.in_line) options_.in_line(false);
    const std::vector<Request> open = without_reply();  // of those whose turn it was before
    if (options_.max_queries >= 0 && asked_ + static_cast<int>(open.size()) > options_.max_queries)
      throw InputError(fmt::format("\"{}\" takes {} queries, expected no more than {}", command.utterance, open.size(),
                                   options_.max_queries - asked_));
    ask(open, command.utterance);
  }
}

ChatReply ChatLanguageModel::counted(const Request& request) {
  ChatReply reply = *cassette_.find(request.key);
  ++cost_.lm_queries;
  cost_.lm_tokens += reply.tokens;
  cost_.lm_seconds += reply.seconds;
  if (!reply.served.empty() && reply.served != asked_model_.name) served_.insert(reply.served);
  return reply;
}

std::string ChatLanguageModel::model() const {
  return served_.empty() ? options_.model : fmt::format("{} (served: {})", options_.model, fmt::join(served_, ", "));
}

std::vector<bool> ChatLanguageModel::answer(const Command& command, const FeatureSpace& space,
                                            const std::vector<Question>& questions) {
  const std::vector<Request> requests = requests_of(command, space, questions);
  expect_replies(requests, command, asks_about(command, space));
  std::vector<bool> answers;
  for (const Request& request : requests) answers.push_back(final_answer(counted(request).text));
  return answers;
}

ChatLanguageModel::Request ChatLanguageModel::request_in_one(const PromptTemplate& prompt, const Json& messages,
                                                             const std::string& about) const {
  const Json body = asked_model_.request(messages);
  return {Cassette::key(body, prompt.version()), about, body, false};
}

template <class Read>
auto ChatLanguageModel::asked_until_read(Request request, const PromptTemplate& prompt, const Command& command,
                                         const std::string& asks, const std::string& wanted, Read&& read)
    -> decltype(read(std::string())) {
  Reading& of_form = reading_[prompt.version()];
  for (int attempt = 1;; ++attempt) {
    expect_replies({request}, command, asks);
    const std::string said = counted(request).text;
    try {
      auto answer = read(said);
      of_form.any = true;
      return answer;
    } catch (const MethodError& e) {
      if (++of_form.unread >= hopeless_from && !of_form.any && client_ && options_.expects_read)
        throw Hopeless(
            fmt::format("{}, asked about {}: none of its first {} replies has an answer, lgabench stopped asking; the "
                        "last: {}",
                        asked_model_.name, request.candidate, of_form.unread, e.what()));
      if (attempt == most_tries)
        throw Unread(fmt::format("\"{}\", asked about {}: {} (asked {} times)", command.utterance, request.candidate,
                                 e.what(), most_tries));
      Json& messages = request.json["messages"];
      messages.push_back({{"role", "assistant"}, {"content", said}});
      messages.push_back(
          {{"role", "user"}, {"content", fmt::format("That cannot be read: {}. Give {}.", e.what(), wanted)}});
      request.key = Cassette::key(request.json, prompt.version());
    }
  }
}

template <class Ask>
auto ChatLanguageModel::read_or_empty(Ask&& ask) const -> decltype(ask()) {
  try {
    return ask();
  } catch (const Unread& e) {
    if (options_.expects_read) throw;
    if (options_.waiting) options_.waiting(fmt::format("{}: nothing is selected", e.what()));
    return {};
  }
}

Meaning ChatLanguageModel::mean(const Command& command, const FeatureSpace& space) {
  const PromptTemplate& asked = command.may_stop ? of_turns_ : of_meaning_;
  return read_or_empty([&] {
    return asked_until_read(request_in_one(asked, messages_of(asked.fill(command, space)), "what it means"), asked,
                            command, asks_about(command, space), json_again,
                            [&space](const std::string& said) { return meaning_in(said, space); });
  });
}

std::vector<Hypothesis> ChatLanguageModel::hypotheses(const Command& command, const FeatureSpace& space) {
  const Request first =
      request_in_one(of_hypotheses_, messages_of(of_hypotheses_.fill(command, space)), "what it leaves unsaid");
  if (!client_ && !cassette_.find(first.key)) return {};
  return read_or_empty([&] {
    return asked_until_read(first, of_hypotheses_, command, asks_about(command, space), json_again,
                            [&space](const std::string& said) { return hypotheses_in(said, space); });
  });
}

std::vector<int> ChatLanguageModel::look(const Command& command, const std::string& png, int marks) {
  const PromptTemplate prompt("marks.txt");
  const Prompt words = prompt.fill(command, {});
  Json messages = messages_of(words);
  messages[1]["content"] = {{{"type", "text"}, {"text", words.user}},
                            {{"type", "image_url"}, {"image_url", {{"url", "sha256:" + sha256(png)}}}}};
  Request request = request_in_one(prompt, messages, "a picture");
  request.picture = png;
  return asked_until_read(std::move(request), prompt, command, "select --suite SUITE --score --names looked",
                          "the line \"Final answer:\" with the numbers again",
                          [marks](const std::string& said) { return final_marks(said, marks); });
}

}  // namespace lgabench

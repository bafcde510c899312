// lgabench-worker ask: the questions that a run's methods declare, described on stdin. `lgabench run` starts it.
#include <fmt/format.h>

#include <mutex>
#include <string>
#include <vector>

#include <lgabench/abstraction/openai_client.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/worker/job.hpp>
#include <lgabench/worker/verbs.hpp>

namespace lgabench::worker {
namespace {

void ask_all(const JsonReader& reader, const Messages& messages) {
  const AskJob job = read_ask_job(reader);
  std::mutex one_at_a_time;
  const auto waiting = [&](const std::string& why) {
    const std::lock_guard lock(one_at_a_time);
    messages.at({why});
  };
  OpenAiOptions server = openai_from_environment();
  server.timeout_s = job.live.reply_timeout_s;
  server.waiting = waiting;
  OpenAiClient client(server);
  Cassette cassette(job.live.cassette);
  int before = 0;
  std::vector<std::string> unanswered;
  ChatOptions options{job.model, job.live.concurrency, job.live.max_queries};
  options.any_served = job.live.any_served;
  options.prompt = job.live.prompt;
  options.waiting = waiting;
  options.progress = [&](int asked, int of_command) {
    const std::lock_guard lock(one_at_a_time);
    messages.at({asked_phase, before + asked});
    if (asked == of_command) before += asked;
  };
  for (const Json& json : job.scenarios) {
    const Scenario scenario = read_scenario(json, "scenario");
    ChatLanguageModel lm(cassette, &client, options);  // a cell's limit of questions is each scenario's
    try {
      for (int c = 0; c < static_cast<int>(scenario.commands.size()); ++c) try {
          select_features(scenario.command(c), scenario.space, lm);
        } catch (const Unanswered& e) {
          unanswered.insert(unanswered.end(), e.questions.begin(), e.questions.end());
        }
    } catch (const InputError& e) {  // more than --max-queries: the cells say so
      waiting(e.what());
    }
  }
  if (!unanswered.empty())
    throw MethodError(fmt::format("{} questions have no answer; the first: {}", unanswered.size(), unanswered.front()));
}

}  // namespace

void ask() { do_job(ask_all); }

}  // namespace lgabench::worker

#include <lgabench/harness/questions.hpp>

#include <fmt/format.h>

#include <set>

#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/scratch.hpp>
#include <lgabench/harness/counted_progress.hpp>
#include <lgabench/harness/forecast.hpp>

namespace lgabench {

void Questions::add(const ChatLanguageModel& model, const Command& command, const FeatureSpace& space) {
  const std::vector<Question> questions = feature_questions(command, space);
  all += static_cast<int>(questions.size());
  open += model.open_questions(command, space, questions);
}

std::string Questions::text() const {
  const std::string time = open > 0 && reply_s > 0 ? ": about " + duration_text(open * reply_s / at_once) : "";
  return fmt::format("{} questions, {} answered already, {} at once{}", all, all - open, at_once, time);
}

Questions count_questions(const LiveModel& live, const std::string& model, const std::vector<Json>& scenarios) {
  Cassette cassette(live.cassette);
  ChatOptions options{model};
  options.prompt = live.prompt;
  const ChatLanguageModel lm(cassette, nullptr, options);
  Questions counted{0, 0, live.concurrency, cassette.mean_seconds()};
  std::set<std::string> seen;
  for (const Json& json : scenarios) {
    const Scenario scenario = read_scenario(json, "scenario");
    for (int c = 0; c < static_cast<int>(scenario.commands.size()); ++c) {
      const Command command = scenario.command(c);
      if (!seen.insert(canonical({command.utterance, command.task, scenario.space.id})).second) continue;
      counted.add(lm, command, scenario.space);
    }
  }
  return counted;
}

bool ask_beforehand(const AskJob& job, const Questions& questions, bool quiet) {
  const Scratch scratch("ask");
  CountedProgress progress("asked", questions.open, CountedProgress::Brief::told);
  PoolEvents events;
  events.started = [](std::size_t) {};
  events.tick = [] {};
  events.progress = [&progress, quiet](std::size_t, const std::string& phase, long long count) {
    if (phase != asked_phase)
      progress.say(phase);
    else if (!quiet)
      progress.tell(static_cast<int>(count));
  };
  events.ended = [&progress](std::size_t, const WorkerEnd& end) {
    if (end.exit_code == 0 && end.signal == 0) return;
    progress.say(fmt::format("asking beforehand: {}; the cells that need it ask again",
                             end.complaint ? end.complaint->reason : why_it_ended(end, 0).reason));
  };
  PoolOptions pool;
  pool.timeout_s = 1e9;  // how long a server takes is --reply-timeout's business
  const bool whole = run_workers(
      1,
      [&](std::size_t) {
        return WorkerTask{to_json(job), scratch.path / "log", "ask"};
      },
      pool, events);
  progress.end();
  return whole;
}

}  // namespace lgabench

// What a method's process says, as the worker reads it: HostedMethod's replies and AnswerLedger's questions.
#include <lgabench/abstraction/human.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/host/answer_ledger.hpp>
#include <lgabench/host/messages.hpp>

#include "frames.hpp"

namespace {

using namespace lgabench;

struct NoLog : TrainingLog {
  void epoch(int, long long, double) override {}
};

// Everyone whom a worker lets a method ask.
struct Answering {
  Scenario scenario = load_scenario("sweep_block_without_touching_line");
  RecordedLanguageModel model{scenario, "claude"};
  DeclaredHuman human{std::make_unique<TruthAsHuman>(scenario.commands), "edit"};
  NoLog log;
  Json options = Json::object();
  ActionSpace actions = scenario.environment->action_space();
  Services services{model, human, options, 0, log, actions, declared_truth(scenario.commands, "truth"), {}};
};

void read(const Frame& frame, AnswerLedger& asked, Channel& channel) {
  const JsonReader reader(frame.header, "frame");
  const std::string type = frame.type();
  if (type == "needs") {
    host::read_needs(reader);
  } else if (type == "selection") {
    canonical(to_json(asked.account(host::read_selection(reader.at("selection")))));
  } else if (type == "action") {
    host::to_bytes(host::read_action(frame.payload, 12));
  } else if (type == "log") {
    host::read_log(frame);
  } else {
    asked.answer(frame, channel);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Answering answering;
  if (size > fuzz::most_said) return 0;
  auto [ours, theirs] = fuzz::ends();
  {
    Channel host = fuzz::channel_of(std::move(theirs));
    for (const Frame& frame : fuzz::frames_of(fuzz::text_of(data, size))) host.send(frame.header, frame.payload);
  }
  Channel worker = fuzz::channel_of(std::move(ours));
  AnswerLedger asked(answering.scenario.space, answering.services);
  try {
    while (const std::optional<Frame> frame = worker.receive()) read(*frame, asked, worker);
  } catch (const InputError&) {
  }
  return 0;
}

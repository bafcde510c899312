#include <lgabench/host/hosted_method.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include <lgabench/core/files.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/host/answer_ledger.hpp>
#include <lgabench/host/host_session.hpp>

namespace lgabench {
namespace {

fs::path made(const fs::path& directory) {
  fs::create_directory(directory);
  return directory;
}

class HostedPolicy : public Policy {
 public:
  explicit HostedPolicy(std::shared_ptr<HostSession> session) : session_(std::move(session)) {}

  void reset() override { reset_ = true; }
  Action act(const Observation& observation, const Instruction& instruction) override {
    acted_ = false;
    host::write(observation, session_->observation());
    Json request{{"type", "act"},
                 {"reset", std::exchange(reset_, false)},
                 {"instruction", host::to_json(instruction)},
                 {"instances", host::instances_json(observation)}};
    if (!observation.shadows.empty()) request["shadows"] = true;
    request.update(host::beside_pictures(observation));
    const Frame frame = session_->call(request, "action");
    return session_->read([&] {
      const JsonReader reader(frame.header, "action");
      acted_ = true;
      seen_.reset();
      if (reader.has("seen_in_training")) seen_ = reader.at("seen_in_training").boolean();
      if (session_->layout().may_stop && reader.has("done") && reader.at("done").boolean()) return Action();
      return host::read_action(frame.payload, session_->layout().actions.size());
    });
  }
  std::optional<bool> seen_in_training() const override { return seen_; }
  Shown shown() const override {
    if (!acted_) return {};
    const Frame frame = session_->call({{"type", "shown"}}, "shown");
    return session_->read([&] { return host::read_shown(frame); });
  }
  /// In parts, as a frame holds no more. What is too large is said in the log.
  std::optional<std::string> saved() const override {
    std::string bytes;
    for (;;) {
      const Frame frame = session_->call({{"type", "save"}, {"from", bytes.size()}}, "saved");
      const JsonReader reader(frame.header, "saved");
      if (!reader.has("bytes")) return std::nullopt;
      const auto size = session_->read([&] {
        return static_cast<std::size_t>(reader.at("bytes").integer(0, std::numeric_limits<long long>::max()));
      });
      if (size > most_saved_bytes) {
        to_stdout("the policy is not kept: it has {} bytes, at most 64 MiB are allowed\n", size);
        return std::nullopt;
      }
      bytes += frame.payload;
      if (bytes.size() == size) return bytes;
      if (bytes.size() > size || frame.payload.empty())
        throw MethodError(fmt::format("announced a saved policy of {} bytes and sent {}", size, bytes.size()));
    }
  }

 private:
  std::shared_ptr<HostSession> session_;
  bool acted_ = false;  // the last act() gave an action
  bool reset_ = false;
  std::optional<bool> seen_;
};

}  // namespace

// Opened before the method runs, which may put something else in its place.
HostedMethod::HostedMethod(const HostJob& job)
    : files_(made(job.scratch / "files")), session_(std::make_shared<HostSession>(job)) {}
HostedMethod::~HostedMethod() = default;

Needs HostedMethod::needs(const Json&) const {
  const Frame frame = session_->call({{"type", "needs"}}, "needs");
  return session_->read([&] { return host::read_needs(JsonReader(frame.header, "needs")); });
}

Selection HostedMethod::select(const Command& command, const FeatureSpace& space, Services& services) {
  space_ = space;
  AnswerLedger ledger(space, services);
  const auto answer = [&ledger](const Frame& frame, Channel& channel) { return ledger.answer(frame, channel); };
  try {
    const Frame frame =
        session_->call({{"type", "select"}, {"command", host::to_json(command)}, {"space", host::to_json(space)}},
                       "selection", answer);
    return ledger.account(session_->read([&] {
      const JsonReader reader(frame.header, "selection");
      return host::read_selection(reader.at("selection"));
    }));
  } catch (const MethodError&) {
    ledger.rethrow();
    throw;
  }
}

Selection HostedMethod::revise(const Command& command, const Selection& selected,
                               const std::vector<Demonstration>& demonstrations, Services& services) {
  AnswerLedger ledger(space_, services, selected);
  const auto answer = [&ledger](const Frame& frame, Channel& channel) { return ledger.answer(frame, channel); };
  const host::DemonstrationFile packed = host::pack(session_->layout(), demonstrations);
  Json request = packed.header;
  request["type"] = "revise";
  request["command"] = host::to_json(command);
  request["selection"] = host::selection_for_method(selected);
  request["shows_truth"] = services.shows_truth;
  try {
    const Frame frame = session_->call(request, "revised", answer, &packed.file);
    return ledger.account(session_->read([&] {
      const JsonReader reader(frame.header, "revised");
      return host::read_selection(reader.at("selection"));
    }));
  } catch (const MethodError&) {
    ledger.rethrow();
    throw;
  }
}

std::unique_ptr<Policy> HostedMethod::learn(const std::vector<Demonstration>& demonstrations, Services& services) {
  const FeatureSpace none;
  AnswerLedger ledger(none, services);
  const auto answer = [&](const Frame& frame, Channel& channel) {
    if (frame.type() != "log") return ledger.answer(frame, channel);
    for (const auto& [epochs, steps, loss, curves] : host::read_or_malformed([&] { return host::read_log(frame); })) {
      for (const auto& [name, value] : curves) services.log.curve(name, value);
      services.log.epoch(epochs, steps, loss);
    }
    return true;
  };
  const host::DemonstrationFile packed = host::pack(session_->layout(), demonstrations);
  Json request = packed.header;
  request["type"] = "learn";
  try {
    session_->call(request, "learned", answer, &packed.file);
  } catch (const MethodError&) {
    ledger.rethrow();
    throw;
  }
  return std::make_unique<HostedPolicy>(session_);
}

std::unique_ptr<Policy> HostedMethod::restore(const std::string& saved) {
  host::SharedMemory memory(saved.size());
  std::copy(saved.begin(), saved.end(), memory.data());
  session_->call({{"type", "restore"}, {"bytes", saved.size()}}, "restored", {}, &memory.file());
  return std::make_unique<HostedPolicy>(session_);
}

std::vector<std::pair<std::string, std::string>> HostedMethod::files() const {
  constexpr std::uintmax_t most = 64 << 20;
  std::vector<std::pair<std::string, std::string>> all;
  std::uintmax_t bytes = 0;
  for (const std::string& name : files_.kept_names()) try {
      all.emplace_back(name, files_.read_file(name, most - bytes));
      bytes += all.back().second.size();
    } catch (const InputError& e) {  // too large, or changed by now
      to_stdout("files/{} is not kept: {}\n", name, e.what());
    }
  return all;
}

void HostedMethod::end() { session_->call({{"type", "bye"}}, "bye"); }

std::vector<std::string> HostedMethod::refused_calls() const { return session_->refused_calls(); }

void HostedMethod::drop_method() { session_->call({{"type", "drop"}, {"what", "method"}}, "dropped"); }

void HostedMethod::drop_policy() { session_->call({{"type", "drop"}, {"what", "policy"}}, "dropped"); }

ProcessState HostedMethod::state() const { return session_->state(); }

std::vector<std::string> HostedMethod::processes() const { return session_->processes(); }

}  // namespace lgabench

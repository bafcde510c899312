#include <lgabench/host/hosted_method.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <new>

#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/host/answer_ledger.hpp>
#include <lgabench/host/host_process.hpp>
#include <lgabench/host/messages.hpp>
#include <lgabench/host/reach.hpp>
#include <lgabench/plugin/guarded.hpp>

namespace lgabench {
namespace {

HostCommand command_of(const HostJob& job, const Confinement* confinement) {
  HostCommand command{
      {(program_directory() / "lgabench-method").string()}, job.scratch, {}, confinement, job.memory_bytes};
  if (const Json& python = job.method.python; !python.is_null()) {
    command.words = {python.at("interpreter").get<std::string>(), "-m", "lgabench_method", "--serve"};
    command.also_set = {"PYTHONPATH=" + python_package().string(), "PYTHONUNBUFFERED=1"};
    if (const auto base = python.at("user_base").get<std::string>(); !base.empty())  // HOME is another one there
      command.also_set.push_back("PYTHONUSERBASE=" + base);
  } else if (job.perturb != 0) {
    command.words.insert(command.words.end(), {"--perturb", std::to_string(job.perturb)});
  }
  if (job.debugger) {
    command.words.insert(command.words.begin(), job.debugger->begin(), job.debugger->end());
    command.in_foreground = true;
    if (const char* terminal = std::getenv("TERM")) command.also_set.push_back(std::string("TERM=") + terminal);
  }
  return command;
}

protocol::Layout layout_of(const HostJob& job) {
  const EnvironmentType& type = find_environment(job.environment);
  return {type.picture_size(),
          job.task.empty() ? type.action_space() : type.action_space_of(find_task(type, job.task))};
}

Json method_json(const PluginInfo& method) {
  Json json{{"file", fs::absolute(method.file).string()}, {"sha256", method.sha256}};
  if (!method.python.is_null())
    for (const char* member : {"class", "versions"}) json[member] = method.python.at(member);
  return json;
}

// What a method's process may read: what it starts with, its own folder, and the data that learners use.
Reach reach_of(const HostJob& job) {
  const fs::path data = data_directory();
  Reach reach = system_reach();
  reach.network = job.method.asks == "network";
  reach.reads.push_back(job.method.file.parent_path());
  reach.writes.push_back(job.scratch);
  reach.hidden = job.hidden;
  if (!job.method.python.is_null()) add_python(reach, job.method.python);
  reach.reads.push_back(encoder_directory());
  std::error_code none_there;
  for (const auto& entry : fs::directory_iterator(data, none_there)) {
    const std::string name = entry.path().filename();
    const bool readable = name == "spaces" || name == "embeddings" || name == "encoder" || name == "python";
    std::vector<fs::path>& list = readable ? reach.reads : reach.unread;
    list.push_back(entry.path());
    for (const auto& file : fs::directory_iterator(entry.path(), none_there))
      if (file.is_symlink()) list.push_back(file.path());  // in a build tree, to the sources
  }
  return reach;
}

}  // namespace

// The connection, which the method and its policy share.
class HostSession {
 public:
  explicit HostSession(const HostJob& job)
      : layout_(layout_of(job)),
        confinement_(job.confined ? std::make_unique<Confinement>(reach_of(job)) : nullptr),
        process_(command_of(job, confinement_.get())),
        channel_(process_.take_socket(), [this](short events) { process_.wait(channel_.socket(), events); }),
        observation_(protocol::observation_bytes(layout_.picture)) {
    Json hello{{"type", "hello"},
               {"protocol", protocol_version},
               {"method", method_json(job.method)},
               {"options", job.options},
               {"seed", job.seed},
               {"limits", {{"header_bytes", most_header_bytes}, {"payload_bytes", most_payload_bytes}}}};
    hello.update(protocol::to_json(layout_));
    const Frame answer = call(hello, "hello", {}, &observation_.file());
    read([&] { return JsonReader(answer.header, "hello").at("protocol").integer(protocol_version, protocol_version); });
  }

  using Meanwhile = std::function<bool(const Frame& frame, Channel& channel)>;

  /// Sends the request and returns the reply of that type. `meanwhile` takes the frames that come before it; one that
  /// it does not know breaks the protocol.
  Frame call(const Json& request, const char* reply, const Meanwhile& meanwhile = {},
             const Descriptor* file = nullptr) {
    return guarded_by_protocol([&] {
      channel_.send(request, {}, file);
      for (;;) {
        std::optional<Frame> frame = channel_.receive();
        if (!frame) process_.explain();
        if (frame->type() == reply) return std::move(*frame);
        if (frame->type() == "error") raise(JsonReader(frame->header, "error"));
        broken_ = "was left in the middle of a call";  // by what the next line may throw
        if (!meanwhile || !meanwhile(*frame, channel_))
          throw Malformed(fmt::format("\"{}\", expected \"{}\"", frame->type().substr(0, 40), reply));
        broken_.clear();
      }
    });
  }

  /// What a reply holds, or MethodGone.
  template <class Call>
  auto read(Call&& call) -> decltype(call()) {
    return guarded_by_protocol([&] { return protocol::read_or_malformed(call); });
  }

  const protocol::Layout& layout() const { return layout_; }
  const std::vector<std::string>& refused_calls() const { return process_.refused_calls(); }
  protocol::SharedMemory& observation() { return observation_; }

 private:
  template <class Call>
  auto guarded_by_protocol(Call&& call) -> decltype(call()) {
    if (!broken_.empty()) throw MethodGone(broken_, 0);
    try {
      return call();
    } catch (const MethodGone& e) {
      broken_ = e.what();
      throw;
    } catch (const Malformed& e) {
      broken_ = fmt::format("sent a malformed frame: {}", e.what());
      throw MethodGone(broken_, 0);
    }
  }

  [[noreturn]] static void raise(const JsonReader& error) {
    constexpr std::size_t longest = 2000;
    const auto [kind, reason] = protocol::read_or_malformed(
        [&] { return std::pair(error.at("kind").string(), error.at("reason").string().substr(0, longest)); });
    if (kind == "memory") throw std::bad_alloc();
    if (kind == "plugin") throw PluginError(reason);
    throw MethodError(reason);
  }

  const protocol::Layout layout_;
  std::unique_ptr<Confinement> confinement_;
  HostProcess process_;
  Channel channel_;
  protocol::SharedMemory observation_;
  std::string broken_;  // why nothing can be asked any more
};

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
    protocol::write(observation, session_->observation());
    Json request{{"type", "act"},
                 {"reset", std::exchange(reset_, false)},
                 {"instruction", protocol::to_json(instruction)},
                 {"instances", protocol::instances_json(observation)}};
    if (!observation.shadows.empty()) request["shadows"] = true;
    const Frame frame = session_->call(request, "action");
    return session_->read([&] {
      const JsonReader reader(frame.header, "action");
      acted_ = true;
      seen_.reset();
      if (reader.has("seen_in_training")) seen_ = reader.at("seen_in_training").boolean();
      return protocol::read_action(frame.payload, session_->layout().actions.size());
    });
  }
  std::optional<bool> seen_in_training() const override { return seen_; }
  Shown shown() const override {
    if (!acted_) return {};
    const Frame frame = session_->call({{"type", "shown"}}, "shown");
    return session_->read([&] { return protocol::read_shown(frame); });
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
        to_stdout("the policy is not kept: {} bytes, expected 64 MiB at most\n", size);
        return std::nullopt;
      }
      bytes += frame.payload;
      if (bytes.size() == size) return bytes;
      if (bytes.size() > size || frame.payload.empty())
        throw MethodError(fmt::format("saved a policy of {} bytes, and sent {}", size, bytes.size()));
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
  return session_->read([&] { return protocol::read_needs(JsonReader(frame.header, "needs")); });
}

Selection HostedMethod::select(const Command& command, const FeatureSpace& space, Services& services) {
  space_ = space;
  AnswerLedger ledger(space, services);
  const auto answer = [&ledger](const Frame& frame, Channel& channel) { return ledger.answer(frame, channel); };
  try {
    const Frame frame = session_->call(
        {{"type", "select"}, {"command", protocol::to_json(command)}, {"space", protocol::to_json(space)}}, "selection",
        answer);
    return ledger.account(session_->read([&] {
      const JsonReader reader(frame.header, "selection");
      return protocol::read_selection(reader.at("selection"));
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
  const protocol::DemonstrationFile packed = protocol::pack(session_->layout(), demonstrations);
  Json request = packed.header;
  request["type"] = "revise";
  request["command"] = protocol::to_json(command);
  request["selection"] = protocol::told(selected);
  request["shows_truth"] = services.shows_truth;
  try {
    const Frame frame = session_->call(request, "revised", answer, &packed.file);
    return ledger.account(session_->read([&] {
      const JsonReader reader(frame.header, "revised");
      return protocol::read_selection(reader.at("selection"));
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
    for (const auto& [epochs, steps, loss, curves] :
         protocol::read_or_malformed([&] { return protocol::read_log(frame); })) {
      for (const auto& [name, value] : curves) services.log.curve(name, value);
      services.log.epoch(epochs, steps, loss);
    }
    return true;
  };
  const protocol::DemonstrationFile packed = protocol::pack(session_->layout(), demonstrations);
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
  protocol::SharedMemory memory(saved.size());
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

ProcessState HostedMethod::state() const {
  const Frame frame = session_->call({{"type", "state"}}, "state");
  return session_->read([&] { return protocol::read_state(JsonReader(frame.header, "state")); });
}

}  // namespace lgabench

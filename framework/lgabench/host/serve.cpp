#include <lgabench/host/serve.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <lgabench/host/last_words.hpp>
#include <lgabench/host/messages.hpp>
#include <lgabench/host/serving.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench {
namespace {

// Asks a question in the middle of a call and waits for its answer. @throws MethodError where it is refused.
Frame ask(Channel& channel, const Json& question, const char* expected) {
  channel.send(question);
  std::optional<Frame> frame = channel.receive();
  if (!frame) ::_exit(connection_lost);
  if (frame->type() == "refused") throw MethodError(JsonReader(frame->header, "refused").at("reason").string());
  if (frame->type() != expected) throw MethodError(fmt::format("\"{}\", expected \"{}\"", frame->type(), expected));
  return std::move(*frame);
}

class RemoteModel : public LanguageModel {
 public:
  explicit RemoteModel(Channel& channel) : channel_(channel) {}
  std::vector<bool> answer(const Command& command, const FeatureSpace& space,
                           const std::vector<Question>& questions) override {
    Json all = Json::array();
    for (const Question& question : questions) all.push_back(host::to_json(question, command));
    const Frame frame =
        ask(channel_,
            {{"type", "ask"}, {"command", host::to_json(command)}, {"space", host::to_json(space)}, {"questions", all}},
            "answers");
    const JsonReader reader(frame.header, "answers");
    note(reader, command);
    std::vector<bool> answers;
    for (const JsonReader& one : reader.at("answers").elements()) answers.push_back(one.boolean());
    return answers;
  }
  Meaning mean(const Command& command, const FeatureSpace& space) override {
    const Frame frame =
        ask(channel_,
            {{"type", "ask"}, {"how", "meaning"}, {"command", host::to_json(command)}, {"space", host::to_json(space)}},
            "meaning");
    const JsonReader reader(frame.header, "meaning");
    note(reader, command);
    return read_unchecked_meaning(reader.at("meaning"));
  }
  std::vector<Hypothesis> hypotheses(const Command& command, const FeatureSpace& space) override {
    const Frame frame = ask(
        channel_,
        {{"type", "ask"}, {"how", "hypotheses"}, {"command", host::to_json(command)}, {"space", host::to_json(space)}},
        "hypotheses");
    const JsonReader reader(frame.header, "hypotheses");
    note(reader, command);
    return host::read_hypotheses(reader.at("hypotheses"));
  }
  std::string model() const override { return model_; }
  std::string asked_as(const Command& command) const override {
    const auto found = asked_as_.find(command.utterance);
    return found == asked_as_.end() ? command.utterance : found->second;
  }
  Provenance provenance() const override { return provenance_; }
  SelectionCost cost() const override { return cost_; }

 private:
  // Whose answers these are.
  void note(const JsonReader& reader, const Command& command) {
    model_ = reader.at("model").string();
    provenance_ = provenance_from(reader.at("provenance").string());
    cost_ = host::read_cost(reader.at("cost"));
    asked_as_[command.utterance] = reader.at("asked_as").string();
  }

  Channel& channel_;
  std::string model_;
  Provenance provenance_ = Provenance::none;
  SelectionCost cost_;
  std::map<std::string, std::string> asked_as_;  // by utterance
};

class RemoteHuman : public HumanAnswers {
 public:
  explicit RemoteHuman(Channel& channel) : channel_(channel) {}
  Selection specify(const Command& command) override {
    return person({{"type", "person"}, {"how", "specify"}, {"command", host::to_json(command)}});
  }
  Selection edit(const Command& command, const Selection& proposal) override {
    return person({{"type", "person"},
                   {"how", "edit"},
                   {"command", host::to_json(command)},
                   {"proposal", distribution_json(proposal)}});
  }
  bool accepts(const Command& command, const std::string& object_type, const std::string& texture) override {
    const Frame frame = ask(channel_,
                            {{"type", "person"},
                             {"how", "accept"},
                             {"command", host::to_json(command)},
                             {"object_type", object_type},
                             {"texture", texture}},
                            "accepts");
    return JsonReader(frame.header, "accepts").at("accepts").boolean();
  }
  std::vector<Placed> scene(const Command& command, int scene) override {
    return host::read_placed(JsonReader(in_scene("scene", command, scene).header, "scene").at("objects"));
  }
  bool takes(const Command& command, int scene, std::uint8_t instance) override {
    return JsonReader(in_scene("takes", command, scene, instance).header, "takes").at("takes").boolean();
  }
  std::optional<std::uint8_t> which(const Command& command, int scene) override {
    const Frame frame = in_scene("which", command, scene);
    const JsonReader one = JsonReader(frame.header, "which").at("instance");
    return one.json().is_null() ? std::nullopt : std::optional(static_cast<std::uint8_t>(one.integer(0, 255)));
  }
  Selection truth(const Command& command) {
    return person({{"type", "person"}, {"how", "truth"}, {"command", host::to_json(command)}});
  }

 private:
  Frame in_scene(const char* how, const Command& command, int scene, int instance = 0) {
    return ask(channel_,
               {{"type", "person"},
                {"how", how},
                {"command", host::to_json(command)},
                {"scene", scene},
                {"instance", instance}},
               how);
  }
  Selection person(const Json& question) {
    const Frame frame = ask(channel_, question, "person");
    return host::read_selection(JsonReader(frame.header, "person").at("selection"));
  }
  Channel& channel_;
};

// Sent twice a second, and before the reply: a frame for each epoch would wake the worker and its parent for nothing.
class RemoteLog : public TrainingLog {
 public:
  explicit RemoteLog(Channel& channel) : channel_(channel) {}
  /// Whether learn() runs: only then the worker takes what is logged.
  void open(bool learning) { open_ = learning; }
  void epoch(int epochs, long long steps, double loss) override {
    constexpr std::size_t most = 1000;
    if (!open_) throw MethodError("services.log.epoch() was called outside of learn(): only training is logged");
    waiting_.push_back({epochs, steps, loss, std::exchange(curves_, {})});
    if (waiting_.size() == most || Clock::now() - sent_ > std::chrono::milliseconds(500)) flush();
  }
  void curve(const std::string& name, double value) override {
    constexpr std::size_t most = 100;  // far more than the worker takes
    if (curves_.size() < most) curves_.emplace_back(name, value);
  }
  void flush() {
    if (waiting_.empty()) return;
    const Frame frame = host::log_frame(waiting_);
    waiting_.clear();
    sent_ = Clock::now();
    channel_.send(frame.header, frame.payload);
  }

 private:
  using Clock = std::chrono::steady_clock;
  Channel& channel_;
  bool open_ = false;
  std::vector<host::LogEntry> waiting_;
  std::vector<std::pair<std::string, double>> curves_;  // of the pass that epoch() ends
  Clock::time_point sent_ = Clock::now();
};

// One plugin from loading to its end.
class Host {
 public:
  Host(Channel& channel, const Frame& hello)
      : channel_(channel),
        model_(channel),
        human_(channel),
        log_(channel),
        layout_(host::read_layout({hello.header, "hello"})),
        memory_(hello.file, host::observation_bytes(layout_.picture)) {
    const JsonReader reader(hello.header, "hello");
    options_ = reader.at("options").json();
    const JsonReader seed = reader.at("seed");
    if (!seed.json().is_number_unsigned()) seed.fail("a whole number, 0 or more");
    seed_ = seed.json().get<std::uint64_t>();
    plugin_ = named_plugin(hello, "method");
    method_ = load_method(plugin_);
    channel_.send(
        {{"type", "hello"}, {"protocol", protocol_version}, {"id", plugin_.id}, {"version", plugin_.version}});
  }

  // What was logged comes before the reply, and before what the method throws.
  void answer(const Frame& frame) {
    const auto logged = [this, &frame] {
      struct Flushes {
        ~Flushes() { log.flush(); }
        RemoteLog& log;
      };
      const Flushes at_the_end{log_};
      return reply_to(frame);
    };
    const Frame reply = logged();
    channel_.send(reply.header, reply.payload);
  }

  void end() {
    policy_.reset();
    method_.reset();
    std::cout.flush();
    std::fflush(nullptr);  // the worker ends this process once it has the answer
    channel_.send({{"type", "bye"}});
  }

 private:
  Frame reply_to(const Frame& frame) {
    const JsonReader reader(frame.header, frame.type());
    log_.open(frame.type() == "learn");
    Services services{model_,
                      human_,
                      options_,
                      seed_,
                      log_,
                      layout_.actions,
                      [this](const Command& command) { return human_.truth(command); },
                      files_};
    services.state = layout_.state;
    services.may_stop = layout_.may_stop;
    if (frame.type() == "needs") {
      Json needs = host::to_json(call([&] { return method().needs(options_); }));
      needs["type"] = "needs";
      return {needs};
    }
    if (frame.type() == "select") {
      const Command command = host::read_command(reader.at("command"));
      const FeatureSpace space = host::read_space(reader.at("space"));
      const Selection selection = call([&] { return method().select(command, space, services); });
      return {{{"type", "selection"}, {"selection", distribution_json(selection)}}};
    }
    if (frame.type() == "revise") {
      const Command command = host::read_command(reader.at("command"));
      const Selection selected = host::read_selection(reader.at("selection"));
      const std::vector<Demonstration> demonstrations = host::unpack(layout_, reader, frame.file);
      services.shows_truth = reader.at("shows_truth").boolean();
      const Selection revised = call([&] { return method().revise(command, selected, demonstrations, services); });
      return {{{"type", "revised"}, {"selection", distribution_json(revised)}}};
    }
    if (frame.type() == "learn") {
      const std::vector<Demonstration> demonstrations = host::unpack(layout_, reader, frame.file);
      policy_ = call([&] { return method().learn(demonstrations, services); });
      if (!policy_) throw MethodError("learn returned no policy");
      return {{{"type", "learned"}}};
    }
    if (frame.type() == "save") {
      const auto from = static_cast<std::size_t>(reader.at("from").integer(0, 1LL << 40));
      if (from == 0) saved_ = policy_ ? call([&] { return policy_->saved(); }) : std::nullopt;
      if (!saved_) return {{{"type", "saved"}}};
      const std::string part = saved_->substr(std::min(from, saved_->size()), most_payload_bytes);
      return {{{"type", "saved"}, {"bytes", saved_->size()}}, part};
    }
    if (frame.type() == "restore") {
      const auto size = static_cast<std::size_t>(reader.at("bytes").integer(0, 1LL << 40));
      const host::SharedMemory memory(frame.file, size);
      const std::string saved(reinterpret_cast<const char*>(memory.data()), size);
      policy_ = call([&] { return method().restore(saved, services); });
      if (!policy_) throw MethodError("restore returned no policy");
      return {{{"type", "restored"}}};
    }
    if (frame.type() == "act") {
      if (!policy_) throw MethodError("asked to act before it learned");
      host::read_observation(memory_, layout_.picture, reader.at("instances"),
                             reader.has("shadows") && reader.at("shadows").boolean(), observation_);
      host::read_beside_pictures(reader, layout_, observation_);
      const Instruction instruction = host::read_instruction(reader.at("instruction"));
      const Action action = call([&] {
        if (reader.at("reset").boolean()) policy_->reset();
        return policy_->act(observation_, instruction);
      });
      const bool done = action.empty() && layout_.may_stop;
      if (action.size() != layout_.actions.size() && !done)
        throw MethodError(fmt::format("act() returned {} numbers, expected {}", action.size(), layout_.actions.size()));
      Json reply{{"type", "action"}};
      if (done) reply["done"] = true;
      if (const auto seen = call([&] { return policy_->seen_in_training(); })) reply["seen_in_training"] = *seen;
      return {reply, host::to_bytes(action)};
    }
    if (frame.type() == "shown") return host::shown_frame(policy_ ? call([&] { return policy_->shown(); }) : Shown());
    if (frame.type() == "drop") {
      const bool drops_method = reader.at("what").string() == "method";
      call([&] { drops_method ? method_.reset() : policy_.reset(); });
      return {{{"type", "dropped"}}};
    }
    if (frame.type() == "state") {
      ProcessState state = ProcessState::now().beyond(before_);
      arithmetic_.tell(state);
      Json reply = host::to_json(state);
      reply["type"] = "state";
      return {reply};
    }
    throw MethodError(fmt::format("unexpected frame from the worker: \"{}\"", frame.type()));
  }

  // Another one, where check-plugin had the first destroyed.
  Method& method() {
    if (!method_) method_ = load_method(plugin_);
    return *method_;
  }

  // What the processor's control register said before is put back.
  template <class Call>
  auto call(Call&& c) -> decltype(c()) {
    const FlushDenormalsAgain on_every_way_out;
    const NotesArithmetic how_it_was(arithmetic_);
    return c();
  }

  Channel& channel_;
  RemoteModel model_;
  RemoteHuman human_;
  RemoteLog log_;
  host::Layout layout_;
  host::SharedMemory memory_;
  Observation observation_;                              // the last one
  const ProcessState before_ = ProcessState::now();      // the plugin came
  Arithmetic arithmetic_;                                // at the end of every call
  const fs::path files_ = fs::current_path() / "files";  // wherever the plugin goes
  Json options_;
  std::uint64_t seed_ = 0;
  PluginInfo plugin_;
  std::unique_ptr<Method> method_;
  std::unique_ptr<Policy> policy_;
  std::optional<std::string> saved_;  // asked for in parts
};

}  // namespace

PluginInfo named_plugin(const Frame& hello, const char* kind) {
  const JsonReader reader(hello.header, "hello");
  reader.at("protocol").integer(protocol_version, protocol_version);
  const JsonReader named = reader.at(kind);
  PluginInfo plugin = read_plugin(named.at("file").string());
  if (plugin.sha256 != named.at("sha256").string())
    throw PluginError(fmt::format("{}: changed since the run began", plugin.file.string()));
  return plugin;
}

bool serve(Channel& channel) {
  std::optional<Frame> hello = channel.receive();
  if (!hello) return false;
  if (hello->header.contains("perturbation") || hello->header.contains("perceiver"))
    return serve_perturbation(channel, std::move(*hello));
  std::optional<Host> host;
  if (!report_errors_of(channel, [&] { host.emplace(channel, *hello); })) return true;
  hello.reset();  // its file is mapped by now
  while (const std::optional<Frame> frame = channel.receive()) {
    if (frame->type() == "bye") {
      host->end();
      return true;
    }
    report_errors_of(channel, [&] { host->answer(*frame); });
  }
  return false;
}

}  // namespace lgabench

#include <fmt/format.h>

#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include <lgabench/host/messages.hpp>
#include <lgabench/host/serving.hpp>

namespace lgabench {
namespace {

void expect_size(const Observation& perceived, PictureSize picture, const char* by) {
  const std::size_t pixels = picture.pixels();
  if (perceived.rgb.size() != 3 * pixels || perceived.ids.size() != pixels)
    throw MethodError(fmt::format("{}() returned {} bytes of rgb and {} of ids, expected {} and {}", by,
                                  perceived.rgb.size(), perceived.ids.size(), 3 * pixels, pixels));
}

// One plugin, a perturbation or a perceiver, from loading to its end.
class PerturbationHost {
 public:
  PerturbationHost(Channel& channel, const Frame& hello)
      : channel_(channel),
        picture_(host::read_picture_size({hello.header, "hello"})),
        memory_(hello.file, host::observation_bytes(picture_)),
        plugin_(named_plugin(hello, hello.header.contains("perceiver") ? "perceiver" : "perturbation")) {
    load();
    channel_.send(
        {{"type", "hello"}, {"protocol", protocol_version}, {"id", plugin_.id}, {"version", plugin_.version}});
  }

  void answer(const Frame& frame) {
    const JsonReader reader(frame.header, frame.type());
    if (frame.type() == "perceive") return perceive(reader);
    if (frame.type() == "drop") {
      drop();
      return channel_.send({{"type", "dropped"}});
    }
    if (frame.type() != "state")
      throw MethodError(fmt::format("unexpected frame from the worker: \"{}\"", frame.type()));
    ProcessState state = ProcessState::now().beyond(before_);
    arithmetic_.tell(state);
    Json reply = host::to_json(state);
    reply["type"] = "state";
    channel_.send(reply);
  }

  void end() {
    drop();
    std::cout.flush();
    std::fflush(nullptr);  // the worker ends this process once it has the answer
    channel_.send({{"type", "bye"}});
  }

 private:
  void perceive(const JsonReader& reader) {
    Observation seen;
    host::read_observation(memory_, picture_, reader.at("instances"), false, seen);
    load();  // check-plugin may have had the first destroyed
    const auto call = [&] {
      const FlushDenormalsAgain on_every_way_out;
      const NotesArithmetic how_it_was(arithmetic_);
      return perceiver_ ? perceiver_->read(std::move(seen), space_of(reader.at("space")))
                        : perturbed(std::move(seen), reader);
    };
    const Observation perceived = call();
    expect_size(perceived, picture_, perceiver_ ? "read" : "perceive");
    for (const Frame& frame : {host::ids_frame(perceived), host::perceived_frame(perceived)})
      channel_.send(frame.header, frame.payload);
  }

  Observation perturbed(Observation seen, const JsonReader& reader) {
    const int level = static_cast<int>(reader.at("level").integer(1, 1 << 16));
    return perturbation_->perceive(std::move(seen), level, RandomStream(reader.at("stream").string()));
  }

  static FeatureSpace space_of(const JsonReader& reader) {
    return {reader.at("id").string(), reader.at("object_types").strings(), reader.at("textures").strings()};
  }

  void load() {
    if (plugin_.kind == "perceiver" && !perceiver_)
      perceiver_ = load_perceiver(plugin_);
    else if (plugin_.kind == "perturbation" && !perturbation_)
      perturbation_ = load_perturbation(plugin_);
  }
  void drop() {
    perceiver_.reset();
    perturbation_.reset();
  }

  Channel& channel_;
  const PictureSize picture_;
  const host::SharedMemory memory_;
  const ProcessState before_ = ProcessState::now();  // the plugin came
  Arithmetic arithmetic_;                            // at the end of every call
  PluginInfo plugin_;
  std::unique_ptr<ObservationPerturbation> perturbation_;
  std::unique_ptr<Perceiver> perceiver_;
};

}  // namespace

bool serve_perturbation(Channel& channel, Frame hello) {
  std::optional<PerturbationHost> host;
  if (!report_errors_of(channel, [&] { host.emplace(channel, hello); })) return true;
  hello = {};  // its file is mapped by now
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

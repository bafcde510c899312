// What a worker says, as lgabench-method reads it, with a plugin that asks all it can (curious.cpp). The first line
// changes the hello; the payload of "learn" lies where its file has labels, owners and instances.
#include <algorithm>

#include <lgabench/core/environments.hpp>
#include <lgabench/host/messages.hpp>
#include <lgabench/host/serve.hpp>
#include <lgabench/plugin/loader.hpp>

#include "frames.hpp"

namespace {

using namespace lgabench;

const PluginInfo& curious() {
  static const PluginInfo plugin = read_plugin(program_directory().parent_path() / "tests" / "fuzz" / "curious.so");
  return plugin;
}

const host::Layout& layout() {
  static const EnvironmentType& tabletop = find_environment("tabletop");
  static const host::Layout of_it{tabletop.picture_size(), tabletop.action_space()};
  return of_it;
}

Json hello() {
  Json json{{"type", "hello"},
            {"protocol", protocol_version},
            {"method", {{"file", curious().file.string()}, {"sha256", curious().sha256}}},
            {"options", Json::object()},
            {"seed", 0}};
  json.update(host::to_json(layout()));
  return json;
}

// With the file that "learn" comes with: a step's pictures, all black, and what the input has beside them.
void send(Channel& worker, const Frame& frame) {
  if (frame.header.value("type", Json()) != "learn") return worker.send(frame.header, frame.payload);
  const std::size_t pictures = 4 * layout().picture.pixels();  // rgb and ids
  host::SharedMemory file(pictures + fuzz::most_said);
  std::copy(frame.payload.begin(), frame.payload.end(), file.data() + pictures);
  worker.send(frame.header, {}, &file.file());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > fuzz::most_said) return 0;
  auto [ours, theirs] = fuzz::ends();
  {
    Channel worker = fuzz::channel_of(std::move(theirs));
    const host::SharedMemory observation(host::observation_bytes(layout().picture));
    const std::vector<Frame> frames = fuzz::frames_of(fuzz::text_of(data, size));
    Json first = hello();
    if (!frames.empty()) first.merge_patch(frames.front().header);
    first["type"] = "hello";
    worker.send(first, {}, &observation.file());
    for (std::size_t i = 1; i < frames.size(); ++i) send(worker, frames[i]);
    worker.send({{"type", "refused"}, {"reason", "the input has ended"}});  // to a question that still waits
    worker.send({{"type", "bye"}});
  }
  Channel host = fuzz::channel_of(std::move(ours));
  try {
    serve(host);
  } catch (const InputError&) {
  } catch (const MethodError&) {
  }
  return 0;
}

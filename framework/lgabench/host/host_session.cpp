#include <lgabench/host/host_session.hpp>

#include <fmt/format.h>

#include <cstdlib>
#include <new>
#include <utility>

#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/host/reach.hpp>

namespace lgabench {
namespace {

HostCommand command_of(const HostJob& job, const Confinement* confinement) {
  HostCommand command{
      {(program_directory() / "lgabench-method").string()}, job.scratch, {}, confinement, job.memory_bytes};
  if (const Json& python = job.plugin.python; !python.is_null()) {
    command.words = {python.at("interpreter").get<std::string>(), "-m", "lgabench_method", "--serve"};
    command.also_set = {"PYTHONPATH=" + python_package().string(), "PYTHONUNBUFFERED=1"};
    if (const auto base = python.at("user_base").get<std::string>(); !base.empty())  // HOME is another one there
      command.also_set.push_back("PYTHONUSERBASE=" + base);
  } else if (job.perturb != 0) {
    command.words.insert(command.words.end(), {"--perturb", std::to_string(job.perturb)});
  }
  command.trusted = job.trusted;
  command.offline = job.offline;
  if (job.debugger) {
    command.words.insert(command.words.begin(), job.debugger->begin(), job.debugger->end());
    command.in_foreground = true;
    if (const char* terminal = std::getenv("TERM")) command.also_set.push_back(std::string("TERM=") + terminal);
  }
  return command;
}

host::Layout layout_of(const HostJob& job) {
  const EnvironmentType& type = find_environment(job.environment);
  if (job.task.empty()) return {type.picture_size(), type.action_space()};
  const TaskInfo& task = find_task(type, job.task);
  return {type.picture_size(), type.action_space_of(task), type.state_of(task), job.may_stop};
}

Json plugin_json(const PluginInfo& plugin) {
  Json json{{"file", fs::absolute(plugin.file).string()}, {"sha256", plugin.sha256}};
  if (!plugin.python.is_null())
    for (const char* member : {"class", "versions"}) json[member] = plugin.python.at(member);
  if (plugin.python.is_object() && plugin.python.contains("environment"))
    json["packages"] = plugin.python["environment"].at("packages");
  return json;
}

// A perturbation and a perceiver are told of pictures alone.
Json hello_of(const HostJob& job, const host::Layout& layout) {
  Json hello{{"type", "hello"},
             {"protocol", protocol_version},
             {job.plugin.kind, plugin_json(job.plugin)},
             {"limits", {{"header_bytes", most_header_bytes}, {"payload_bytes", most_payload_bytes}}}};
  hello.update(host::to_json(layout));
  if (job.plugin.kind == "perturbation" || job.plugin.kind == "perceiver")
    hello.erase("action");
  else
    hello.update({{"options", job.options}, {"seed", job.seed}});
  return hello;
}

// What a plugin's process may read: what it starts with, its own folder, and the data that learners use.
Reach reach_of(const HostJob& job) {
  const fs::path data = data_directory();
  Reach reach = system_reach();
  reach.network = job.plugin.asks == "network";
  reach.folders.push_back(job.plugin.file.parent_path());
  reach.writes.push_back(job.scratch);
  reach.hidden = job.hidden;
  if (!job.plugin.python.is_null()) add_python(reach, job.plugin.python);
  reach.reads.push_back(encoder_directory());
  std::error_code none_there;
  for (const auto& entry : fs::directory_iterator(data, none_there)) {
    const std::string name = entry.path().filename();
    if (name == "starters") continue;  // in a build tree the examples, whose plugins read their own folder
    const bool readable = name == "spaces" || name == "embeddings" || name == "encoder" || name == "python";
    std::vector<fs::path>& list = readable ? reach.reads : reach.unread;
    list.push_back(entry.path());
    for (const auto& file : fs::directory_iterator(entry.path(), none_there))
      if (file.is_symlink()) list.push_back(file.path());  // in a build tree, to the sources
  }
  return reach;
}

constexpr std::size_t longest = 2000;  // of what a plugin's process says of itself

std::function<void(const std::string&)>& teller() {
  static std::function<void(const std::string&)> tell = [](const std::string&) {};
  return tell;
}

}  // namespace

void tell_who_is_awaited(std::function<void(const std::string& whom)> tell) { teller() = std::move(tell); }

HostSession::HostSession(const HostJob& job)
    : whom_(fmt::format("plugin {} ({})", job.plugin.id, job.plugin.kind)),
      layout_(layout_of(job)),
      reply_limit_s_(job.reply_limit_s),
      confinement_(job.confined ? std::make_unique<Confinement>(reach_of(job)) : nullptr),
      process_(command_of(job, confinement_.get())),
      channel_(process_.take_socket(), [this](short events) { wait(events); }),
      observation_(host::observation_bytes(layout_.picture)) {
  const Frame answer = call(hello_of(job, layout_), "hello", {}, &observation_.file());
  read([&] { return JsonReader(answer.header, "hello").at("protocol").integer(protocol_version, protocol_version); });
}

void HostSession::await_begins() { asked_ = Clock::now(); }

void HostSession::await_ends() {
  if (std::exchange(is_told_, false)) teller()("");
}

void HostSession::wait(short events) {
  try {
    process_.wait(channel_.socket(), events);
  } catch (const std::bad_alloc&) {  // it was ended
    broken_ = "ran out of memory";
    throw PluginOutOfMemory(whom_);
  }
  if (reply_limit_s_ > 0 && Clock::now() - asked_ > std::chrono::duration<double>(reply_limit_s_))
    throw MethodGone(fmt::format("it did not answer within {:g} s (its time_limit_s)", reply_limit_s_), 0);
  if (is_told_ || Clock::now() - asked_ < std::chrono::milliseconds(500)) return;
  is_told_ = true;
  teller()(whom_);
}

void HostSession::raise(const JsonReader& error) {
  const auto [kind, reason] = host::read_or_malformed(
      [&] { return std::pair(error.at("kind").string(), error.at("reason").string().substr(0, longest)); });
  if (kind == "memory") throw PluginOutOfMemory(whom_);
  if (kind == "plugin") throw PluginError(reason);
  throw MethodError(reason);
}

Frame HostSession::call(const Json& request, const char* reply, const Meanwhile& meanwhile, const Descriptor* file) {
  return guarded_by_protocol([&] {
    struct Awaited {
      explicit Awaited(HostSession& one) : session(one) { session.await_begins(); }
      ~Awaited() { session.await_ends(); }
      Awaited(const Awaited&) = delete;
      Awaited& operator=(const Awaited&) = delete;
      HostSession& session;
    };
    const Awaited it(*this);
    channel_.send(request, {}, file);
    for (;;) {
      std::optional<Frame> frame = channel_.receive();
      if (!frame) process_.explain(last_words_);
      if (frame->type() == reply) return std::move(*frame);
      if (frame->type() == "ends") {
        last_words_ = read([&] { return JsonReader(frame->header, "ends").at("reason").string().substr(0, longest); });
        continue;
      }
      if (frame->type() == "error") raise(JsonReader(frame->header, "error"));
      broken_ = "was left in the middle of a call";  // by what the next line may throw
      await_ends();
      if (!meanwhile || !meanwhile(*frame, channel_))
        throw Malformed(fmt::format("\"{}\", expected \"{}\"", frame->type().substr(0, 40), reply));
      broken_.clear();
      await_begins();
    }
  });
}

ProcessState HostSession::state() {
  const Frame frame = call({{"type", "state"}}, "state");
  return read([&] { return host::read_state(JsonReader(frame.header, "state")); });
}

}  // namespace lgabench

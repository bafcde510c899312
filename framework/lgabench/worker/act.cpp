// lgabench-worker act: a kept policy acts on what it is sent, for lgabench.load_policy() in Python.
#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <memory>

#include <lgabench/cell/runs_below.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/scratch.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/host/hosted_method.hpp>
#include <lgabench/host/messages.hpp>
#include <lgabench/host/python_method.hpp>
#include <lgabench/plugin/guarded.hpp>
#include <lgabench/record/cell.hpp>
#include <lgabench/record/kept_policy.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/worker/verbs.hpp>

namespace lgabench::worker {
namespace {

// Answers leave by our standard output; what a method prints goes to the standard error instead.
class Answers {
 public:
  Answers() : descriptor_(::dup(1)) { ::dup2(2, 1); }
  void send(const Json& answer) const {
    const std::string line = answer.dump() + '\n';
    for (std::size_t at = 0; at < line.size();) {
      const ssize_t n = ::write(descriptor_.fd, line.data() + at, line.size() - at);
      if (n < 0) throw InputError("act: nobody reads the answers");
      at += static_cast<std::size_t>(n);
    }
  }

 private:
  Descriptor descriptor_;
};

Json read_line(const char* what) {
  std::string line;
  if (!std::getline(std::cin, line)) return {};
  return parse_json(line, what);
}

Observation read_observation(const host::Layout& layout, const JsonReader& request) {
  const PictureSize size = layout.picture;
  host::SharedMemory pixels(host::observation_bytes(size));
  const std::size_t sent = 4 * size.pixels();  // rgb and ids
  if (!std::cin.read(reinterpret_cast<char*>(pixels.data()), static_cast<std::streamsize>(sent)))
    throw InputError("act: expected the pictures behind the request");
  Observation seen;
  host::read_observation(pixels, size, request.at("instances"), false, seen);
  host::read_beside_pictures(request, layout, seen);
  return seen;
}

// The plugin whose policy it is: one of the job's methods, or one that is installed.
PluginInfo plugin_of(const JsonReader& job, const KeptPolicy& kept) {
  std::vector<fs::path> paths;
  for (const std::string& path : job.at("plugin_path").strings()) paths.emplace_back(path);
  Catalogue catalogue = plugins_at(paths, job.at("python").string());
  if (const std::string written = job.at("method").string(); !written.empty())
    with_python_method(written, job.at("python").string(), catalogue);
  const PluginInfo& plugin = catalogue.find("method", kept.method);
  if (plugin.version != kept.version)
    throw InputError(fmt::format("{}: this is version {}, but version {} saved the policy", plugin.file.string(),
                                 plugin.version, kept.version));
  return plugin;
}

// @throws InputError naming the file for what the method throws.
std::unique_ptr<Policy> restored(HostedMethod& method, const KeptPolicy& kept, const fs::path& file) {
  try {
    return guarded(kept.method, [&] { return method.restore(kept.bytes); });
  } catch (const Error& e) {
    throw InputError(fmt::format("{}: {}", file.string(), e.what()));
  }
}

void act_on(const JsonReader& job, const Answers& answers) {
  const fs::path directory = fs::absolute(job.at("cell").string());
  const KeptPolicy kept = read_kept_policy(directory);
  const Cell cell = recorded_cell(directory);
  const PluginInfo plugin = plugin_of(job, kept);
  const Scratch scratch("act");
  HostJob host{plugin,
               cell.environment,
               cell.method.acts ? cell.method.acts->options : cell.method.options,
               cell.training_seed,
               scratch.path,
               true,
               runs_below(plugin.file.parent_path())};
  host.hidden.push_back(directory.parent_path().parent_path());
  const Scenario scenario = read_scenario(*cell.scenario, (directory / cell_file::configuration).string());
  host.task = scenario.task;
  host.may_stop = scenario.may_stop;
  HostedMethod method(host);
  const std::unique_ptr<Policy> policy = restored(method, kept, directory / cell_file::policy);
  const host::Layout layout{scenario.environment->picture_size(), actions_of(scenario), state_of(scenario),
                            scenario.may_stop};
  answers.send({{"rows", layout.picture.rows}, {"columns", layout.picture.columns}});
  for (Json request = read_line("act"); !request.is_null(); request = read_line("act")) {
    const JsonReader reader(request, "act");
    const Observation seen = read_observation(layout, reader);
    const Instruction instruction = host::read_instruction(reader.at("instruction"));
    try {
      if (reader.at("reset").boolean()) policy->reset();
      answers.send({{"action", guarded(plugin.id, [&] { return policy->act(seen, instruction); })}});
    } catch (const MethodGone&) {
      throw;
    } catch (const MethodError& e) {
      answers.send({{"error", e.what()}});
    }
  }
  method.end();
}

}  // namespace

void act() {
  const Answers answers;
  try {
    const Json job = read_line("job");
    act_on(JsonReader(job, "job"), answers);
  } catch (const std::exception& e) {
    answers.send({{"fatal", one_line(e.what())}});
  }
}

}  // namespace lgabench::worker

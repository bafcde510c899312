#include <lgabench/harness/run_description.hpp>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>

#include <cmath>
#include <ctime>
#include <set>

#include <lgabench/core/resources.hpp>
#include <lgabench/core/version.hpp>
#include <lgabench/harness/cell_plugins.hpp>
#include <lgabench/host/confine.hpp>

namespace lgabench {
namespace {

Json machine() {
  utsname system{};
  ::uname(&system);
  const Processor processor = this_processor();
  return {{"processor", processor.name},
          {"instructions", processor.instructions},
          {"cores", usable_cores()},
          {"memory_gib", std::round(usable_bytes() / (1 << 30) * 10) / 10},
          {"system", fmt::format("{} {}", system.sysname, system.release)}};
}

}  // namespace

Json answers_json(const std::vector<AnswerFile>& files) {
  Json answers = Json::array();
  for (const AnswerFile& file : files) {
    answers.push_back(file.about);
    answers.back().update({{"file", file.path.string()}, {"name", file.name}});
  }
  return answers;
}

// The part of the run that is computed now; none where that is all of it.
std::optional<RunRecord::Shard> shard_of(const RunPlan& plan) {
  if (plan.shard.count == 1) return std::nullopt;
  return RunRecord::Shard{plan.shard.index, plan.shard.count, cells_of(plan.cells, plan.shard).size()};
}

RunRecord describe(const RunPlan& plan, const Catalogue& catalogue) {
  RunRecord run;
  std::set<std::string> named;
  const auto name = [&](const PluginInfo& info) {
    if (!named.insert(info.kind + info.id).second) return;
    run.plugins.push_back({info.kind, info.id, info.version, info.sha256, info.asks});
  };
  for (const Cell& cell : plan.cells) {
    run.cells.push_back(key(cell));
    if (const auto engine = engine_plugin(cell, catalogue)) name(*engine);
    if (const PluginInfo* environment = environment_plugin(cell, catalogue)) name(*environment);
    for (const PluginInfo& axis : axis_plugins(cell, catalogue)) name(axis);
    if (const PluginInfo* perceiver = perceiver_plugin(cell, catalogue)) name(*perceiver);
    if (const PluginInfo* method = method_plugin(cell, catalogue)) {
      name(*method);
      if (const PluginInfo* acts = acting_plugin(cell, catalogue)) name(*acts);
      for (const auto& [option, value] : cell.method.options.items()) {
        const auto known = method->options.find(option);  // none: of a plugin that had it when its run was recorded
        if (known == method->options.end() || value != known->at("default"))
          run.settings[cell.method.name][option] = value;
      }
    }
    run.build.update(build_of(cell, catalogue));
    for (const std::string& plugin : named_in_build(cell)) run.build.erase(plugin);
  }
  for (const char* plugin : {"engine", "method", "python", "acts"}) run.build.erase(plugin);
  run.suite = plan.request.at("suite");
  run.preset = plan.request.at("preset");
  run.smoke = plan.cells.front().smoke;
  run.request = plan.request;
  run.about = plan.about;
  run.claims = plan.claims;
  run.version = LGABENCH_VERSION;
  run.program = plan.program;
  run.command = plan.command;
  run.confinement = plan.confined ? confinement_text() : unconfined_run;
  run.answers = answers_json(plan.answers);
  run.started = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  run.machine = machine();
  run.shard = shard_of(plan);
  return run;
}

}  // namespace lgabench

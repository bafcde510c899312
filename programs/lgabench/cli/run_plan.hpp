// What `run` and `cluster` are asked for, and the run that comes of it.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/abstraction/openai_options.hpp>
#include <lgabench/cli/outcome.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/harness/run_suite.hpp>
#include <lgabench/host/python_environment.hpp>

namespace lgabench::cli {

struct RunArguments {
  std::string suite, preset, python = usual_python(), answers = "recorded", truth = "released", humans, out, cache,
                             debug, shard = "1/1", model, cassette, request, prompt, train_on;
  Words methods, engines, scenarios, layouts, demonstrations, seeds, settings, selection_errors, names, segments, axes,
      arms;
  std::vector<fs::path> plugin_path;
  std::optional<int> episodes;
  std::optional<std::int64_t> scene_seed;
  int jobs = 0, limit = 0, max_queries = -1;  // 0: as many as there are cores, all cells
  double timeout_s = 3600, memory_gib = 0;
  long reply_timeout_s = OpenAiOptions().timeout_s;
  int concurrency = LiveModel().concurrency;
  std::string program;  // as --version says
  bool unconfined = false, keep_policy = false, any_served = false, rehearsal = false, resume = false, fresh = false,
       dry_run = false, no_reference = false, json = false, tables = false, quiet = false;
};

/// The options of `run`. Its --help leaves out those that are rarely needed.
void add_run_options(Verb& verb, RunArguments& a);

/// The run, and the plugins that it uses. @throws InputError, or PluginError, for what the options do not make.
struct PlannedRun {
  Catalogue catalogue;
  RunPlan plan;
};
PlannedRun plan_run(RunArguments a);

}  // namespace lgabench::cli

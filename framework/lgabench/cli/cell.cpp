// lgabench-worker cell: one cell, described on stdin. `lgabench run` starts it; by hand: lgabench-worker cell <job.json
#include <sys/prctl.h>

#include <memory>

#include <lgabench/abstraction/openai_client.hpp>
#include <lgabench/cli/job.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/run_cell.hpp>

namespace lgabench::cli {
namespace {

void run(const JsonReader& reader, const Messages& messages) {
  ::prctl(PR_SET_DUMPABLE, 0);  // no method's process reads scenes out of this one's memory
  CellJob job{read_cell(reader.at("cell").json(), "job: /cell"),
              job_plugin(reader.at("engine")),
              std::nullopt,
              reader.at("directory").string(),
              reader.at("cache").string(),
              reader.at("answers").string(),
              reader.at("scratch").string(),
              reader.at("build").json()};
  job.confined = reader.at("confined").boolean();
  job.memory_bytes = reader.at("limits").at("data_bytes").integer(1, 1LL << 60);
  if (reader.has("debugger")) job.debugger = reader.at("debugger").strings();
  if (reader.has("method")) job.method = job_plugin(reader.at("method"));
  if (job.cell.method.is_reference() == job.method.has_value())
    reader.at("cell").fail("a plugin for a method, and only there");
  std::unique_ptr<ChatClient> server;
  if (reader.has("live")) job.live = read_live_model(reader.at("live"));
  if (reader.has("live") && job.live.asks) {
    OpenAiOptions options = openai_from_environment();
    options.waiting = [](const std::string& why) { to_stderr("{}\n", one_line(why)); };
    server = std::make_unique<OpenAiClient>(std::move(options));
    job.live.server = server.get();
  }
  run_cell(job, [&messages](const std::string& phase, long long count) {
    messages.send({{"phase", phase}, {"count", count}});
  });
}

}  // namespace

void add_cell(CLI::App& app, int&) {
  CLI::App* verb = app.add_subcommand("cell", "Compute the cell described as JSON on stdin; progress on descriptor 3");
  verb->callback([] { do_job(run); });
}

}  // namespace lgabench::cli

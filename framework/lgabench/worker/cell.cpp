// lgabench-worker cell: one cell, described on stdin. `lgabench run` starts it; by hand: lgabench-worker cell <job.json
#include <sys/prctl.h>

#include <memory>

#include <lgabench/abstraction/openai_client.hpp>
#include <lgabench/cell/run_cell.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/host/python_environment.hpp>
#include <lgabench/worker/job.hpp>
#include <lgabench/worker/verbs.hpp>

namespace lgabench::worker {
namespace {

void run(const JsonReader& reader, const Messages& messages) {
  ::prctl(PR_SET_DUMPABLE, 0);  // no method's process reads scenes out of this one's memory
  let_environments_start();
  const CellJob job = read_cell_job(reader);
  std::unique_ptr<ChatClient> server;
  if (job.live && job.live->asks) {
    OpenAiOptions options = openai_from_environment();
    options.timeout_s = job.live->reply_timeout_s;
    options.was_there = true;  // when the questions were asked that methods declare
    options.waiting = [](const std::string& why) { to_stderr("{}\n", one_line(why)); };
    server = std::make_unique<OpenAiClient>(std::move(options));
  }
  run_cell(job, server.get(), [&messages](const std::string& phase, long long count) { messages.at({phase, count}); });
}

}  // namespace

void cell() { do_job(run); }

}  // namespace lgabench::worker

// lgabench-worker check-job: uses a plugin as cells do, and looks at what that leaves. `lgabench check-plugin` starts
// it.
#include <malloc.h>

#include <lgabench/cli/job.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/harness/check.hpp>

namespace lgabench::cli {
namespace {

void check(const JsonReader& job, const Messages& messages) {
  // What the heap gives out is filled with another byte in the second process, so that reading it uninitialised shows.
  ::mallopt(M_PERTURB, static_cast<int>(job.at("perturb").integer(0, 255)));
  const CheckPhase phase = [&messages](const std::string& name) { messages.send({{"phase", name}, {"count", 0}}); };
  const PluginInfo engine = job_plugin(job.at("engine"));
  const CheckReport report = job.has("method")
                                 ? check_method(job_plugin(job.at("method")), engine, job.at("options").json(), phase)
                                 : check_engine(engine, phase);
  write_file(job.at("report").string(), canonical(to_json(report)) + '\n');
}

}  // namespace

void add_check_job(CLI::App& app, int&) {
  CLI::App* verb = app.add_subcommand("check-job", "Check the plugin described as JSON on stdin");
  verb->group("");
  verb->callback([] { do_job(check); });
}

}  // namespace lgabench::cli

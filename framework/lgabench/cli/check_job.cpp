// lgabench-worker check-job: uses a plugin as cells do, and looks at what that leaves. `lgabench check-plugin` starts
// it.
#include <lgabench/cli/job.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/harness/check.hpp>

namespace lgabench::cli {
namespace {

void check(const JsonReader& job, const Messages& messages) {
  const int perturb = static_cast<int>(job.at("perturb").integer(0, 255));
  perturb_heap(perturb);  // of an engine, which runs in this process
  const CheckPhase phase = [&messages](const std::string& name) { messages.send({{"phase", name}, {"count", 0}}); };
  const PluginInfo engine = job_plugin(job.at("engine"));
  const auto on_method = [&] {
    HostJob method{job_plugin(job.at("method")), job.at("options").json(), 0, job.at("scratch").string()};
    method.perturb = perturb;
    return check_method(method, engine, phase);
  };
  const CheckReport report = job.has("method") ? on_method() : check_engine(engine, phase);
  write_file(job.at("report").string(), canonical(to_json(report)) + '\n');
}

}  // namespace

void add_check_job(CLI::App& app, int&) {
  CLI::App* verb = app.add_subcommand("check-job", "Check the plugin described as JSON on stdin");
  verb->group("");
  verb->callback([] { do_job(check); });
}

}  // namespace lgabench::cli

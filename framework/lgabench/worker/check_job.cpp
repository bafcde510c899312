// lgabench-worker check-job: uses a plugin as cells do, and looks at what that leaves. `lgabench check-plugin` starts
// it.
#include <lgabench/cell/check.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/host/python_environment.hpp>
#include <lgabench/job/job.hpp>
#include <lgabench/worker/job.hpp>
#include <lgabench/worker/verbs.hpp>

namespace lgabench::worker {
namespace {

void check(const JsonReader& reader, const Messages& messages) {
  let_environments_start();
  const CheckJob job = read_check_job(reader);
  perturb_heap(job.perturb);  // of an engine, which runs in this process
  std::size_t written = 0;
  const CheckPhase phase = [&](const std::string& name, const CheckReport& so_far) {
    if (so_far.findings.size() > written) write_file(job.report, canonical(to_json(so_far)) + '\n');
    written = so_far.findings.size();
    messages.at({name});
  };
  const auto on_method = [&] {
    HostJob method{*job.method, job.environment, job.options, 0, job.scratch};
    method.perturb = job.perturb;
    method.memory_bytes = job.limits.data_bytes;
    return check_method(method, job.engine, job.scenario, phase);
  };
  const auto on_perturbation = [&] {
    HostJob perturbation{*job.perturbation, job.environment, Json::object(), 0, job.scratch};
    perturbation.perturb = job.perturb;
    perturbation.memory_bytes = job.limits.data_bytes;
    return job.perturbation->kind == "perceiver" ? check_perceiver(perturbation, phase)
                                                 : check_perturbation(perturbation, phase);
  };
  const CheckReport report = job.perturbation          ? on_perturbation()
                             : job.method              ? on_method()
                             : job.checked_environment ? check_environment(*job.checked_environment, job.engine, phase)
                                                       : check_engine(job.engine.value(), job.environment, phase);
  write_file(job.report, canonical(to_json(report)) + '\n');
}

}  // namespace

void check_job() { do_job(check); }

}  // namespace lgabench::worker

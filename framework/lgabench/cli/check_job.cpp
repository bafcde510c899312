// lgabench-worker check-job: uses a plugin as cells do, and looks at what that leaves. `lgabench check-plugin` starts
// it.
#include <malloc.h>

#include <memory>
#include <vector>

#include <lgabench/cli/job.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/harness/check.hpp>

namespace lgabench::cli {
namespace {

// Takes blocks of every size for good: the heap then gives out other addresses, also where the system does not
// randomise them.
void shift_heap() {
  static std::vector<std::unique_ptr<char[]>> kept;
  constexpr std::size_t small = 1024, blocks = 32, large = 1 << 20;
  kept.reserve(small / 16 * blocks + 1);
  for (std::size_t size = 16; size <= small; size += 16)
    for (std::size_t i = 0; i < blocks; ++i) kept.push_back(std::make_unique<char[]>(size - 8));
  kept.push_back(std::make_unique<char[]>(large));
}

void check(const JsonReader& job, const Messages& messages) {
  // What the heap gives out is elsewhere in the second process and filled with another byte, so that deciding by an
  // address and reading what was never set show.
  const int perturb = static_cast<int>(job.at("perturb").integer(0, 255));
  if (perturb != 0) shift_heap();
  ::mallopt(M_PERTURB, perturb);
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

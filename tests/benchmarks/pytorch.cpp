// The training step in PyTorch from Python: a child process, timed by itself (training_in_pytorch.py).
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <boost/process.hpp>
#include <map>
#include <memory>

#include "benchmarks.hpp"

namespace lgabench {
namespace {

namespace bp = boost::process;

// One network in one Python, which child_'s destructor ends.
class Steps {
 public:
  Steps(const std::string& python, const std::string& channels, bool text)
      : child_(python, LGABENCH_TRAINING_IN_PYTORCH, channels, text ? "text" : "", bp::std_in<in_, bp::std_out> out_,
               bp::std_err > bp::null) {
    std::string line;
    ready_ = std::getline(out_, line) && line == "ready";
  }
  bool ready() const { return ready_; }
  bool running() {
    std::error_code gone;
    return child_.running(gone) && !gone;
  }

  // Processor time of `count` steps; nothing sensible once the child has gone, which `failed` tells.
  double seconds(benchmark::IterationCount count, bool& failed) {
    double answer = 0;
    in_ << count << std::endl;
    failed = !(out_ >> answer);
    return answer;
  }

 private:
  bp::opstream in_;
  bp::ipstream out_;
  bp::child child_;
  bool ready_ = false;
};

// That of the first Python that has PyTorch, the system's being Debian's; null if none has.
std::unique_ptr<Steps> start(const std::string& channels, bool text) {
  for (const std::string& python : {bp::search_path("python3").string(), std::string("/usr/bin/python3")}) try {
      auto steps = std::make_unique<Steps>(python, channels, text);
      if (steps->ready()) return steps;
    } catch (const bp::process_error&) {  // no such program
    }
  return nullptr;
}

void pytorch(benchmark::State& state, const std::string& name, const std::string& channels, bool text) {
  static std::map<std::string, std::unique_ptr<Steps>> started;
  std::unique_ptr<Steps>& steps = started[name];
  if (!steps || !steps->running()) steps = start(channels, text);  // a method's process takes all children along
  if (!steps) return state.SkipWithError("skipped: python3 cannot import torch");
  constexpr benchmark::IterationCount batch = 10;
  while (state.KeepRunningBatch(batch)) {
    bool failed = false;
    state.SetIterationTime(steps->seconds(batch, failed));
    if (failed) stop_at("training_in_pytorch.py ended early");
  }
  state.SetItemsProcessed(state.iterations());
}

}  // namespace

void register_pytorch(const std::string& name, const std::vector<int>& channels, bool text) {
  const std::string of_towers = fmt::format("{}", fmt::join(channels, " "));
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    pytorch(state, name, of_towers, text);
  })->UseManualTime();
}

}  // namespace lgabench

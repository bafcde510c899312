// Whole programs: how long a list takes, and what a second worker brings.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdlib>

#include <lgabench/core/scratch.hpp>

#include "benchmarks.hpp"

namespace lgabench {
namespace {

void execute(const std::string& arguments) {
  const int status = std::system(fmt::format("'{}' {} >/dev/null 2>&1", LGABENCH_PROGRAM, arguments).c_str());
  if (status != 0) stop_at(fmt::format("ended with status {:#x}: lgabench {}", status, arguments));
}

void list(benchmark::State& state) {
  for (auto _ : state) execute("list");
}

// Two dozen cells of about the same length, demonstrations at hand: few would show how the last two happen to end, a
// short run its start and its report, which q1 has once an hour.
void workers(benchmark::State& state, int count) {
  static const Scratch scratch("benchmark");
  for (auto _ : state)
    execute(
        fmt::format("run q1 --methods lga --scenarios heart,letter --demos 10 --seeds 0:12 --no-reference "
                    "--fresh --jobs {} --out '{}/run' --cache '{}/cache'",
                    count, scratch.path.string(), scratch.path.string()));
}

}  // namespace

void register_harness() {
  benchmark::RegisterBenchmark("list", list)->UseRealTime();
  for (const int count : {1, 2})
    benchmark::RegisterBenchmark(fmt::format("workers/{}", count).c_str(), workers, count)
        ->UseRealTime()
        ->Iterations(1);
}

}  // namespace lgabench

// lgabench-benchmarks [--summary] and Google Benchmark's own options.
#include <benchmark/benchmark.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <lgabench/core/flush_denormals.hpp>

#include "benchmarks.hpp"
#include "summary.hpp"

void lgabench::stop_at(const std::string& failure) {
  std::fprintf(stderr, "lgabench-benchmarks: %s\n", failure.c_str());
  std::exit(1);
}

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);  // a child without PyTorch ends before it has read what it is given
  // What a ratio on a noisy machine needs; options given afterwards win.
  std::vector<char*> arguments{argv[0]};
  char interleaved[] = "--benchmark_enable_random_interleaving=true", repetitions[] = "--benchmark_repetitions=9",
       aggregates[] = "--benchmark_report_aggregates_only=true";
  bool summarise = false;
  for (int i = 1; i < argc; ++i) summarise = summarise || std::strcmp(argv[i], "--summary") == 0;
  if (summarise) arguments.insert(arguments.end(), {interleaved, repetitions, aggregates});
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], "--summary") != 0) arguments.push_back(argv[i]);
  int count = static_cast<int>(arguments.size());

  lgabench::flush_denormals();
  lgabench::register_training();
  lgabench::register_heat_map();
  lgabench::register_environment();
#if defined(LGABENCH_HAS_EGL)
  lgabench::register_llvmpipe();
#endif
  lgabench::register_tinyrenderer();
  lgabench::register_python();
  lgabench::register_plugin();
  lgabench::register_harness();
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  if (!summarise) {
    benchmark::RunSpecifiedBenchmarks();
    return 0;
  }
  lgabench::Medians medians;
  benchmark::RunSpecifiedBenchmarks(&medians);
  std::printf("\n%s", lgabench::summary(medians.seconds).c_str());
  return lgabench::floors_hold(medians.seconds) ? 0 : 1;
}

// The benchmarks of each part, registered by main().
#pragma once
#include <string>
#include <vector>

namespace lgabench {

void register_training();
void register_heat_map();
/// The training step of a network with these pictures, as Python makes it: skipped where Python has no PyTorch.
void register_pytorch(const std::string& name, const std::vector<int>& channels, bool text);
void register_environment();
void register_llvmpipe();  // where EGL's headers are
void register_tinyrenderer();
void register_python();  // skipped without the package lgabench
void register_plugin();
void register_harness();

/// Ends the program with that message: Google Benchmark would stop at its own check of a repetition that failed after
/// others did not, without a name.
[[noreturn]] void stop_at(const std::string& failure);

/// A promise of docs/performance.md: what `measured` must be beside `reference`, both names of benchmarks.
struct Promise {
  std::string what, measured, reference;
  enum class Unit { times_as_fast, times_as_long } unit;
  double floor, goal;
  double reference_s = 0;  // in place of a benchmark
};
const std::vector<Promise>& promises();

}  // namespace lgabench

#include "summary.hpp"

#include <fmt/format.h>

#include <optional>

#include "benchmarks.hpp"

namespace lgabench {

const std::vector<Promise>& promises() {
  using Unit = Promise::Unit;
  static const std::vector<Promise> all = {
      {"training step, mask, all its products at the core's FMA peak", "step/mask", "step/mask/peak",
       Unit::times_as_fast, .30, .50},
      {"training step, mask, LibTorch's autograd and Adam", "step/mask", "step/mask/libtorch", Unit::times_as_fast, 2.2,
       3.5},
      {"training step, rgb and text, LibTorch", "step/rgb_and_text", "step/rgb_and_text/libtorch", Unit::times_as_fast,
       2.2, 3.5},
      {"training step, mask, PyTorch from Python", "step/mask", "step/mask/pytorch", Unit::times_as_fast, 2.2, 3.5},
      {"training step, rgb and text, PyTorch from Python", "step/rgb_and_text", "step/rgb_and_text/pytorch",
       Unit::times_as_fast, 2.2, 3.5},
      {"training step of heat_map, mask, LibTorch", "step/heat_map", "step/heat_map/libtorch", Unit::times_as_fast, 2.2,
       4},
      {"training step, mask, the same without batch normalisation", "step/mask", "step/mask/plain", Unit::times_as_long,
       1.5, 1.3},
      {"training step, rgb and text, without batch normalisation", "step/rgb_and_text", "step/rgb_and_text/plain",
       Unit::times_as_long, 1.7, 1.5},
      {"episode, pick and place, the bare MuJoCo loop", "episode/heart", "episode/heart/bare", Unit::times_as_long, 1.3,
       1},
      {"episode, rotate, the bare MuJoCo loop", "episode/rotate_block", "episode/rotate_block/bare",
       Unit::times_as_long, 1.3, 1},
      {"episode, six near misses, MuJoCo with two", "crowd/mujoco/near_6", "crowd/mujoco/near_2", Unit::times_as_long,
       1.4, 1.2},
      {"episode, six near misses, Bullet with two", "crowd/bullet/near_6", "crowd/bullet/near_2", Unit::times_as_long,
       1.6, 1.4},
      {"episode, VIMABench's 0.87 s", "episode/heart", "", Unit::times_as_fast, 100, 250, .87},
      {"reset without pictures, 50 microseconds", "reset", "", Unit::times_as_fast, 1, 2, 50e-6},
      {"picture and ids, MuJoCo on llvmpipe without shadow", "picture", "picture/llvmpipe", Unit::times_as_fast, 1.5,
       4},
      {"picture and ids, MuJoCo on llvmpipe with shadow", "picture", "picture/llvmpipe_shadow", Unit::times_as_fast, 3,
       8},
      {"picture and ids, 480 x 640, MuJoCo on llvmpipe with shadow, the tabletop's scene", "picture/mobile",
       "picture/mobile/llvmpipe_shadow", Unit::times_as_fast, 1.5, 4},
      {"picture and ids, PyBullet's TinyRenderer without shadow", "picture", "picture/tinyrenderer",
       Unit::times_as_fast, 15, 50},
      {"all objects erased, a copy of the observation", "repaint", "repaint/copy", Unit::times_as_long, 8, 1.5},
      {"act() through a plugin, the same object linked", "act/plugin", "act/linked", Unit::times_as_long, 1.1, 1.05},
      {"start and end of a method's process, 60 ms", "host/start", "", Unit::times_as_fast, 1, 2, .06},
      {"50 demonstrations to and from shared memory, 20 ms", "host/demonstrations", "", Unit::times_as_fast, 1, 2, .02},
      {"act() in a process of its own, 1 ms", "act/hosted", "", Unit::times_as_fast, 1, 4, .001},
      {"episode from Python, the same calls in C++", "python/binding", "python/loop", Unit::times_as_long, 1.1, 1.05},
      {"8 environments on two threads, Gymnasium's SyncVectorEnv", "python/threads", "python/sync", Unit::times_as_fast,
       1.8, 2.3},
      {"two workers, one", "workers/2", "workers/1", Unit::times_as_fast, 1.9, 1.98},
      {"lgabench list, 100 ms", "list", "", Unit::times_as_fast, 1, 100. / 30, .1},
  };
  return all;
}

namespace {

// How often the reference goes into what was measured, in the promise's unit; nothing if a side was not measured.
std::optional<double> ratio(const Promise& promise, const std::map<std::string, double>& seconds) {
  const auto measured = seconds.find(promise.measured), reference = seconds.find(promise.reference);
  if (measured == seconds.end() || (reference == seconds.end() && promise.reference_s == 0)) return {};
  const double of = promise.reference_s > 0 ? promise.reference_s : reference->second;
  return promise.unit == Promise::Unit::times_as_fast ? of / measured->second : measured->second / of;
}

bool reaches(const Promise& promise, double ratio, double bound) {
  return promise.unit == Promise::Unit::times_as_fast ? ratio >= bound : ratio <= bound;
}

}  // namespace

void Medians::ReportRuns(const std::vector<Run>& runs) {
  ConsoleReporter::ReportRuns(runs);
  for (const Run& run : runs)
    if (!run.error_occurred && run.run_type == Run::RT_Aggregate && run.aggregate_name == "median") {
      std::string name = run.run_name.function_name;
      seconds[name] = (run.run_name.time_type.empty() ? run.GetAdjustedCPUTime() : run.GetAdjustedRealTime()) /
                      benchmark::GetTimeUnitMultiplier(run.time_unit);
    }
}

std::string summary(const std::map<std::string, double>& seconds) {
  std::string text = "| what, reference | measured | ratio | floor | goal | |\n|---|---|---|---|---|---|\n";
  for (const Promise& promise : promises()) {
    const auto found = ratio(promise, seconds);
    if (!found) {
      text += fmt::format("| {} | not measured | | | | |\n", promise.what);
      continue;
    }
    const bool fast = promise.unit == Promise::Unit::times_as_fast;
    const auto bound = [&](double value) { return fmt::format("{} {:.3g}", fast ? "≥" : "≤", value); };
    text += fmt::format("| {} | {:.4g} ms | {:.3g} × as {} | {} | {} | {} |\n", promise.what,
                        1e3 * seconds.at(promise.measured), *found, fast ? "fast" : "long", bound(promise.floor),
                        bound(promise.goal),
                        reaches(promise, *found, promise.goal)    ? "goal"
                        : reaches(promise, *found, promise.floor) ? "floor"
                                                                  : "missed");
  }
  return text;
}

bool floors_hold(const std::map<std::string, double>& seconds) {
  for (const Promise& promise : promises()) {
    const auto found = ratio(promise, seconds);
    if (found && !reaches(promise, *found, promise.floor)) return false;
  }
  return true;
}

}  // namespace lgabench

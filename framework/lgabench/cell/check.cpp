#include <lgabench/cell/check.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace lgabench {
namespace {

// What threads are called, which a confined process cannot read of itself.
std::vector<std::string> names_of(const std::vector<std::string>& threads) {
  std::vector<std::string> names;
  for (const std::string& thread : threads) {
    std::ifstream file(fmt::format("/proc/{}/comm", std::atoi(thread.c_str())));
    std::getline(file, names.emplace_back());
  }
  return names;
}

}  // namespace

std::vector<std::string> left_behind(const std::function<std::vector<std::string>()>& now) {
  std::vector<std::string> left = now();
  for (int wait = 0; wait < 50 && !left.empty(); ++wait) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    left = now();
  }
  return left;
}

void judge_arithmetic(CheckReport& report, const ProcessState& state) {
  report.judge(
      "rounding mode",
      !state.flushed  ? "the plugin cleared flush-to-zero"
      : !state.rounds ? "the plugin left another rounding mode (fesetround())"
                      : "",
      "to nearest, flush-to-zero kept",
      "leave the processor's control register as it is: other modes change results, and subnormal numbers make "
      "training 20 times slower");
}

void judge_leftovers(CheckReport& report, const std::function<ProcessState()>& now) {
  ProcessState state;
  const std::vector<std::string> threads = left_behind([&] { return (state = now()).threads; });
  report.judge("threads", threads.empty() ? "" : fmt::format("left running: {}", fmt::join(names_of(threads), ", ")),
               "none left behind",
               "join every thread before the call that started it returns, or in the destructor; set a library's "
               "own pool to one thread");
  const auto& files = state.descriptors;
  report.judge("descriptors", files.empty() ? "" : fmt::format("left open: {}", fmt::join(files, ", ")),
               "none left open", "close every file and socket, or hold it in an object that does");
}

}  // namespace lgabench

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

void judge_leftovers(CheckReport& report, const std::function<ProcessState()>& now) {
  ProcessState left = now();
  for (int wait = 0; wait < 50 && !left.threads.empty(); ++wait) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    left = now();
  }
  report.judge("threads",
               left.threads.empty() ? "" : fmt::format("left running: {}", fmt::join(names_of(left.threads), ", ")),
               "none left behind",
               "join every thread before the call that started it returns, or in the destructor; a library's own pool "
               "is kept small by its settings (one thread)");
  const auto& files = left.descriptors;
  report.judge("descriptors", files.empty() ? "" : fmt::format("left open: {}", fmt::join(files, ", ")),
               "none left open", "close every file and socket, or hold it in an object that does");
}

}  // namespace lgabench

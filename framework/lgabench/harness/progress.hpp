// What a person sees on stderr while a run goes on: a bar on a terminal, a line a cell otherwise.
#pragma once
#include <chrono>
#include <cstddef>
#include <map>
#include <string>

namespace lgabench {

/// One thread. Writes nothing after the last cell but an empty bar's trace. Colour only on a terminal and without
/// NO_COLOR.
class Progress {
 public:
  /// `total` cells to compute.
  explicit Progress(std::size_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void started(std::size_t cell, const std::string& title);
  void phase(std::size_t cell, const std::string& phase, long long count);
  /// `failure` is empty for a cell that went well.
  void ended(std::size_t cell, const std::string& failure);
  /// Redraws the bar.
  void tick();
  /// A line above the bar.
  void say(const std::string& line);

 private:
  struct Running {
    std::string title, phase;
    long long count = 0;
    std::chrono::steady_clock::time_point start;
  };
  void wipe();

  const std::size_t total_;
  std::size_t done_ = 0, failed_ = 0;
  std::map<std::size_t, Running> running_;
  std::chrono::steady_clock::time_point start_;
  bool terminal_ = false, colour_ = false, drawn_ = false;
};

}  // namespace lgabench

// What a person sees on stderr while a run goes on: a bar on a terminal, a line a cell otherwise.
#pragma once
#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <string>

namespace lgabench {

/// One thread. Writes nothing after the last cell but an empty bar's trace.
class Progress {
 public:
  /// `total` cells to compute, `jobs` at once; `queued_s`: seconds of one worker for those that were not started.
  /// `quiet`: cells that fail are all that is written.
  Progress(std::size_t total, int jobs, std::function<double()> queued_s, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `expected_s`: seconds that it is expected to take.
  void started(std::size_t cell, const std::string& title, double expected_s);
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
    double expected_s = 0;
    std::chrono::steady_clock::time_point start;
  };
  void wipe();
  // "1:23:00 left", as far as can be told.
  std::string left() const;

  const std::size_t total_;
  const double jobs_;
  const std::function<double()> queued_s_;
  std::size_t done_ = 0, failed_ = 0;
  std::map<std::size_t, Running> running_;
  std::chrono::steady_clock::time_point start_;
  bool terminal_ = false, quiet_ = false, drawn_ = false;
};

}  // namespace lgabench

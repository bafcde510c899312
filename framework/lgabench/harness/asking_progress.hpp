// How far questions to a server are, for a person.
#pragma once
#include <chrono>
#include <string>

namespace lgabench {

/// On stderr: one line on a terminal, else a line every half minute and at the end. One thread.
class AskingProgress {
 public:
  /// `open`: questions that will be asked.
  explicit AskingProgress(int open = 0) : open_(open) {}
  /// `asked`: how many of them were.
  void tell(int asked);
  /// Ends the line where another process answered some of them.
  void end();
  /// A line of its own.
  void say(const std::string& line);

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now(), told_ = start_;
  int open_ = 0;
  bool drawn_ = false;
};

}  // namespace lgabench

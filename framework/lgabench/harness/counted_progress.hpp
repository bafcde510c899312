// How far something is that is counted, for a person: questions to a server, scenes, commands.
#pragma once
#include <chrono>
#include <string>
#include <utility>

namespace lgabench {

/// Says on stderr how far something is: one line on a terminal, else a line after five seconds, every half minute and
/// at the end. One thread.
class CountedProgress {
 public:
  /// What is over within five seconds is told or not.
  enum class Brief { told, silent };

  /// "DONE 34 of 657"; `all` is 0 where nobody knows how many there will be, and then neither the end nor the time left
  /// is told.
  explicit CountedProgress(std::string done, int all = 0, Brief brief = Brief::silent)
      : done_(std::move(done)), all_(all), brief_(brief) {}
  ~CountedProgress() { end(); }
  CountedProgress(const CountedProgress&) = delete;
  CountedProgress& operator=(const CountedProgress&) = delete;

  /// `count`: how many are done, of all.
  void tell(int count);
  /// One more is done.
  void tell_next() { tell(++count_); }
  /// Ends the line where fewer were to be done after all.
  void end();
  /// A line of its own.
  void say(const std::string& line);

 private:
  using Clock = std::chrono::steady_clock;
  std::string done_;
  int all_, count_ = 0;
  Brief brief_;
  Clock::time_point start_ = Clock::now(), told_{};
  bool drawn_ = false;
};

/// What a counted progress says: "asked 34 of 657, about 12 s left", "asked 657 of 657 in 40 s"; "asked 34" where `all`
/// is 0.
std::string count_text(const std::string& done, int count, int all, double spent_s);

}  // namespace lgabench

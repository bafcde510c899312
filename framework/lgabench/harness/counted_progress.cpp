#include <lgabench/harness/counted_progress.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <utility>

#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/forecast.hpp>

namespace lgabench {

std::string count_text(const std::string& done, int count, int all, double spent_s) {
  if (all <= 0 || count > all) return fmt::format("{} {}", done, count);
  const std::string time = count == all ? " in " + duration_text(spent_s)
                           : count == 0 ? ""
                                        : ", about " + duration_text(spent_s / count * (all - count)) + " left";
  return fmt::format("{} {} of {}{}", done, count, all, time);
}

void CountedProgress::tell(int count) {
  count_ = count;
  const auto now = Clock::now();
  const bool redrawn = ::isatty(2) != 0, last = count == all_ && all_ > 0;
  const bool first = told_ == Clock::time_point();
  const auto since = now - (first ? start_ : told_);
  const auto pause = first ? std::chrono::seconds(5) : std::chrono::seconds(redrawn ? 0 : 30);
  const bool brief = first && since < pause;
  if (brief && brief_ == Brief::silent) return;
  if (since < pause && !last && !(redrawn && brief_ == Brief::told)) return;
  told_ = now;
  drawn_ = redrawn && !last;
  const std::string text = count_text(done_, count, all_, std::chrono::duration<double>(now - start_).count());
  put(stderr, fmt::format("{}{}{}", redrawn ? "\r\x1b[K" : "", text, drawn_ ? "" : "\n"));
}

void CountedProgress::end() {
  if (std::exchange(drawn_, false)) put(stderr, "\n");
}

void CountedProgress::say(const std::string& line) {
  end();
  put(stderr, one_line(line) + "\n");
}

}  // namespace lgabench

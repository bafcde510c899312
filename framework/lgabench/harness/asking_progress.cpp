#include <lgabench/harness/asking_progress.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <utility>

#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/forecast.hpp>

namespace lgabench {

void AskingProgress::tell(int asked) {
  const auto now = Clock::now();
  const bool redrawn = ::isatty(2) != 0, last = asked == open_;
  if (!redrawn && !last && now - told_ < std::chrono::seconds(30)) return;
  told_ = now;
  const double spent_s = std::chrono::duration<double>(now - start_).count();
  const std::string left = last         ? " in " + duration_text(spent_s)
                           : asked == 0 ? ""
                                        : ", about " + duration_text(spent_s / asked * (open_ - asked)) + " left";
  drawn_ = redrawn && !last;
  put(stderr, fmt::format("{}asked {} of {}{}{}", redrawn ? "\r\x1b[K" : "", asked, open_, left, drawn_ ? "" : "\n"));
}

void AskingProgress::end() {
  if (std::exchange(drawn_, false)) put(stderr, "\n");
}

void AskingProgress::say(const std::string& line) {
  end();
  put(stderr, one_line(line) + "\n");
}

}  // namespace lgabench

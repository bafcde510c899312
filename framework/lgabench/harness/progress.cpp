#include <lgabench/harness/progress.hpp>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include <lgabench/core/colour.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string clock_text(double seconds) {
  const int s = static_cast<int>(seconds + .5);
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                  : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

std::size_t terminal_width() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20 ? size.ws_col : 80;
}

}  // namespace

Progress::Progress(std::size_t total, int jobs, std::function<double()> queued_s, bool quiet)
    : total_(total),
      jobs_(jobs),
      queued_s_(std::move(queued_s)),
      start_(std::chrono::steady_clock::now()),
      terminal_(is_terminal(stderr)),
      quiet_(quiet) {}

Progress::~Progress() { wipe(); }

void Progress::wipe() {
  if (drawn_) put(stderr, "\r\x1b[K");
  drawn_ = false;
}

void Progress::say(const std::string& line) {
  wipe();
  put(stderr, printable(line) + '\n');
}

std::string Progress::left() const {
  double work_s = queued_s_(), longest_s = 0;
  for (const auto& each : running_) {
    const double rest_s = std::max(0., each.second.expected_s - seconds_since(each.second.start));
    work_s += rest_s;
    longest_s = std::max(longest_s, rest_s);
  }
  return clock_text(std::max(work_s / jobs_, longest_s)) + " left";
}

void Progress::started(std::size_t cell, const std::string& title, double expected_s) {
  running_[cell] = {one_line(title), "start", 0, expected_s, std::chrono::steady_clock::now()};
}

void Progress::phase(std::size_t cell, const std::string& phase, long long count) {
  running_[cell].phase = phase;
  running_[cell].count = count;
}

void Progress::ended(std::size_t cell, const std::string& failure) {
  const Running it = running_[cell];
  running_.erase(cell);
  ++done_;
  if (!failure.empty()) {
    ++failed_;
    wipe();
    const std::string line = fmt::format("[{}/{}] {}: {}", done_, total_, it.title, one_line(failure));
    put(stderr, painted(stderr, Colour::red, line) + '\n');
  } else if (!terminal_ && !quiet_) {
    say(fmt::format("[{}/{}] {} {:.1f} s; {}", done_, total_, it.title, seconds_since(it.start), left()));
  }
}

void Progress::tick() {
  if (!terminal_ || quiet_ || total_ == 0) return;
  constexpr std::size_t cells = 24;
  const std::size_t full = cells * done_ / total_;
  const double elapsed = seconds_since(start_);
  std::string line = fmt::format("[{}{}] {}/{}", std::string(full, '#'), std::string(cells - full, '-'), done_, total_);
  if (failed_) line += fmt::format(", {} failed", failed_);
  line += " " + clock_text(elapsed);
  line += ", " + left();
  for (const auto& [cell, it] : running_) {
    line += " | " + it.phase;
    if (it.count) line += fmt::format(" {}", it.count);
    line += ": " + it.title;
  }
  const std::size_t width = terminal_width() - 1;
  if (line.size() > width) line = line.substr(0, width - 3) + "...";
  put(stderr, fmt::format("\r{}\x1b[K", one_line(line)));
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace lgabench

#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/progress.hpp>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

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

Progress::Progress(std::size_t total) : total_(total), start_(std::chrono::steady_clock::now()) {
  const char* kind = std::getenv("TERM");
  terminal_ = ::isatty(STDERR_FILENO) && kind && std::string(kind) != "dumb";
  const char* no_colour = std::getenv("NO_COLOR");
  colour_ = terminal_ && !(no_colour && *no_colour);
}

Progress::~Progress() { wipe(); }

void Progress::wipe() {
  if (drawn_) put(stderr, "\r\x1b[K");
  drawn_ = false;
}

void Progress::say(const std::string& line) {
  wipe();
  put(stderr, printable(line) + '\n');
}

void Progress::started(std::size_t cell, const std::string& title) {
  running_[cell] = {one_line(title), "", 0, std::chrono::steady_clock::now()};
}

void Progress::phase(std::size_t cell, const std::string& phase, long long count) {
  running_[cell].phase = phase;
  running_[cell].count = count;
}

void Progress::ended(std::size_t cell, const std::string& failure) {
  const Running& it = running_[cell];
  ++done_;
  if (!failure.empty()) {
    ++failed_;
    wipe();
    put(stderr, fmt::format("{}[{}/{}] {}: {}{}\n", colour_ ? "\x1b[31m" : "", done_, total_, it.title,
                            one_line(failure), colour_ ? "\x1b[0m" : ""));
  } else if (!terminal_) {
    say(fmt::format("[{}/{}] {} {:.1f} s", done_, total_, it.title, seconds_since(it.start)));
  }
  running_.erase(cell);
}

void Progress::tick() {
  if (!terminal_ || total_ == 0) return;
  constexpr std::size_t cells = 24;
  const std::size_t full = cells * done_ / total_;
  const double elapsed = seconds_since(start_);
  std::string line = fmt::format("[{}{}] {}/{}", std::string(full, '#'), std::string(cells - full, '-'), done_, total_);
  if (failed_) line += fmt::format(", {} failed", failed_);
  line += " " + clock_text(elapsed);
  if (done_)
    line += fmt::format(", {} left",
                        clock_text(elapsed / static_cast<double>(done_) * static_cast<double>(total_ - done_)));
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

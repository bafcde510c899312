#include <lgabench/cli/outcome.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include <lgabench/core/terminal.hpp>
#include <lgabench/report/report.hpp>
#include <lgabench/report/tables.hpp>

namespace lgabench::cli {
namespace {

std::string shell_quoted(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                          "0123456789_-+=./:,@%") == std::string::npos;
  if (plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

Words command_line() {
  const std::string bytes = read_file("/proc/self/cmdline");
  Words words;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\0', at), bytes.size());
    words.push_back(bytes.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

std::string joined(const Words& words) {
  Words quoted;
  std::transform(words.begin(), words.end(), std::back_inserter(quoted), shell_quoted);
  return fmt::format("{}", fmt::join(quoted, " "));
}

void print_report(const fs::path& run, bool json) {
  const report::Report report = report::write_report(run);
  if (json)
    to_stdout("{}", read_file(run / "summary.json"));
  else
    to_stdout("{}{}\nreport: {}\n", report::plain_text(report.run, report.summary),
              report::agreement_text(report.agreements), (run / "report.html").string());
}

}  // namespace lgabench::cli

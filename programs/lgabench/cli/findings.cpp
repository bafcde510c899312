#include <lgabench/cli/findings.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/colour.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench::cli {

bool has_problem(const CheckReport& report) {
  return std::any_of(report.findings.begin(), report.findings.end(),
                     [](const Finding& f) { return f.state == Finding::State::problem; });
}

void print(const Finding& finding) {
  const auto& [state, check, detail, fix] = finding;
  const std::string word = fmt::format("{:<8}", to_string(state));
  put(stdout, "  " + (state == Finding::State::problem ? painted(stdout, Colour::red, word) : word));
  to_stdout(" {:<22}{} {}\n", check, check.size() > 22 ? ":" : "", detail);
  if (!fix.empty()) to_stdout("           {:<22} -> {}\n", "", fix);
}

void print(const CheckReport& report, std::size_t first) {
  for (std::size_t i = first; i < report.findings.size(); ++i) print(report.findings[i]);
  const auto notes = std::count_if(report.findings.begin(), report.findings.end(),
                                   [](const Finding& f) { return f.state == Finding::State::note; });
  if (has_problem(report))
    put(stdout, painted(stdout, Colour::red, "not good: see the problems above"));
  else if (notes > 0)
    put(stdout,
        painted(stdout, Colour::yellow, fmt::format("no problem, {} note{}: see above", notes, notes == 1 ? "" : "s")));
  else
    put(stdout, painted(stdout, Colour::green, "good"));
  to_stdout("\n");
}

}  // namespace lgabench::cli

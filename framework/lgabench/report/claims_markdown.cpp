// The section of report.md on the paper's claims.
#include <fmt/format.h>

#include <algorithm>

#include <lgabench/report/claims.hpp>
#include <lgabench/report/names.hpp>
#include <lgabench/report/pairs.hpp>
#include <lgabench/report/tables.hpp>

namespace lgabench::report {
namespace {

std::string verdict_text(Verdict verdict, const std::string& reason) {
  return fmt::format("**{}**{}", to_string(verdict), reason.empty() ? "" : ": " + plain(reason));
}

// The columns that say which difference a row is of.
std::string place(const Claim& claim, const ClaimedDifference& d) {
  return fmt::format("| {} | {} | {} | {} | {} | {} − {} |", claim.id, plain(claim.layout), plain(claim.engine),
                     plain(d.arm), d.unit == "seconds" ? "" : std::to_string(d.demonstrations),
                     plain(display_name(d.above)), plain(display_name(d.below)));
}

constexpr const char* place_head = "| claim | layout | engine | arm | demonstrations | difference |";
constexpr const char* place_rule = "| --- | --- | --- | --- | ---: | --- |";

// "+0.17 [+0.10, +0.24], p = 0.003", or why there is none; the difference stands in the first of the two alone.
std::string numbers(const ClaimedDifference& d, const Tested& t, bool first) {
  if (!t.change) return plain(t.reason);
  const Change& c = *t.change;
  const bool seconds = d.unit == "seconds";
  const auto number = [seconds](double x) { return seconds ? fmt::format("{:+.1f}", x) : fmt::format("{:+.2f}", x); };
  return fmt::format("{}[{}, {}], {}", first ? number(c.difference) + (seconds ? " s " : " ") : "",
                     number(c.interval.low), number(c.interval.high), p_text(t.p_holm));
}

// A row for each difference, a column for each scenario.
std::string by_scenario(const std::vector<Claim>& claims) {
  std::vector<std::string> scenarios;
  for (const Claim& claim : claims)
    for (const ClaimedDifference& d : claim.differences)
      for (const auto& item : d.by_scenario)
        if (std::find(scenarios.begin(), scenarios.end(), item.first) == scenarios.end())
          scenarios.push_back(item.first);
  if (scenarios.empty()) return "";
  std::string text = fmt::format("\nThe same by scenario:\n\n{}", place_head), rule = place_rule;
  for (const std::string& scenario : scenarios) {
    text += fmt::format(" {} |", plain(scenario));
    rule += " ---: |";
  }
  text += '\n' + rule + '\n';
  for (const Claim& claim : claims)
    for (const ClaimedDifference& d : claim.differences) {
      if (d.by_scenario.empty()) continue;
      text += place(claim, d);
      for (const std::string& scenario : scenarios) {
        const auto found = std::find_if(d.by_scenario.begin(), d.by_scenario.end(),
                                        [&scenario](const auto& item) { return item.first == scenario; });
        text += found == d.by_scenario.end() ? " – |" : fmt::format(" {:+.2f} |", found->second);
      }
      text += '\n';
    }
  return text;
}

}  // namespace

std::string claims_markdown(const std::vector<Claim>& claims) {
  std::string text =
      "\n## The paper's claims\n\n"
      "| claim | | layout | engine | these scenarios | scenarios like these |\n"
      "| --- | --- | --- | --- | --- | --- |\n";
  std::string details;
  for (const Claim& claim : claims) {
    text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", claim.id, claim.statement, plain(claim.layout),
                        plain(claim.engine), verdict_text(claim.verdict, claim.reason),
                        claim.differences.empty() ? "" : verdict_text(claim.alike, claim.reason_alike));
    for (const ClaimedDifference& d : claim.differences)
      if (d.these.change)
        details += fmt::format("{} {} | {} | {} | {} | {} |\n", place(claim, d), numbers(d, d.these, true),
                               to_string(d.these.verdict), numbers(d, d.alike, false),
                               d.alike.change ? to_string(d.alike.verdict) : "", sample_text(d));
  }
  if (details.empty()) return text;
  return text +
         fmt::format(
             "\nA claim's verdict is that on these scenarios: would other test scenes and training seeds of theirs say "
             "the same? Beside it stands the harder question, whether other scenarios like these would: Student's t "
             "over their differences. Each difference is on the mean over scenarios, paired by training seed, "
             "participant and scene; brackets hold 95 % intervals, p is Holm's over the rows compared in one arm at "
             "one number of demonstrations, for each of the two by itself.\n\n"
             "{} these scenarios | | scenarios like these | | based on |\n{} --- | --- | --- | --- | --- |\n{}",
             place_head, place_rule, details) +
         by_scenario(claims);
}

}  // namespace lgabench::report

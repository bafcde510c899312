#include <fmt/format.h>

#include <lgabench/report/claims.hpp>
#include <lgabench/report/names.hpp>
#include <lgabench/report/pairs.hpp>
#include <lgabench/report/tables.hpp>

namespace lgabench::report {
namespace {

// "LGA − GCBC-DART"
std::string rows_text(const ClaimedDifference& d) {
  return fmt::format("{} − {}", display_name(d.above), display_name(d.below));
}

// Seconds do not depend on demonstrations.
std::string demonstrations_text(const ClaimedDifference& d, const char* prefix) {
  return d.unit == "seconds" ? "" : fmt::format("{}{}", prefix, d.demonstrations);
}

std::string counted(int n, const char* one, const char* more) { return fmt::format("{} {}", n, n == 1 ? one : more); }

std::string with_reason(Verdict verdict, const std::string& reason) {
  return reason.empty() ? to_string(verdict) : fmt::format("{}: {}", to_string(verdict), reason);
}

}  // namespace

std::string sample_text(const ClaimedDifference& d) {
  std::vector<std::string> parts;
  if (d.participants > 0) parts.push_back(counted(d.participants, "participant", "participants"));
  if (d.policies > 0) parts.push_back(counted(d.policies, "policy", "policies"));
  parts.push_back(counted(d.scenarios, "scenario", "scenarios"));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string claimed_text(const ClaimedDifference& d) {
  return d.unit == "seconds" ? fmt::format("{:+.1f} s [{:+.1f}, {:+.1f}]", d.change->difference, d.change->interval.low,
                                           d.change->interval.high)
                             : change_text(*d.change);
}

Json to_json(const std::string& suite, const std::vector<Claim>& claims) {
  Json all = Json::array();
  for (const Claim& claim : claims) {
    Json differences = Json::array();
    for (const ClaimedDifference& d : claim.differences) {
      const auto number = [&d](double value) { return d.change ? Json(value) : Json(nullptr); };
      const Change change = d.change.value_or(Change());
      differences.push_back({{"above", d.above},
                             {"below", d.below},
                             {"arm", d.arm},
                             {"unit", d.unit},
                             {"demonstrations", d.demonstrations},
                             {"verdict", to_string(d.verdict)},
                             {"reason", d.reason},
                             {"difference", number(change.difference)},
                             {"low", number(change.interval.low)},
                             {"high", number(change.interval.high)},
                             {"p", number(change.p)},
                             {"p_holm", number(d.p_holm)},
                             {"scenarios", d.scenarios},
                             {"policies", d.policies},
                             {"participants", d.participants}});
    }
    all.push_back({{"claim", claim.id},
                   {"statement", claim.statement},
                   {"layout", claim.layout},
                   {"engine", claim.engine},
                   {"verdict", to_string(claim.verdict)},
                   {"reason", claim.reason},
                   {"differences", differences}});
  }
  return {{"suite", suite}, {"claims", all}};
}

std::string claims_text(const std::string& suite, const std::vector<Claim>& claims) {
  std::string text, field;
  for (const Claim& claim : claims) {
    const std::string here =
        fmt::format("{}, layout {}, engine {}: the paper's claims\n\n", suite, claim.layout, claim.engine);
    if (here != field) text += (text.empty() ? "" : "\n") + here;
    field = here;
    text += fmt::format("{}  {}\n      {}\n", claim.id, claim.statement, with_reason(claim.verdict, claim.reason));
    for (const ClaimedDifference& d : claim.differences) {
      text += fmt::format("      {:<10}  {:<6} {:<10} {}", to_string(d.verdict), demonstrations_text(d, "n="), d.arm,
                          rows_text(d));
      text += d.change ? fmt::format("  {}  {} (Holm)  {}\n", claimed_text(d), p_text(d.p_holm), sample_text(d))
                       : fmt::format("  {}\n", d.reason);
    }
  }
  return text;
}

std::string claims_markdown(const std::vector<Claim>& claims) {
  std::string text =
      "\n## The paper's claims\n\n"
      "| claim | | layout | engine | verdict |\n| --- | --- | --- | --- | --- |\n";
  std::string details;
  for (const Claim& claim : claims) {
    text += fmt::format("| {} | {} | {} | {} | **{}**{} |\n", claim.id, claim.statement, plain(claim.layout),
                        plain(claim.engine), to_string(claim.verdict),
                        claim.reason.empty() ? "" : ": " + plain(claim.reason));
    for (const ClaimedDifference& d : claim.differences)
      if (d.change)
        details += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", claim.id, plain(claim.layout),
                               plain(claim.engine), plain(d.arm), demonstrations_text(d, ""), plain(rows_text(d)),
                               claimed_text(d), p_text(d.p_holm), sample_text(d), to_string(d.verdict));
  }
  if (details.empty()) return text;
  return text +
         "\nEach difference, on the mean over scenarios, paired by training seed, participant and scene; p is Holm's "
         "over the rows "
         "compared in one arm at one number of demonstrations.\n\n"
         "| claim | layout | engine | arm | demonstrations | difference | | | from | verdict |\n"
         "| --- | --- | --- | --- | ---: | --- | --- | --- | --- | --- |\n" +
         details;
}

}  // namespace lgabench::report

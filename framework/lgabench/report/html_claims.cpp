// The section of report.html on the paper's claims. Its numbers carry the JSON pointer to their place in claims.json.
#include <fmt/format.h>

#include <lgabench/report/html_parts.hpp>
#include <lgabench/report/names.hpp>
#include <lgabench/report/pairs.hpp>

namespace lgabench::report::html_parts {
namespace {

std::string verdict(Verdict verdict) {
  return verdict == Verdict::not_tested ? to_string(verdict) : fmt::format("<b>{}</b>", to_string(verdict));
}

std::string with_reason(Verdict is, const std::string& reason) {
  return verdict(is) + (reason.empty() ? "" : ": " + escaped(reason));
}

// The cells of a difference; `place`: its JSON pointer.
std::string difference_row(const Claim& claim, const ClaimedDifference& d, const std::string& place) {
  const auto value = [&place](const char* member, const std::string& text) {
    return fmt::format("<span data-claim=\"{}/{}\">{}</span>", place, member, text);
  };
  const bool seconds = d.unit == "seconds";
  const auto number = [&](const char* member, double x) {
    return value(member, seconds ? fmt::format("{:+.1f}", x) : fmt::format("{:+.2f}", x));
  };
  std::string measured, p;
  if (d.change) {
    measured =
        fmt::format("{} [{}, {}]{}", number("difference", d.change->difference), number("low", d.change->interval.low),
                    number("high", d.change->interval.high), seconds ? " s" : "");
    p = d.p_holm < .001 ? "&lt; 0.001" : value("p_holm", fmt::format("{:.3f}", d.p_holm));
  }
  return row_of({claim.id, fmt::format("{} − {}", named(d.above), named(d.below)), escaped(d.arm),
                 seconds ? "" : value("demonstrations", std::to_string(d.demonstrations)), measured, p,
                 value("participants", std::to_string(d.participants)), value("policies", std::to_string(d.policies)),
                 value("scenarios", std::to_string(d.scenarios)), with_reason(d.verdict, d.reason)},
                2);
}

}  // namespace

std::string claims(const std::vector<Claim>& all) {
  std::string summary, details;
  for (std::size_t c = 0; c < all.size(); ++c) {
    const Claim& claim = all[c];
    summary += row_of({claim.id, escaped(claim.statement), escaped(claim.layout + ", " + claim.engine),
                       with_reason(claim.verdict, claim.reason)},
                      3);
    for (std::size_t d = 0; d < claim.differences.size(); ++d)
      details += difference_row(claim, claim.differences[d], fmt::format("/claims/{}/differences/{}", c, d));
  }
  if (summary.empty()) return "";
  std::string text = table("The paper’s claims", {"claim", "", "layout, engine", "verdict"}, summary);
  if (!details.empty())
    text += "<details><summary>Each difference behind them</summary>" +
            table("Differences on the mean over scenarios, paired by training seed, participant and scene; p is Holm’s",
                  {"claim", "difference", "arm", "demon&shy;strations", "95 % interval", "p", "participants",
                   "policies", "scenarios", "verdict"},
                  details, true) +
            "</details>";
  return section("claims", "The paper’s claims", text);
}

}  // namespace lgabench::report::html_parts

// The section of report.html on the paper's claims. Its numbers carry the JSON pointer to their place in claims.json.
#include <fmt/format.h>

#include <utility>

#include <lgabench/report/html_parts.hpp>
#include <lgabench/report/names.hpp>

namespace lgabench::report::html_parts {
namespace {

std::string verdict(Verdict verdict) {
  return verdict == Verdict::not_tested ? to_string(verdict) : fmt::format("<b>{}</b>", to_string(verdict));
}

std::string with_reason(Verdict is, const std::string& reason) {
  return verdict(is) + (reason.empty() ? "" : ": " + escaped(reason));
}

// The parts of a row that show members of a difference; `place`: its JSON pointer.
class Numbers {
 public:
  Numbers(const ClaimedDifference& d, std::string place) : seconds_(d.unit == "seconds"), place_(std::move(place)) {}

  std::string value(const std::string& member, const std::string& text) const {
    return fmt::format("<span data-claim=\"{}/{}\">{}</span>", place_, member, text);
  }
  std::string count(const char* member, int n) const { return value(member, std::to_string(n)); }
  std::string number(const std::string& member, double x) const {
    return value(member, seconds_ ? fmt::format("{:+.1f}", x) : fmt::format("{:+.2f}", x));
  }
  // Interval, p and verdict of a test.
  std::vector<std::string> test(const std::string& member, const Tested& t) const {
    if (!t.change) return {"", "", with_reason(t.verdict, t.reason)};
    const Interval& i = t.change->interval;
    return {fmt::format("[{}, {}]{}", number(member + "/low", i.low), number(member + "/high", i.high),
                        seconds_ ? " s" : ""),
            t.p_holm < .001 ? "&lt; 0.001" : value(member + "/p_holm", fmt::format("{:.3f}", t.p_holm)),
            with_reason(t.verdict, t.reason)};
  }

 private:
  bool seconds_;
  std::string place_;
};

std::string difference_row(const Claim& claim, const ClaimedDifference& d, const std::string& place) {
  const Numbers numbers(d, place);
  std::vector<std::string> cells{claim.id, fmt::format("{} − {}", named(d.above), named(d.below)), escaped(d.arm),
                                 d.unit == "seconds" ? "" : numbers.count("demonstrations", d.demonstrations),
                                 d.these.change ? numbers.number("difference", d.these.change->difference) : ""};
  for (const auto& [member, tested] : {std::pair("these_scenarios", &d.these), {"scenarios_like_these", &d.alike}})
    for (std::string& cell : numbers.test(member, *tested)) cells.push_back(std::move(cell));
  for (const auto& [member, n] : {std::pair("participants", d.participants),
                                  {"policies", d.policies},
                                  {"scenarios", d.scenarios},
                                  {"scenes", d.scenes}})
    cells.push_back(numbers.count(member, n));
  if (d.seeds == 1) cells.back() += " <small>for this training seed</small>";
  return row_of(cells, 2);
}

// A dot for each scenario's difference between -1 and 1, and a mark for their mean.
std::string strip(const ClaimedDifference& d) {
  constexpr double width = 240, height = 18, middle = width / 2, scale = middle - 6;
  const std::string title = fmt::format("{} − {}, {}{} demonstrations", display_name(d.above), display_name(d.below),
                                        d.arm.empty() ? "" : d.arm + ", ", d.demonstrations);
  std::string picture = fmt::format("<path class=zero d=\"M{0} 1V{1}\"/><path class=mean d=\"M{2:.1f} 3V{3}\"/>",
                                    middle, height - 1, middle + scale * d.these.change->difference, height - 3);
  for (const auto& [scenario, difference] : d.by_scenario)
    picture += fmt::format(
        "<g tabindex=0 role=img aria-label=\"{0} {1:+.2f}\"><circle cx={2:.1f} cy={3} r=4 "
        "/></g>",
        escaped(scenario), difference, middle + scale * difference, height / 2);
  return fmt::format(
      "<figure class=strip><svg viewBox=\"0 0 {} {}\" role=group aria-label=\"difference by scenario, "
      "{}\">{}</svg><figcaption>{}</figcaption></figure>",
      width, height, escaped(title), picture, escaped(title));
}

}  // namespace

std::string claims(const std::vector<Claim>& all) {
  std::string summary, details;
  for (std::size_t c = 0; c < all.size(); ++c) {
    const Claim& claim = all[c];
    std::string strips;
    for (std::size_t d = 0; d < claim.differences.size(); ++d) {
      const ClaimedDifference& difference = claim.differences[d];
      if (!difference.by_scenario.empty()) strips += strip(difference);
      details += difference_row(claim, difference, fmt::format("/claims/{}/differences/{}", c, d));
    }
    summary += row_of({claim.id, escaped(claim.statement), escaped(claim.layout + ", " + claim.engine),
                       with_reason(claim.verdict, claim.reason),
                       claim.differences.empty() ? "" : with_reason(claim.alike, claim.reason_alike), strips},
                      3);
  }
  if (summary.empty()) return "";
  std::string text =
      "<p class=hint>A claim’s verdict is that on these scenarios: would other test scenes and training seeds of "
      "theirs "
      "say the same? Beside it stands the harder question, whether other scenarios like these would. Strips: a dot "
      "for each scenario’s difference, from −1 on the left over 0 to 1; the bar is their mean.</p>" +
      table("The paper’s claims",
            {"claim", "", "layout, engine", "these scenarios", "scenarios like these", "differences by scenario"},
            summary);
  if (!details.empty())
    text += "<details><summary>Each difference behind them</summary>" +
            table(
                "Differences on the mean over scenarios, paired by training seed, participant and scene; p is Holm’s, "
                "for each test by itself",
                {"claim", "difference", "arm", "demon&shy;strations", "difference", "these scenarios: 95 % interval",
                 "p", "verdict", "scenarios like these: 95 % interval", "p", "verdict", "participants", "policies",
                 "scenarios", "scenes"},
                details, true) +
            "</details>";
  return section("claims", "The paper’s claims", text);
}

}  // namespace lgabench::report::html_parts

// The paper's claims, and the differences behind them. Numbers carry the JSON pointer to their place in claims.json.
#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/contains.hpp>
#include <lgabench/document/document.hpp>
#include <lgabench/report/sections.hpp>
#include <lgabench/statistics/pairs.hpp>

namespace lgabench::report {
namespace {

TableCell verdict_cell(Verdict verdict, const std::string& reason, bool rehearsal) {
  TableCell cell(Span(to_string(verdict), Emphasis::strong));
  if (rehearsal) cell.spans.emplace_back(fmt::format(" ({})", rehearsal_words));
  if (!reason.empty()) cell.spans.emplace_back(": " + reason);
  return cell;
}

// A difference, with its JSON pointer.
struct Placed {
  const Claim& claim;
  const ClaimedDifference& difference;
  std::string place;
};

bool is_slope(const ClaimedDifference& d) {
  return d.unit != "success" && d.unit != paired_unit && d.unit != "seconds";
}

// A row, with the columns that say which difference it is of.
void add_row(Grid& grid, const MethodStyles& styles, const AboutSuite& about, const Placed& of) {
  const ClaimedDifference& d = of.difference;
  grid.rows.emplace_back();
  put(grid, "claim", 'l', of.claim.id);
  put(grid, "layout", 'l', of.claim.layout);
  put(grid, "engine", 'l', of.claim.engine);
  put(grid, "arm", 'l', about.arm_title(d.arm));
  put(grid, "demonstrations", 'r',
      d.unit == "seconds" ? TableCell()
                          : TableCell(Span::number(std::to_string(d.demonstrations), of.place + "/demonstrations")));
  put(grid, "difference", 'l',
      styles.name(d.above) + " − " + styles.name(d.below) +
          (is_slope(d) || d.unit == paired_unit ? ", " + d.unit : ""));
  grid.rows.back().cells.back().style = styles(d.above);
}

// "+0.17 [+0.10, +0.24], p = 0.003", or why there is none; the difference stands in the first of the two alone.
TableCell test_cell(const Placed& of, const Tested& t, const std::string& member, bool first) {
  if (!t.change) return t.reason;
  const Change& c = *t.change;
  const bool seconds = of.difference.unit == "seconds";
  const auto number = [&](double x, const std::string& where) {
    return Span::number(signed_text(x, seconds ? 1 : is_slope(of.difference) ? 3 : 2), of.place + where);
  };
  Spans spans;
  if (first) {
    spans.push_back(number(c.difference, "/difference"));
    spans.push_back(Span::number(seconds ? " s " : " "));
  }
  spans.push_back(Span::number("["));
  spans.push_back(number(c.interval.low, member + "/low"));
  spans.push_back(Span::number(", "));
  spans.push_back(number(c.interval.high, member + "/high"));
  if (t.p_holm < .001) {
    spans.push_back(Span::number("], p < 0.001"));
  } else {
    spans.push_back(Span::number("], p = "));
    spans.push_back(Span::number(fixed(t.p_holm, 3), of.place + member + "/p_holm"));
  }
  return spans;
}

// "6 policies, 2 scenarios, 40 scenes", and "for this training seed" where there is one.
TableCell sample_cell(const Placed& of) {
  const ClaimedDifference& d = of.difference;
  TableCell cell;
  const auto add = [&](const char* member, int n, const char* one) {
    if (n == 0) return;
    if (!cell.spans.empty()) cell.spans.emplace_back(", ");
    cell.spans.push_back(Span::number(std::to_string(n), of.place + "/" + member));
    cell.spans.emplace_back(std::string(" ") + (n == 1 ? one : member));
  };
  add("participants", d.participants, "participant");
  add("policies", d.policies, "policy");
  add("scenarios", d.scenarios, "scenario");
  add("scenes", d.scenes, "scene");
  if (d.seeds == 1) cell.spans.emplace_back(", for this training seed");
  return cell;
}

TableCell reason_cell(const Claim& claim) {
  if (claim.needs.empty()) return claim.reason;
  return Spans{"needs a run of suite ", Span(claim.needs, Emphasis::code)};
}

// A column for each scenario.
Grid by_scenario(const MethodStyles& styles, const AboutSuite& about, const std::vector<Placed>& all) {
  std::vector<std::string> scenarios;
  for (const Placed& of : all)
    for (const auto& item : of.difference.by_scenario)
      if (!contains(scenarios, item.first)) scenarios.push_back(item.first);
  Grid grid;
  grid.name = "claims_scenarios";
  grid.caption = "The differences by scenario";
  for (const Placed& of : all) {
    const auto& values = of.difference.by_scenario;
    if (values.empty()) continue;
    add_row(grid, styles, about, of);
    for (const std::string& scenario : scenarios) {
      const auto found =
          std::find_if(values.begin(), values.end(), [&scenario](const auto& item) { return item.first == scenario; });
      put(grid, scenario, 'r',
          found == values.end()
              ? Span::number("–")
              : Span::number(signed_text(found->second),
                             fmt::format("{}/by_scenario/{}/difference", of.place, found - values.begin())));
    }
  }
  return grid;
}

Grid details(const MethodStyles& styles, const AboutSuite& about, const std::vector<Placed>& all) {
  Grid grid;
  grid.name = "claims_differences";
  grid.caption = "The differences behind the claims";
  for (const Placed& of : all) {
    const ClaimedDifference& d = of.difference;
    add_row(grid, styles, about, of);
    put(grid, "these scenarios", 'l', test_cell(of, d.these, "/these_scenarios", true));
    put(grid, "verdict", 'l', to_string(d.these.verdict));
    put(grid, "scenarios like these", 'l', test_cell(of, d.alike, "/scenarios_like_these", false));
    put(grid, "verdict on those", 'l', d.alike.change ? to_string(d.alike.verdict) : "");
    put(grid, "based on", 'l', d.these.change ? sample_cell(of) : TableCell());
  }
  return grid;
}

std::string with_reason(Verdict verdict, const std::string& reason, bool rehearsal) {
  return verdict_cell(verdict, reason, rehearsal).text();
}

}  // namespace

Section claims_section(const std::vector<Claim>& claims, const MethodStyles& styles, const std::string& title,
                       const AboutSuite& about) {
  Section section{"claims", title, reading};
  if (claims.empty()) return section;
  Grid verdicts, untested;
  verdicts.name = "claims";
  verdicts.caption = "Verdicts";
  const bool of_suite = !claims.front().refuted_if.empty();
  untested.name = "claims_not_tested";
  untested.caption = "Claims that this run does not test";
  untested.heads = {"claim", "statement", "layout", "engine", "why"};
  untested.align = "lllll";
  List lines;
  std::vector<Placed> all, tested;
  for (std::size_t c = 0; c < claims.size(); ++c) {
    const Claim& claim = claims[c];
    if (claim.verdict == Verdict::not_tested) {
      untested.rows.push_back({{}, {claim.id, claim.statement, claim.layout, claim.engine, reason_cell(claim)}});
    } else {
      verdicts.rows.emplace_back();
      put(verdicts, "claim", 'l', claim.id);
      put(verdicts, "statement", 'l', claim.statement);
      if (of_suite) put(verdicts, "refuted if", 'l', claim.refuted_if);
      put(verdicts, "layout", 'l', claim.layout);
      put(verdicts, "engine", 'l', claim.engine);
      put(verdicts, "these scenarios", 'l', verdict_cell(claim.verdict, claim.reason, claim.rehearsal));
      put(verdicts, "scenarios like these", 'l', verdict_cell(claim.alike, claim.reason_alike, claim.rehearsal));
    }
    lines.items.push_back(
        {fmt::format("{}  {} (layout {}, engine {})", claim.id, claim.statement, claim.layout, claim.engine)});
    if (of_suite) lines.items.push_back({"      refuted if " + claim.refuted_if});
    lines.items.push_back({"      these scenarios: " + with_reason(claim.verdict, claim.reason, claim.rehearsal)});
    if (!claim.differences.empty())
      lines.items.push_back(
          {"      scenarios like these: " + with_reason(claim.alike, claim.reason_alike, claim.rehearsal)});
    for (std::size_t d = 0; d < claim.differences.size(); ++d) {
      all.push_back({claim, claim.differences[d], fmt::format("/claims/{}/differences/{}", c, d)});
      if (claim.differences[d].these.change) tested.push_back(all.back());
    }
  }
  section.add_brief(std::move(lines));
  if (!all.empty()) section.add_brief(details(styles, about, all));
  if (!verdicts.rows.empty()) section.add(reading, std::move(verdicts));
  const bool folds = !tested.empty() || untested.rows.size() > 1;
  const std::string caption = untested.caption;
  if (!untested.rows.empty()) section.add(reading, std::move(untested), folds ? caption : "");
  if (tested.empty()) return section;

  section.add(
      reading,
      Paragraph{{"“These scenarios”: would new test scenes and training seeds give the same verdict? “Scenarios like "
                 "these”: would new scenarios (Student's t over the scenarios' differences; six are needed)? Each "
                 "difference is that of the mean over scenarios, "
                 "paired by training seed, participant and scene; brackets hold 95 % intervals, p is Holm's over " +
                 std::string(of_suite ? "all differences of the suite's claims on one layout and engine"
                                      : "the rows compared in one arm at one number of demonstrations") +
                 ", for each of the two by itself."}});
  section.add(reading, details(styles, about, tested));
  Grid scenarios = by_scenario(styles, about, tested);
  if (scenarios.rows.empty()) return section;
  section.add(reading, std::move(scenarios), "The same by scenario", "The same by scenario:");
  return section;
}

}  // namespace lgabench::report

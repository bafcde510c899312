#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

// "+0.90 [+0.80, +0.97]", "+100.1 s [+90.0, +110.2]".
std::string change_of(const ClaimedDifference& d, const Change& change) {
  return d.unit == "seconds"
             ? fmt::format("{:+.1f} s [{:+.1f}, {:+.1f}]", change.difference, change.interval.low, change.interval.high)
             : change_text(change);
}

// What a test says, with its numbers or why it has none.
std::string tested_text(const ClaimedDifference& d, const Tested& t) {
  return t.change ? fmt::format("{}, {} (Holm)", change_of(d, *t.change), p_text(t.p_holm)) : t.reason;
}

// A place for each scenario between -1 and 1, the number of scenarios where several share one: "-1 [    |  2 1 ] +1".
std::string dots(const std::vector<std::pair<std::string, double>>& by_scenario) {
  constexpr int half = 20;
  std::vector<int> places(2 * half + 1);
  for (const auto& item : by_scenario) ++places[static_cast<std::size_t>(half + std::lround(item.second * half))];
  std::string text = "-1 [";
  for (std::size_t i = 0; i < places.size(); ++i)
    text += places[i] > 9 ? "#" : places[i] > 0 ? std::to_string(places[i]) : i == half ? "|" : ".";
  return text + "] +1";
}

std::string strip_text(const ClaimedDifference& d) {
  const auto [least, most] = std::minmax_element(d.by_scenario.begin(), d.by_scenario.end(),
                                                 [](const auto& a, const auto& b) { return a.second < b.second; });
  return fmt::format("{}  {} {:+.2f}{}", dots(d.by_scenario), least->first, least->second,
                     d.by_scenario.size() > 1 ? fmt::format(" to {} {:+.2f}", most->first, most->second) : "");
}

Json test_json(const Tested& t) {
  const auto number = [&t](double value) { return t.change ? Json(value) : Json(nullptr); };
  const Change change = t.change.value_or(Change());
  return {{"verdict", to_string(t.verdict)},      {"reason", t.reason},    {"low", number(change.interval.low)},
          {"high", number(change.interval.high)}, {"p", number(change.p)}, {"p_holm", number(t.p_holm)}};
}

}  // namespace

std::string sample_text(const ClaimedDifference& d) {
  std::vector<std::string> parts;
  if (d.participants > 0) parts.push_back(counted(d.participants, "participant", "participants"));
  if (d.policies > 0) parts.push_back(counted(d.policies, "policy", "policies"));
  parts.push_back(counted(d.scenarios, "scenario", "scenarios"));
  if (d.scenes > 0) parts.push_back(counted(d.scenes, "scene", "scenes"));
  return fmt::format("{}{}", fmt::join(parts, ", "), d.seeds == 1 ? ", for this training seed" : "");
}

Json to_json(const std::string& suite, const std::vector<Claim>& claims) {
  Json all = Json::array();
  for (const Claim& claim : claims) {
    Json differences = Json::array();
    for (const ClaimedDifference& d : claim.differences) {
      Json by_scenario = Json::array();
      for (const auto& [scenario, difference] : d.by_scenario)
        by_scenario.push_back({{"scenario", scenario}, {"difference", difference}});
      differences.push_back({{"above", d.above},
                             {"below", d.below},
                             {"arm", d.arm},
                             {"unit", d.unit},
                             {"demonstrations", d.demonstrations},
                             {"difference", d.these.change ? Json(d.these.change->difference) : Json()},
                             {"these_scenarios", test_json(d.these)},
                             {"scenarios_like_these", test_json(d.alike)},
                             {"by_scenario", by_scenario},
                             {"scenarios", d.scenarios},
                             {"scenes", d.scenes},
                             {"seeds", d.seeds},
                             {"policies", d.policies},
                             {"participants", d.participants}});
    }
    all.push_back({{"claim", claim.id},
                   {"statement", claim.statement},
                   {"layout", claim.layout},
                   {"engine", claim.engine},
                   {"verdict", to_string(claim.verdict)},
                   {"reason", claim.reason},
                   {"scenarios_like_these", {{"verdict", to_string(claim.alike)}, {"reason", claim.reason_alike}}},
                   {"differences", differences}});
  }
  return {{"suite", suite}, {"claims", all}};
}

std::string claims_text(const std::string& suite, const std::vector<Claim>& claims, const std::string& title) {
  std::string text, field;
  for (const Claim& claim : claims) {
    const std::string here = fmt::format("{}, layout {}, engine {}: {}\n\n", suite, claim.layout, claim.engine, title);
    if (here != field) text += (text.empty() ? "" : "\n") + here;
    field = here;
    text += fmt::format("{}  {}\n      these scenarios: {}\n", claim.id, claim.statement,
                        with_reason(claim.verdict, claim.reason));
    if (!claim.differences.empty())
      text += fmt::format("      scenarios like these: {}\n", with_reason(claim.alike, claim.reason_alike));
    for (const ClaimedDifference& d : claim.differences) {
      text += fmt::format("      {:<10}  {:<6} {:<10} {}  {}", to_string(d.these.verdict), demonstrations_text(d, "n="),
                          d.arm, rows_text(d), tested_text(d, d.these));
      if (!d.these.change) {
        text += '\n';
        continue;
      }
      text += fmt::format("  {}\n", sample_text(d));
      if (d.unit == "seconds") continue;
      text += fmt::format(
          "        scenarios like these: {}\n        by scenario: {}\n",
          d.alike.change ? fmt::format("{}  {}", to_string(d.alike.verdict), tested_text(d, d.alike)) : d.alike.reason,
          strip_text(d));
    }
  }
  return text;
}

}  // namespace lgabench::report

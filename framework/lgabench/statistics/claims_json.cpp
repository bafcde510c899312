// claims.json.
#include <lgabench/statistics/claims.hpp>

namespace lgabench::statistics {
namespace {

Json test_json(const Tested& t) {
  const auto number = [&t](double value) { return t.change ? Json(value) : Json(nullptr); };
  const Change change = t.change.value_or(Change());
  return {{"verdict", to_string(t.verdict)},      {"reason", t.reason},    {"low", number(change.interval.low)},
          {"high", number(change.interval.high)}, {"p", number(change.p)}, {"p_holm", number(t.p_holm)}};
}

}  // namespace

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
    if (!claim.refuted_if.empty()) all.back()["refuted_if"] = claim.refuted_if;
    if (claim.rehearsal) all.back()["rehearsal"] = true;
  }
  return {{"suite", suite}, {"claims", all}};
}

}  // namespace lgabench::statistics

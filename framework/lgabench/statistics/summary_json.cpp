#include <fmt/format.h>

#include <lgabench/core/environments.hpp>
#include <lgabench/statistics/summary.hpp>

namespace lgabench::statistics {
namespace {

Json shift_json(const std::optional<Shift>& shift) {
  if (!shift) return nullptr;
  Json json{{"against", shift->against},
            {"difference", shift->difference},
            {"low", shift->interval.low},
            {"high", shift->interval.high},
            {"same_actions", shift->same_actions}};
  if (shift->selected_otherwise) json["selected_otherwise"] = *shift->selected_otherwise;
  return json;
}

Json phi_json(const std::vector<PhiOfCommand>& phi) {
  Json all;  // null where nothing was selected
  for (const PhiOfCommand& one : phi) all.push_back(to_json(one));
  return all;
}

}  // namespace

Json to_json(const PhiOfCommand& phi) {
  return {{"utterance", phi.utterance},
          {"seen", phi.seen},
          {"provenance", phi.provenance},
          {"source", phi.source},
          {"asked_as", phi.asked_as},
          {"lm_queries", phi.lm_queries ? count_json(*phi.lm_queries) : Json()},
          {"human_seconds", phi.human_seconds ? Json(*phi.human_seconds) : Json()},
          {"quality", to_json(phi.quality)}};
}

Json to_json(const Summary& summary) {
  Json rows = Json::array(), failed = Json::array();
  for (const Table& table : summary.tables)
    for (const Row& row : table.rows)
      rows.push_back({{"scenario", row.scenario},
                      {"layout", row.layout},
                      {"engine", row.engine},
                      {"method", row.method},
                      {"method_kind", row.kind},
                      {"demonstrations", row.demonstrations},
                      {"arm", row.arm},
                      {"seeds", row.seeds},
                      {"participants", row.participants},
                      {"scenes", row.scenes},
                      {"episodes", row.episodes},
                      {"successes", row.successes},
                      {"success", row.success ? Json(*row.success) : Json()},
                      {"low", row.success ? Json(row.interval.low) : Json()},
                      {"high", row.success ? Json(row.interval.high) : Json()},
                      {"shift", shift_json(row.shift)},
                      {"failures", row.failures},
                      {"attribution", row.attribution},
                      {"inputs_seen", row.seen_share() ? Json(*row.seen_share()) : Json()},
                      {"n_error", row.n_error},
                      {"marks", row.marks},
                      {"phi", phi_json(row.phi)}});
  for (const CellResult& cell : summary.failed)
    failed.push_back({{"cell", cell.key}, {"fault", cell.fault}, {"reason", cell.reason}});
  Json nearness = Json::array();
  for (const Table& table : summary.tables)
    if (const auto& near = table.nearness)
      nearness.push_back({{"layout", table.layout},
                          {"engine", table.engine},
                          {"points", near->points},
                          {"near", near->near},
                          {"mean_distance", near->mean_distance}});
  Json json{{"suite", summary.suite}, {"rows", rows}, {"failed_cells", failed}, {"near_paper", nearness}};
  for (const ErrorCurve& curve : summary.error_curves) json["error_curves"].push_back(to_json(curve));
  for (const PerturbationCurve& curve : summary.perturbations) json["perturbations"].push_back(to_json(curve));
  for (const Steps& steps : summary.steps) json["steps"].push_back(to_json(steps));
  for (const Regret& regret : summary.regrets) json["regret"].push_back(to_json(regret));
  return json;
}

}  // namespace lgabench::statistics

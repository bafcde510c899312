#include <fmt/format.h>

#include <lgabench/core/environments.hpp>
#include <lgabench/report/curves.hpp>
#include <lgabench/report/summary.hpp>
#include <lgabench/report/writers.hpp>

namespace lgabench::report {
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

std::string to_csv(const Summary& summary) {
  std::vector<std::pair<std::string, Json::json_pointer>> columns;
  const auto add = [&columns](const std::string& name, const std::string& place) {
    columns.emplace_back(name, Json::json_pointer("/" + place));
  };
  for (const char* member : {"scenario", "layout", "engine", "method", "method_kind", "demonstrations", "arm", "seeds",
                             "participants", "scenes", "episodes", "successes", "success", "low", "high"})
    add(member, member);
  add("against", "shift/against");
  for (const char* member : {"difference", "low", "high"})
    add(member == std::string("difference") ? member : fmt::format("difference_{}", member),
        fmt::format("shift/{}", member));
  add("same_actions", "shift/same_actions");
  for (const char* member : {"inputs_seen", "n_error", "marks"}) add(member, member);
  for (const char* to : attributions) add(to, fmt::format("attribution/{}", to));
  for (const std::string& word : failure_words()) add(word, "failures/" + word);

  std::vector<std::string> names;
  for (const auto& column : columns) names.push_back(column.first);
  std::string csv = csv_line(names);
  const Json all = to_json(summary);
  for (const Json& row : all.at("rows")) {
    std::vector<std::string> values;
    for (const auto& [name, place] : columns) {
      const std::string of = place.parent_pointer().to_string();
      const bool counts = of == "/failures" || of == "/attribution";
      values.push_back(row.contains(place) ? csv_text(row.at(place)) : counts ? "0" : "");
    }
    csv += csv_line(values);
  }
  return csv;
}

std::string episodes_csv(const RunResults& run) {
  std::string csv =
      csv_line({"cell", "scenario", "layout", "engine", "method", "method_kind", "demonstrations", "training_seed",
                "participant", "arm", "index", "command", "scene", "success", "failure", "attribution", "input_seen"});
  for (const CellResult& cell : run.cells)
    for (const auto& [arm, episodes] : cell.episodes)
      for (std::size_t i = 0; i < episodes.size(); ++i) {
        const Episode& e = episodes[i];
        csv += csv_line({cell.key, cell.scenario, cell.layout, cell.engine, cell.method, cell.kind,
                         std::to_string(cell.demonstrations), std::to_string(cell.training_seed), cell.participant, arm,
                         std::to_string(i), cell.commands[e.command].utterance, e.scene, e.success() ? "true" : "false",
                         e.failure, e.attribution, e.input_seen ? (*e.input_seen ? "true" : "false") : ""});
      }
  return csv;
}

}  // namespace lgabench::report

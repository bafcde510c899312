#include <fmt/format.h>

#include <lgabench/core/environments.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/report/summary.hpp>

namespace lgabench::report {
namespace {

Json shift_json(const std::optional<Shift>& shift) {
  if (!shift) return nullptr;
  return {{"against", shift->against},
          {"difference", shift->difference},
          {"low", shift->interval.low},
          {"high", shift->interval.high},
          {"same_actions", shift->same_actions}};
}

}  // namespace

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
                      {"phi", row.phi}});
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
  return {{"suite", summary.suite}, {"rows", rows}, {"failed_cells", failed}, {"near_paper", nearness}};
}

std::string to_csv(const Summary& summary) {
  const auto quoted = [](const std::string& name) {  // RFC 4180, and nothing that a spreadsheet takes for a formula
    std::string text = one_line(name);
    if (text.find_first_of("=+-@") == 0) text.insert(0, 1, '\'');
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string inside = text;
    for (std::size_t at = 0; (at = inside.find('"', at)) != std::string::npos; at += 2) inside.insert(at, 1, '"');
    return '"' + inside + '"';
  };
  const auto number = [](bool known, double value) { return known ? canonical(value) : std::string(); };

  const std::vector<std::string> words = failure_words();
  std::string csv = fmt::format(
      "scenario,layout,engine,method,method_kind,demonstrations,arm,seeds,participants,scenes,episodes,successes,"
      "success,low,"
      "high,"
      "against,difference,difference_low,difference_high,same_actions,inputs_seen,n_error,marks,{},{}\n",
      fmt::join(attributions, ","), fmt::join(words, ","));
  for (const Table& table : summary.tables)
    for (const Row& row : table.rows) {
      const bool known = row.success.has_value();
      const bool shifted = row.shift.has_value();
      const Shift shift = row.shift.value_or(Shift());
      csv += fmt::format(
          "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", quoted(row.scenario),
          quoted(row.layout), quoted(row.engine), quoted(row.method), row.kind, row.demonstrations, quoted(row.arm),
          row.seeds, row.participants, row.scenes, row.episodes, row.successes, number(known, row.success.value_or(0)),
          number(known, row.interval.low), number(known, row.interval.high), quoted(shift.against),
          number(shifted, shift.difference), number(shifted, shift.interval.low), number(shifted, shift.interval.high),
          shifted ? canonical(shift.same_actions) : "",
          number(row.seen_share().has_value(), row.seen_share().value_or(0)), row.n_error, fmt::join(row.marks, " "));
      for (const char* to : attributions) csv += fmt::format(",{}", row.attribution.at(to));
      for (const std::string& word : words) {
        const auto it = row.failures.find(word);
        csv += fmt::format(",{}", it == row.failures.end() ? 0 : it->second);
      }
      csv += '\n';
    }
  return csv;
}

}  // namespace lgabench::report

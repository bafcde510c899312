// summary.csv and episodes.csv.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include <lgabench/core/environments.hpp>
#include <lgabench/document/writers.hpp>
#include <lgabench/report/report.hpp>

namespace lgabench::report {

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
  const auto any = [&summary](const auto& has) {
    return std::any_of(summary.tables.begin(), summary.tables.end(),
                       [&has](const Table& table) { return std::any_of(table.rows.begin(), table.rows.end(), has); });
  };
  if (any([](const Row& row) { return row.paired.has_value(); }))
    for (const char* member : {"share", "low", "high", "scenes"})
      add(fmt::format("paired_{}", member), fmt::format("paired/{}", member));
  if (any([](const Row& row) { return row.course.has_value(); })) {
    for (const char* member : {"progress", "too_early", "went_on"})
      add(member == std::string("progress") ? member : fmt::format("n_{}", member), fmt::format("course/{}", member));
    for (const char* member : {"first_take", "refusals", "takings"})
      add(member, fmt::format("course/{}/share", member));
  }
  for (const char* to : attributions) add(to, fmt::format("attribution/{}", to));
  std::set<std::string> found;
  for (const Table& table : summary.tables)
    for (const Row& row : table.rows)
      for (const auto& item : row.failures) found.insert(item.first);
  for (const std::string& word : failure_words(found)) add(word, "failures/" + word);

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

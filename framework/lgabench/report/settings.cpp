#include <lgabench/report/settings.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>

#include <lgabench/plugin/loader.hpp>
#include <lgabench/report/names.hpp>

namespace lgabench::report {
namespace {

// Names of the rows that have this option at this value, in the order of tables.
std::vector<std::string> rows_with(const RunResults& run, const std::string& option, const std::string& value) {
  std::set<std::string, ByRank> rows;
  for (const CellResult& cell : run.cells)
    if (cell.options.value(option, Json()) == value) rows.insert(cell.method);
  std::vector<std::string> names;
  for (const std::string& row : rows) names.push_back(display_name(row));
  return names;
}

// "loss=squared: LGA, Human": rows with the same options together, in the order of tables.
std::vector<std::string> options_beside_defaults(const Json& settings) {
  std::map<std::string, std::string, ByRank> rows;  // their options
  for (const auto& [row, options] : settings.items()) {
    std::vector<std::string> texts;
    for (const auto& [option, value] : options.items()) texts.push_back(option + "=" + option_text(value));
    rows[row] = fmt::format("{}", fmt::join(texts, ", "));
  }
  std::vector<std::pair<std::string, std::vector<std::string>>> groups;  // options, rows
  for (const auto& [row, options] : rows) {
    std::size_t at = 0;
    while (at < groups.size() && groups[at].first != options) ++at;
    if (at == groups.size()) groups.push_back({options, {}});
    groups[at].second.push_back(display_name(row));
  }
  std::vector<std::string> lines;
  for (const auto& [options, names] : groups) lines.push_back(fmt::format("{}: {}", options, fmt::join(names, ", ")));
  return lines;
}

}  // namespace

std::vector<std::string> settings(const RunResults& run) {
  std::vector<std::string> lines;
  if (const std::string preset = run.json.value("preset", ""); !preset.empty()) lines.push_back("preset " + preset);
  for (const std::string& line : options_beside_defaults(run.json.value("settings", Json::object())))
    lines.push_back("beside the plugins' defaults, " + line);
  if (run.json.value("request", Json::object()).value("test_scenes", Json()) == "per_seed")
    lines.emplace_back("each training seed plays test scenes of its own");
  if (const auto rows = rows_with(run, "network", "plain"); !rows.empty())
    lines.push_back(
        fmt::format("network=plain has no batch normalisation, a deviation from the paper and from its code: {}",
                    fmt::join(rows, ", ")));
  bool lga = false, lga_s = false;
  for (const CellResult& cell : run.cells) {
    lga = lga || (cell.id == "lga" && cell.options.value("picture", Json()) == "rgb");
    lga_s = lga_s || cell.id == "lga_s";
  }
  if (lga && lga_s) lines.emplace_back("LGA and LGA-S are one method here: with picture=rgb LGA sees the picture too");
  return lines;
}

}  // namespace lgabench::report

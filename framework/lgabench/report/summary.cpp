#include <lgabench/report/summary.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include <lgabench/report/names.hpp>

namespace lgabench::report {
namespace {

// What one cell adds to a row: a policy on one arm.
struct Policy {
  int episodes = 0, successes = 0;
  double rate() const { return static_cast<double>(successes) / episodes; }
};

// A row in the making: the policies of each scenario.
struct Draft {
  Row row;
  std::vector<std::vector<Policy>> scenarios;
};

// Mean over the numbers at `path` in each of `all`, the number itself where all agree; null without one.
Json mean_at(const std::vector<Json>& all, const Json::json_pointer& path) {
  Json first;
  bool agree = true;
  double sum = 0;
  int n = 0;
  for (const Json& one : all) {
    if (!one.contains(path) || !one.at(path).is_number()) continue;
    const Json& value = one.at(path);
    if (n++ == 0) first = value;
    agree = agree && value == first;
    sum += value.get<double>();
  }
  return agree ? first : Json(sum / n);
}

// The different texts at `path`, joined.
std::string words_at(const std::vector<Json>& all, const Json::json_pointer& path) {
  std::set<std::string> words;
  for (const Json& one : all)
    if (one.contains(path) && one.at(path).is_string()) words.insert(one.at(path).get<std::string>());
  return fmt::format("{}", fmt::join(words, "; "));
}

// Provenance, cost and quality of a row's Selections; null if none of its cells selects.
Json phi_of(const std::vector<const CellResult*>& cells) {
  std::vector<Json> selections, qualities;
  for (const CellResult* cell : cells)
    if (!cell->failed && !cell->quality.is_null()) {
      selections.push_back(cell->selection);
      qualities.push_back(cell->quality);
    }
  if (selections.empty()) return nullptr;
  Json quality;
  for (const auto& [about, groups] : qualities.front().items()) {
    quality[about] = nullptr;
    for (const auto& [group, numbers] : groups.items())
      for (const auto& item : numbers.items())
        quality[about][group][item.key()] = mean_at(qualities, Json::json_pointer("") / about / group / item.key());
  }
  return {{"provenance", words_at(selections, "/provenance"_json_pointer)},
          {"source", words_at(selections, "/source"_json_pointer)},
          {"asked_as", words_at(selections, "/asked_as"_json_pointer)},
          {"lm_queries", mean_at(selections, "/cost/lm_queries"_json_pointer)},
          {"quality", quality}};
}

// Success and its interval from the policies.
void estimate(Draft& draft) {
  std::vector<Cluster> clusters;
  for (const auto& policies : draft.scenarios) {
    Cluster cluster;
    for (const Policy& p : policies) cluster.push_back(p.rate());
    if (!cluster.empty()) clusters.push_back(std::move(cluster));
  }
  if (clusters.empty()) return;
  Row& row = draft.row;
  row.success = cluster_mean(clusters);
  row.interval = success_interval(clusters, row.episodes,
                                  fmt::format("report/{}/{}/{}/{}/{}/{}", row.scenario, row.layout, row.engine,
                                              row.method, row.demonstrations, row.arm));
}

// The row of `cells`: all seeds of one (scenario, method, demonstrations).
Draft scenario_draft(const std::vector<const CellResult*>& cells, const std::string& arm) {
  const CellResult& first = *cells.front();
  Draft draft;
  Row& row = draft.row;
  row.scenario = first.scenario;
  row.layout = first.layout;
  row.engine = first.engine;
  row.arm = arm;
  row.method = first.method;
  row.kind = first.kind;
  row.demonstrations = first.demonstrations;
  row.phi = phi_of(cells);
  auto& policies = draft.scenarios.emplace_back();
  for (const CellResult* cell : cells) {
    if (cell->failed) {
      if (cell->fault == "host") row.n_error += cell->episodes_per_arm;
      continue;
    }
    Policy policy;
    for (const PlayedEpisode& e : cell->episodes) {
      if (e.arm != arm) continue;
      ++policy.episodes;
      if (e.success)
        ++policy.successes;
      else
        ++row.failures[e.failure];
    }
    ++row.seeds;
    row.episodes += policy.episodes;
    row.successes += policy.successes;
    policies.push_back(policy);
  }
  if (policies.size() < cells.size()) row.marks.emplace_back("incomplete");
  estimate(draft);
  return draft;
}

// The row over all scenarios, from their rows of the same method and number of demonstrations.
Row mean_row(const std::vector<const Draft*>& drafts, std::size_t scenarios) {
  Draft mean;
  Row& row = mean.row = drafts.front()->row;
  row.scenario = mean_scenario;
  row.phi = nullptr;
  row.seeds = row.episodes = row.successes = row.n_error = 0;
  row.failures.clear();
  row.marks.clear();
  row.success.reset();
  row.interval = {};
  bool complete = drafts.size() == scenarios;
  for (const Draft* draft : drafts) {
    row.seeds = std::max(row.seeds, draft->row.seeds);
    row.episodes += draft->row.episodes;
    row.successes += draft->row.successes;
    row.n_error += draft->row.n_error;
    for (const auto& [failure, n] : draft->row.failures) row.failures[failure] += n;
    complete = complete && !draft->row.marked("incomplete");
    mean.scenarios.push_back(draft->scenarios.front());
  }
  if (!complete) row.marks.emplace_back("incomplete");
  estimate(mean);
  return row;
}

// A method that learned less than what always does the same thing has learned nothing.
void mark_not_learned(Table& table) {
  for (Row& row : table.rows) {
    if (row.is_reference() || !row.success) continue;
    const Row* constant = table.find(row.scenario, "constant_action", row.demonstrations);
    if (constant && constant->success && *row.success < *constant->success)
      row.marks.insert(row.marks.begin(), "baseline_not_learned");
  }
}

Table make_table(const std::string& arm, const std::vector<const CellResult*>& cells) {
  Table table;
  table.layout = cells.front()->layout;
  table.engine = cells.front()->engine;
  table.arm = arm;
  std::vector<std::string> scenarios;                            // as the cells are ordered
  using Place = std::tuple<std::string, int, std::string, int>;  // kind, rank, method, demonstrations
  std::map<std::string, std::map<Place, std::vector<const CellResult*>>> grouped;
  for (const CellResult* cell : cells) {
    if (grouped.count(cell->scenario) == 0) scenarios.push_back(cell->scenario);
    grouped[cell->scenario][{cell->kind, display_rank(cell->method), cell->method, cell->demonstrations}].push_back(
        cell);
  }
  std::map<Place, std::vector<const Draft*>> over_scenarios;
  std::vector<Draft> drafts;
  drafts.reserve(cells.size());  // as many rows at most: pointers to them stay valid
  for (const std::string& scenario : scenarios)
    for (const auto& [place, seeds] : grouped[scenario]) {
      drafts.push_back(scenario_draft(seeds, arm));
      over_scenarios[place].push_back(&drafts.back());
      table.rows.push_back(drafts.back().row);
    }
  for (const auto& [place, rows] : over_scenarios) table.rows.push_back(mean_row(rows, scenarios.size()));
  mark_not_learned(table);
  return table;
}

}  // namespace

bool Row::marked(const std::string& mark) const { return std::find(marks.begin(), marks.end(), mark) != marks.end(); }

std::vector<std::string> Table::scenarios() const {
  std::vector<std::string> all;
  for (const Row& row : rows)
    if (all.empty() || all.back() != row.scenario) all.push_back(row.scenario);
  return all;
}

std::vector<int> Table::demonstrations() const {
  std::set<int> learned, any;
  for (const Row& row : rows) {
    any.insert(row.demonstrations);
    if (row.demonstrations > 0) learned.insert(row.demonstrations);
  }
  const std::set<int>& columns = learned.empty() ? any : learned;
  return {columns.begin(), columns.end()};
}

const Row* Table::find(const std::string& scenario, const std::string& method, int n) const {
  for (const Row& row : rows)
    if (row.scenario == scenario && row.method == method &&
        (row.demonstrations == n || (row.is_reference() && row.demonstrations == 0)))
      return &row;
  return nullptr;
}

std::vector<std::string> Table::ids(const std::string& scenario, const std::string& kind) const {
  std::vector<std::string> all;
  for (const Row& row : rows)
    if (row.scenario == scenario && row.kind == kind && (all.empty() || all.back() != row.method))
      all.push_back(row.method);
  return all;
}

std::string Table::title(const std::string& scenario) const {
  if (scenario != mean_scenario) return scenario;
  const std::size_t n = scenarios().size() - 1;
  return fmt::format("mean over {} scenario{}", n, n == 1 ? "" : "s");
}

std::string Table::title() const {
  return fmt::format("layout {}, engine {}{}", layout, engine, arm == "test" ? "" : ", arm " + arm);
}

Summary summarize(const RunResults& run) {
  Summary summary;
  summary.suite = run.suite;
  std::map<std::tuple<std::string, std::string, std::string>, std::vector<const CellResult*>> tables;
  for (const CellResult& cell : run.cells) {
    for (const std::string& arm : cell.arms) tables[{cell.layout, cell.engine, arm}].push_back(&cell);
    if (cell.failed) summary.failed.push_back(cell);
  }
  for (const auto& [place, cells] : tables) summary.tables.push_back(make_table(std::get<2>(place), cells));
  return summary;
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
                      {"episodes", row.episodes},
                      {"successes", row.successes},
                      {"success", row.success ? Json(*row.success) : Json()},
                      {"low", row.success ? Json(row.interval.low) : Json()},
                      {"high", row.success ? Json(row.interval.high) : Json()},
                      {"failures", row.failures},
                      {"n_error", row.n_error},
                      {"marks", row.marks},
                      {"phi", row.phi}});
  for (const CellResult& cell : summary.failed)
    failed.push_back({{"cell", cell.key}, {"fault", cell.fault}, {"reason", cell.reason}});
  return {{"suite", summary.suite}, {"rows", rows}, {"failed_cells", failed}};
}

std::string to_csv(const Summary& summary) {
  const auto quoted = [](const std::string& text) {  // RFC 4180
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string inside = text;
    for (std::size_t at = 0; (at = inside.find('"', at)) != std::string::npos; at += 2) inside.insert(at, 1, '"');
    return '"' + inside + '"';
  };
  const auto number = [](bool known, double value) { return known ? canonical(value) : std::string(); };

  const std::vector<std::string> words = failure_words();
  std::string csv = fmt::format(
      "scenario,layout,engine,method,method_kind,demonstrations,arm,seeds,episodes,successes,success,low,high,"
      "n_error,marks,{}\n",
      fmt::join(words, ","));
  for (const Table& table : summary.tables)
    for (const Row& row : table.rows) {
      const bool known = row.success.has_value();
      csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", quoted(row.scenario), quoted(row.layout),
                         quoted(row.engine), quoted(row.method), row.kind, row.demonstrations, quoted(row.arm),
                         row.seeds, row.episodes, row.successes, number(known, row.success.value_or(0)),
                         number(known, row.interval.low), number(known, row.interval.high), row.n_error,
                         fmt::join(row.marks, " "));
      for (const std::string& word : words) {
        const auto it = row.failures.find(word);
        csv += fmt::format(",{}", it == row.failures.end() ? 0 : it->second);
      }
      csv += '\n';
    }
  return csv;
}

}  // namespace lgabench::report

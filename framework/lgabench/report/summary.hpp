// The rows that tables and figures are made of.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/json.hpp>
#include <lgabench/report/results.hpp>
#include <lgabench/report/statistics.hpp>

namespace lgabench::report {

constexpr const char* mean_scenario = "(mean)";

/// What a method did at one number of demonstrations, in one scenario or on the mean over all of them.
struct Row {
  std::string scenario, layout, engine, arm, method, kind;
  int demonstrations = 0;
  int seeds = 0, episodes = 0, successes = 0;
  std::optional<double> success;  // mean over scenarios of the mean over training seeds; none without episodes
  Interval interval;              // 95 %; docs/formats says which
  std::map<std::string, int> failures;
  int n_error = 0;  // episodes not played: the engine or the host failed
  std::vector<std::string> marks;
  Json phi;  // provenance, cost and quality of the Selections; null in mean rows

  bool is_reference() const { return kind == "reference"; }
  bool is_mean() const { return scenario == mean_scenario; }
  bool marked(const std::string& mark) const;
};

/// Rows of one (layout, engine, arm), in the order of tables: scenarios, the mean last; methods, reference rows last;
/// demonstrations ascending.
struct Table {
  std::string layout, engine, arm;
  std::vector<Row> rows;

  std::vector<std::string> scenarios() const;  // in order, the mean last
  std::vector<int> demonstrations() const;     // columns: those of the methods, or of all where there is none
  /// The row, nullptr where there is none. A reference row that learns nothing (demonstrations 0) stands in every
  /// column.
  const Row* find(const std::string& scenario, const std::string& method, int demonstrations) const;
  /// Ids of a scenario's methods, or of its reference rows, in order.
  std::vector<std::string> methods(const std::string& scenario) const { return ids(scenario, "method"); }
  std::vector<std::string> references(const std::string& scenario) const { return ids(scenario, "reference"); }
  /// "mean over 3 scenarios" for the mean, else the scenario's own id.
  std::string title(const std::string& scenario) const;
  /// "layout cells, engine mujoco", and the arm if it is not the plain test.
  std::string title() const;

 private:
  std::vector<std::string> ids(const std::string& scenario, const std::string& kind) const;
};

struct Summary {
  std::string suite;
  std::vector<Table> tables;
  std::vector<CellResult> failed;  // cells
};

/// Aggregates the cells. Deterministic: the bootstrap's random stream is named after the row.
Summary summarize(const RunResults& run);

/// summary.json and summary.csv (docs/formats).
Json to_json(const Summary& summary);
std::string to_csv(const Summary& summary);

}  // namespace lgabench::report

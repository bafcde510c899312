// Success against a level: of errors that were made in what was selected (abstraction/selection_errors.hpp), and of
// perturbation axes (core/perturbations.hpp).
#pragma once
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/statistics/results.hpp>
#include <lgabench/statistics/statistics.hpp>

namespace lgabench::statistics {

struct Table;

/// Success on the mean over scenarios against the probability of one kind of errors.
struct ErrorCurve {
  struct Point {
    double p = 0, success = 0, low = 0, high = 0;
    double empty = 0;     // share of its episodes that failed as abstraction_empty
    std::size_t row = 0;  // of summary.json
  };
  std::string layout, engine, arm, method, kind;  // method: the row's without errors; kind: missing or added
  int demonstrations = 0;
  std::vector<Point> points;         // p ascending
  double slope = 0;                  // of the line of least squares through them, for each .1 of p
  std::optional<Interval> interval;  // the slope's, 95 %; none unless every policy finished at every p
};

/// Success on the mean over scenarios against the levels of one axis (core/perturbations.hpp). Rows are paired with the
/// control scene by scene.
struct PerturbationCurve {
  struct Level {
    int level = 0;
    std::string name;    // in a few words; "" where the axis is not installed
    double success = 0;  // with its interval as its row has it
    Interval interval;
    Change change;                 // against the control
    std::optional<double> p_holm;  // among all levels of all axes of the row; none of a reference row
    int lost = 0, gained = 0;      // episodes that failed here alone, and in the control alone
    double p_mcnemar = 1;          // exact, of these episodes
    UnchangedInputs inputs;
    std::size_t row = 0;  // of summary.json
    /// Where an axis gives other commands: episodes by what they took (Episode::took), and of the level that gives
    /// another command, the share that took what it means minus the same share in the control.
    std::map<std::string, int> took;
    std::optional<Change> use_of_language;

    bool is_loss() const { return p_holm && *p_holm <= alpha && change.difference < 0; }
  };
  /// Area under the curve from the control to the last level, levels as far apart as their numbers, as a share of what
  /// the control's success without any loss would have.
  struct Area {
    double relative = 1;
    Interval interval;  // 95 %
  };
  std::string layout, engine, method, kind, axis;
  int demonstrations = 0;
  bool named = false;                      // levels without an order
  double control = 0;                      // success, in the scenarios that have the axis
  std::optional<std::size_t> control_row;  // of summary.json; none where other scenarios lack the axis
  std::map<std::string, int> took;         // in the control, likewise
  std::vector<Level> levels;               // ascending
  std::optional<Area> area;  // none of a named axis or a reference row, nor where the control hardly ever succeeds
  int tests = 0;             // among which p_holm is

  /// The lowest level with a significant loss.
  const Level* first_loss() const;
  const Level* find(int level) const;
};

/// Curves of the mean rows of all tables, those of two points or more: of errors of one kind alone. A point at 0 is the
/// row without errors. In the order of the tables' rows.
std::vector<ErrorCurve> error_curves(const RunResults& run, const std::vector<Table>& tables);

/// Curves of the mean rows of all tables, of methods and of reference rows that are a bound: by table, method,
/// demonstrations, then axes as the arms have them.
std::vector<PerturbationCurve> perturbation_curves(const RunResults& run, const std::vector<Table>& tables);

/// The weights of success in an area, in the control and then at each of these levels: the trapezoids' sides, as shares
/// of the whole. @pre levels grow, from 1 on
std::vector<double> trapezoids(const std::vector<int>& levels);

/// The curves as summary.json has them.
Json to_json(const ErrorCurve& curve);
Json to_json(const PerturbationCurve& curve);

}  // namespace lgabench::statistics

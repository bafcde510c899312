// Two runs of the same suite, cell by cell.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <lgabench/statistics/pairs.hpp>
#include <lgabench/statistics/results.hpp>

namespace lgabench::statistics {

/// Success of a row in run A and in run B, on the mean over the scenarios that both hold.
struct ComparedRow {
  std::string layout, engine, method, kind, arm;  // method: the row's name in B
  std::string method_a;                           // and in A
  int demonstrations = 0;
  double success_a = 0, success_b = 0;
  Change change;      // B minus A
  double p_holm = 1;  // over all rows of the comparison
  int scenarios = 0;
  /// Paired success (statistics/paired.hpp) where the arm's scenes are pairs; no part of the verdict.
  struct Paired {
    double a = 0, b = 0;
    Change change;  // B minus A; p as it is
  };
  std::optional<Paired> paired{};
  EpisodePairs total;  // over all pairs of cells; first is A
  // Pairs of cells, and those of them where B is worse or better by McNemar's exact test, Holm's p within the row.
  int cells = 0, cells_worse = 0, cells_better = 0;

  bool worse() const;   // than A beyond chance
  bool better() const;  // likewise
};

/// Seconds of a phase in the pairs of cells of a row, whatever their scenario, demonstrations and seed.
struct ComparedTime {
  std::string layout, engine, method, phase;
  int cells = 0;
  double mean_a = 0, mean_b = 0;
  Change change;      // B minus A by the paired t test; p is Wilcoxon's
  double p_holm = 1;  // over all rows and phases
};

/// Cells that measure the same but did not play the same scenes: they are not compared in that arm.
struct OtherScenes {
  std::string layout, engine, scenario, arm, why;  // why: of the first pair
  std::vector<std::string> cells;                  // "lga n=20 seed=0", in B's names
};

struct RunComparison {
  std::string suite;
  std::vector<ComparedRow> rows;    // by layout, engine, arm, kind, method, demonstrations
  std::vector<ComparedTime> times;  // by layout, engine, method; phases in their order
  std::vector<OtherScenes> other_scenes;
  int only_a = 0, only_b = 0;      // finished cells that measure what the other run does not
  int failed_a = 0, failed_b = 0;  // cells that finished in the other run alone
  int missing = 0;                 // only_a, but 0 for two chosen rows, which need not have the same cells

  /// Some row is worse in B beyond chance, or a cell that finished in A failed in B or is missing there.
  bool regressed() const;
};

/// A row of A by its name, and the one of B that it is compared with.
struct RowPair {
  std::string a, b;
};

/// Pairs cells by what they measure: scenario, layout, engine, method and its options (whatever its row is
/// named), demonstrations, training seed; their episodes by arm and index. With `rows`, of one row each,
/// whatever their methods: the cells of an equal scenario, layout, engine, number of demonstrations and training seed.
/// Deterministic. @throws InputError, in one line that says what differs, for runs of other suites or episodes, for
/// runs that have no arm of a cell with the same scenes and commands in common, and for a row that is not there.
RunComparison compare_runs(const RunResults& a, const RunResults& b, const std::optional<RowPair>& rows = {});

/// "No row is worse: 1 better, 3 the same within chance." Worse is what regressed() says.
std::string verdict(const RunComparison& comparison);

/// Every member, under its name.
Json to_json(const RunComparison& comparison);

}  // namespace lgabench::statistics

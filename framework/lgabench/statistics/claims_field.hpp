// The rows of one (layout, engine) as claims compare them: every policy of the one with its pair of the other.
#pragma once
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/record/suite_claims.hpp>
#include <lgabench/statistics/claims.hpp>
#include <lgabench/statistics/paper.hpp>

namespace lgabench::statistics {

/// The cells of one (layout, engine), by row, demonstrations, scenario and training seed.
struct Field {
  /// Cells by participant, "" where nobody was asked.
  using People = std::map<std::string, const CellResult*>;
  /// Cells by scenario and training seed.
  using Policies = std::map<std::pair<std::string, long long>, People>;

  std::string layout, engine;
  bool rehearsal = false;         // a cell is based on answers that are no people's
  std::vector<std::string> arms;  // as the scenarios list them
  std::set<int> demonstrations;   // of the methods
  std::map<std::string, std::map<int, Policies>> rows;

  void add(const CellResult& cell);
  /// nullptr where there is none.
  const Policies* find(const std::string& row, int n) const;
  std::vector<const CellResult*> cells() const;
};

/// The row of the field whose resolved options are the method's, and whose name tells it apart by nothing else: "lga"
/// of a preset that sets instances=first as well as "lga+instances=first", never "lga+epochs=5". "" where there is
/// none.
std::string find_row(const Field& field, const ClaimedMethod& method);

/// Compares `above` with `below`, each policy with its pair. Not tested where a row or a pair is missing: a row that
/// fails on hard scenarios would gain by it. Verdicts are left open. `paired`: their paired success.
ClaimedDifference measured(const Field& field, const std::string& claim, const ClaimedMethod& above,
                           const ClaimedMethod& below, const std::string& arm, int n, bool paired = false);

/// Compares so two rows that the field has at this number of demonstrations.
ClaimedDifference measured_rows(const Field& field, const std::string& claim, const std::string& above,
                                const std::string& below, const std::string& arm, int n, bool paired = false);

/// What success does per 0.1 of the option of both methods, least squares over its levels, of `above` minus that of
/// `below`; paired as above, all levels together.
ClaimedDifference measured_slope(const Field& field, const SuiteClaim& claim, const std::string& arm, int n);

/// Whether the cell has the arm as one that enters means.
bool has_arm(const CellResult& cell, const std::string& arm);

}  // namespace lgabench::statistics

// The rows that methods are measured against, which the framework plays itself. A row says here all that the framework
// and its programs know of it, but for how it acts (cell/reference_actor.cpp).
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace lgabench {

/// A mark of rows in tables, and what it means.
struct RowMark {
  const char *word, *sign, *meaning;
};

struct ReferenceRow {
  std::string id;
  std::string name;                      // in tables and figures
  std::string summary;                   // a sentence without a full stop
  bool learns;                           // has a cell for every number of demonstrations and training seed
  bool in_every_suite;                   // else a suite asks for it: "references"
  std::vector<double> dashes;            // of its line in figures
  std::optional<RowMark> below_it = {};  // of methods' rows with less success; such a row is also in a run's summary
  bool is_bound = false;                 // what success there can be: last in tables, and with curves of its own
};

/// The row that takes any object it sees, with which the first sentence of a report and the leaderboard compare.
inline constexpr const char* random_object = "random_object";

/// All reference rows, in the order in which a run has them.
const std::vector<ReferenceRow>& reference_rows();
/// nullptr where the id is none of theirs.
const ReferenceRow* find_reference_row(const std::string& id);

}  // namespace lgabench

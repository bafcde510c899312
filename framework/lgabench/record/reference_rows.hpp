// The rows that methods are measured against, which the framework plays itself.
#pragma once
#include <string>
#include <vector>

namespace lgabench {

struct ReferenceRow {
  std::string id;
  bool learns;          // has a cell for every number of demonstrations and training seed
  bool in_every_suite;  // else a suite asks for it: "references"
  std::string summary;
};

/// In the order in which a run has them.
const std::vector<ReferenceRow>& reference_rows();
/// nullptr where the id is none of theirs.
const ReferenceRow* find_reference_row(const std::string& id);

}  // namespace lgabench

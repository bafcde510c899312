// A suite's own claims: what it expects of its rows, said before they are computed (docs/formats).
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include <lgabench/core/json.hpp>

namespace lgabench {

/// What is claimed of two rows' success, at each of the arms and numbers of demonstrations, as a mean over scenarios.
struct SuiteClaim {
  /// ordering: `above` is better than `below`; at_most: better by `margin` at most; equivalence: within `margin` of it;
  /// slope: per 0.1 of `option`, it loses less.
  enum class Test { ordering, at_most, equivalence, slope };

  std::string id, statement, refuted_if;
  Test test = Test::ordering;
  bool paired = false;       // of the share of pairs of which both commands end right, in place of that of episodes
  std::string above, below;  // rows: "ID+OPTION=VALUE+..."
  std::vector<std::string> scenarios, arms;  // empty: all
  std::vector<int> demonstrations;           // likewise
  double margin = 0;
  std::string option;          // of a slope: a number of both methods, or an error of Selections, missing or added
  std::vector<double> levels;  // its values, which grow
};

/// The claims of {"claims": [...]}. @throws InputError with file and place.
std::vector<SuiteClaim> read_suite_claims(const Json& json, const std::string& file);

/// What claims/NAME.json says beside the suite's file NAME.json; null where there is none. @throws InputError where
/// read_suite_claims() does.
Json claims_beside(const std::filesystem::path& suite);

}  // namespace lgabench

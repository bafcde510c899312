// The claims of a suite, its own or the paper's, tested on a run.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/statistics/results.hpp>
#include <lgabench/statistics/statistics.hpp>

namespace lgabench::statistics {

/// held, reversed: the data say so beyond chance. undecided: they do not. not_tested: they cannot.
enum class Verdict { held, reversed, undecided, not_tested };
/// "not tested", for readers.
std::string to_string(Verdict verdict);

/// One test of a difference.
struct Tested {
  Verdict verdict = Verdict::not_tested;
  std::string reason;            // why not tested; else empty
  std::optional<Change> change;  // none where not tested
  double p_holm = 1;             // of the paper's: over the rows compared for the claim in one arm at one number of
                                 // demonstrations; of a suite's own: over all differences of its claims
};

/// The unit of a difference in paired success, whose scenarios are pairs of commands.
inline constexpr const char* paired_unit = "paired success";

/// Two rows on the mean over scenarios, paired by scenario, training seed, participant and scene; or the seconds that
/// participants took for both.
struct ClaimedDifference {
  std::string above, below, arm;  // rows; the change is above minus below; no arm for seconds
  // "success" or paired_unit; "seconds", a participant's; or "success per 0.1 of OPTION", what is lost less
  std::string unit = "success";
  int demonstrations = 0;
  Tested these;  // would other test scenes and training seeds of these scenarios say the same? (paired_change)
  Tested alike;  // would other scenarios like these? (t on the scenarios' differences, from six on)
  std::vector<std::pair<std::string, double>> by_scenario;  // its difference; empty for seconds
  int scenarios = 0, scenes = 0, seeds = 0, policies = 0, participants = 0;
};

/// A claim on one (layout, engine).
struct Claim {
  std::string id, statement, layout, engine;
  std::string refuted_if;                 // in words, of a suite's own; else empty
  Verdict verdict = Verdict::not_tested;  // on these scenarios: the claim's own
  std::string reason;                     // why not tested; else empty
  Verdict alike = Verdict::not_tested;    // on scenarios like these
  std::string reason_alike;
  bool rehearsal = false;  // based on answers that are no people's
  std::vector<ClaimedDifference> differences;
  std::string needs;  // the suite whose run would test it; "" where this run's is no reason
};

/// The claims of the run's suite (suite_claims.hpp), as its record has them or else the installation; where it has none
/// of its own, each of paper_claims(); for every (layout, engine) of the run. Both tests judge alike: an ordering is
/// held if the 95 % interval of the difference is above 0 and Holm's p at most .05, reversed if it is below; an
/// equivalence is held if the interval lies within the margin, reversed if outside. Seconds have Student's paired t
/// test over participants. A claim is what the worst of its differences is: reversed, undecided, not tested, held.
/// Deterministic. @throws InputError where cells of the run did not play the same scenes.
std::vector<Claim> test_claims(const RunResults& run);

/// "The suite's claims", or the paper's.
std::string claims_title(const std::vector<Claim>& claims);

/// One row against another, by the names that the run gives them ("lga+instances=first"), in every arm at every number
/// of demonstrations that both have; an ordering, for each (layout, engine). @throws InputError for a row that the run
/// does not have.
std::vector<Claim> test_difference(const RunResults& run, const std::string& above, const std::string& below);

/// claims.json (docs/formats).
Json to_json(const std::string& suite, const std::vector<Claim>& claims);

}  // namespace lgabench::statistics

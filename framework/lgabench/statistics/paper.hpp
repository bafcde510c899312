// What the paper published, as the files beside its suites say (results/paper): values to stand beside what we measure,
// and claims to test.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace lgabench::statistics {

/// Success in one of the paper's figures.
struct PaperValues {
  std::string figure, title;  // e.g. "3a", and what the suite shows; empty where there is none
  // Scenario (mean_scenario: the mean over the paper's own) -> method's display name -> demonstrations -> rate.
  using Rates = std::map<std::string, std::map<std::string, std::map<int, double>>>;
  Rates rates, errors;            // errors: half the length of the error bar, where the figure has one
  std::vector<std::string> near;  // methods of which Nearness counts the points

  std::optional<double> find(const std::string& scenario, const std::string& method, int demonstrations) const;
  std::optional<double> error(const std::string& scenario, const std::string& method, int demonstrations) const;
};

/// How near measured curves come to the paper's: over the points of PaperValues::near, the methods whose Selections
/// need no people's answers that were not published. A setting that reproduces the paper has all points near.
struct Nearness {
  std::vector<std::string> methods;
  int points = 0, near = 0;  // near: within 1.5 of the paper's error bars
  double mean_distance = 0;  // of success, over all points
};

/// The values of the figure that belongs to the suite: curves are a mean over scenarios, bars each scenario pooled over
/// its arms; empty for a suite without a figure.
/// @throws InputError where a file is missing or not as expected.
PaperValues paper_values(const std::string& suite);

/// A method as a claim means it: the id, and the values of options that matter to the claim.
struct ClaimedMethod {
  std::string id;
  std::map<std::string, std::string> options{};

  /// "lga_l with image=rgb"
  std::string text() const;
};

/// Reads "ID+OPTION=VALUE+...", as rows are named.
ClaimedMethod claimed_method(const std::string& row);

/// A claim of the paper, as data.
struct PaperClaim {
  /// ordering: each of `above` is better than each of `below`; equivalence: within `margin` of it, where people made
  /// `below`'s Selections; seconds: people take longer for `above` than for `below`.
  enum class Test { ordering, equivalence, seconds };
  /// all; all but the first, which the others are compared with; those that give only commands without demonstrations.
  enum class Arms { all, shifted, unseen };

  std::string id, statement;
  std::string suite;  // that it needs a run of; "" for any
  Test test = Test::ordering;
  Arms arms = Arms::all;
  std::vector<ClaimedMethod> above, below;  // one of each, unless an ordering
  std::optional<int> demonstrations;        // none: every number of them
  double margin = 0;                        // of an equivalence
};

/// The paper's claims, in their order. @throws InputError for a file that is not as docs/formats says.
std::vector<PaperClaim> paper_claims();

}  // namespace lgabench::statistics

// What the paper published, to stand beside what we measure.
#pragma once
#include <map>
#include <optional>
#include <string>

namespace lgabench::report {

/// Success in one of the paper's figures.
struct PaperValues {
  std::string figure;  // e.g. "3a"; empty where there is none
  // Scenario (mean_scenario: the mean over the paper's own) -> method's display name -> demonstrations -> rate.
  using Rates = std::map<std::string, std::map<std::string, std::map<int, double>>>;
  Rates rates, errors;  // errors: half the length of the error bar, where the figure has one

  std::optional<double> find(const std::string& scenario, const std::string& method, int demonstrations) const;
  std::optional<double> error(const std::string& scenario, const std::string& method, int demonstrations) const;
};

/// How near measured curves come to the paper's: over the points of LGA, Human and GCBC-SEG, the methods whose
/// Selections need no people's answers that were not published. A setting that reproduces the paper has all points
/// near.
struct Nearness {
  int points = 0, near = 0;  // near: within 1.5 of the paper's error bars
  double mean_distance = 0;  // of success, over all points
};

/// From the installed paper/reference_results.json: for suite q1 figure 3a, a mean over scenarios; for q2 and q3
/// figures 4a and 4b, each scenario pooled over its arms; empty for another suite.
/// @throws InputError where the file is missing or not as expected.
PaperValues paper_values(const std::string& suite);

}  // namespace lgabench::report

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
  using Values = std::map<std::string, std::map<std::string, std::map<int, double>>>;
  Values rates;
  Values errors;  // half the height of the figure's error bar, where it has one

  std::optional<double> find(const std::string& scenario, const std::string& method, int demonstrations) const {
    return find(rates, scenario, method, demonstrations);
  }
  std::optional<double> error(const std::string& scenario, const std::string& method, int demonstrations) const {
    return find(errors, scenario, method, demonstrations);
  }

 private:
  static std::optional<double> find(const Values& values, const std::string& scenario, const std::string& method,
                                    int demonstrations);
};

/// From the installed paper/reference_results.json: for suite q1 figure 3a, a mean over scenarios; for q2 and q3
/// figures 4a and 4b, each scenario pooled over its arms; empty for another suite.
/// @throws InputError where the file is missing or not as expected.
PaperValues paper_values(const std::string& suite);

}  // namespace lgabench::report

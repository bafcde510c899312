// Errors in what was selected, at test only: true features that are missing, wrong ones that are added.
#include <lgabench/core/perturbations.hpp>

#include <lgabench/abstraction/selection_errors.hpp>

namespace lgabench::perturbations {

PerturbationAxis selection_errors() {
  PerturbationAxis axis{"selection_errors", {"5 %", "10 %", "20 %", "40 %"}, {EpisodePart::selection}};
  axis.selection_errors = [](int level) {
    constexpr std::array probability{.05, .1, .2, .4};
    return probability.at(static_cast<std::size_t>(level - 1));
  };
  axis.lacks = [](const Scenario& scenario, int) { return why_no_selection_errors(scenario); };
  return axis;
}

}  // namespace lgabench::perturbations

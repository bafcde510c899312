// The same command in other words.
#include <lgabench/core/perturbations.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <lgabench/core/contains.hpp>

namespace lgabench::perturbations {

PerturbationAxis paraphrase() {
  PerturbationAxis axis{
      "paraphrase",
      {"a synonym", "reordered and polite", "described by what it looks like or is for", "the referent left out"},
      {EpisodePart::words},
      {EpisodePart::answers, EpisodePart::selection}};
  axis.named = axis.rewords = true;
  axis.lacks = [](const Scenario& scenario, int level) -> std::string {
    std::vector<int> there;
    for (const ScenarioCommand& command : scenario.commands)
      if (command.wording > 0) there.push_back(command.wording);
    return contains(there, level)
               ? ""
               : fmt::format("expected a command of {} with \"wording\": {}, got {}", scenario.id, level,
                             there.empty() ? "none with one" : fmt::format("{}", fmt::join(there, ", ")));
  };
  return axis;
}

}  // namespace lgabench::perturbations

// A suite's scenarios: those of the data directory with what the suite and its design change.
#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include <lgabench/core/scenario.hpp>
#include <lgabench/harness/suite.hpp>

namespace lgabench {

/// Ids of the scenarios that the design names, as they are in the suite: of its variants, where it has any.
std::vector<std::string> suite_scenario_ids(const Suite& suite, const Design& design);

/// A suite's scenario, or one of its variants: its own arms, then those that the suite adds and the design plays, then
/// those of the perturbations; the suite's design where none is given. @throws InputError for one of another
/// environment.
Scenario suite_scenario(const Suite& suite, const std::string& id, Truth truth, const Design* design = nullptr);

/// What a run of the design may play: the arms of all its scenarios, and the levels of each axis that they have.
struct SuiteArms {
  std::vector<std::string> ids;
  std::map<std::string, std::set<int>> axes;
};
SuiteArms arms_of(const Suite& suite, const Design& design);

}  // namespace lgabench

// The score of a table whose scenes are perturbed: areas under the curves of success against the levels of axes.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/leaderboard/entry.hpp>

namespace lgabench::leaderboard {

/// How much of a scenario's success each arm is; they add up to 1.
using ArmWeights = std::map<std::string, double>;

/// The axes of the table that have an area, in the order of the setting's first scenario: levels from 1 on that are
/// more of one thing (PerturbationAxis::named), without `all`. None in a table that is not perturbed.
std::vector<std::string> axes_of(const Setting& setting);

/// The trapezoids' shares of one axis in a scenario, the control (its first arm) included; empty where it lacks the
/// axis.
ArmWeights weights_of(const Setting::Scenario& scenario, const std::string& axis);
/// The shares of all axes of a scenario, weighted alike. Empty for a scenario that is not perturbed, whose arms count
/// alike.
ArmWeights weights_of(const Setting::Scenario& scenario);

/// The share of its control's success that an entry keeps along one axis, over the scenarios that have it; none if the
/// control had no success.
std::optional<double> relative_area(const Entry& entry, const std::string& axis);
/// The entry's success in the control, over all scenarios.
double control_success(const Entry& entry);

}  // namespace lgabench::leaderboard

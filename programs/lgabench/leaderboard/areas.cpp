#include <lgabench/leaderboard/areas.hpp>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/leaderboard/units.hpp>
#include <lgabench/statistics/curves.hpp>
#include <lgabench/statistics/statistics.hpp>

namespace lgabench::leaderboard {
namespace {

// Ids of axes that have an area, and how many levels each has; none where they are not installed.
std::map<std::string, int> graded_axes() try {
  std::map<std::string, int> all;
  for (const PerturbationAxis& axis : perturbation_axes())
    if (!axis.named) all[axis.id] = axis.most();
  return all;
} catch (const InputError&) {
  return {};
}

// Every scenario's first arm alone.
std::map<std::string, ArmWeights> controls(const Setting& setting) {
  std::map<std::string, ArmWeights> all;
  for (const Setting::Scenario& scenario : setting.scenarios) all[scenario.id] = {{scenario.arms.front(), 1}};
  return all;
}

// Of the entry's success in each scenario that has one, weighted by arm, the mean.
double mean_of(const Entry& entry, const std::map<std::string, ArmWeights>& by_scenario) {
  std::map<std::string, std::vector<double>> rates;
  for (const PlayedCell& cell : Units(entry)) {
    const auto weights = by_scenario.find(cell.place.scenario);
    if (weights == by_scenario.end()) continue;
    double rate = 0;
    for (const auto& [arm, weight] : weights->second) {
      const std::string& letters = cell.outcomes.at(arm);
      rate += weight * successes(letters) / static_cast<double>(letters.size());
    }
    rates[cell.place.scenario].push_back(rate);
  }
  std::vector<double> means;
  for (const auto& scenario : rates) means.push_back(statistics::mean(scenario.second));
  return means.empty() ? 0 : statistics::mean(means);
}

}  // namespace

std::vector<std::string> axes_of(const Setting& setting) {
  std::vector<std::string> axes;
  const std::map<std::string, int> graded = graded_axes();
  for (const Setting::Scenario& scenario : setting.scenarios)
    for (const std::string& arm : scenario.arms)
      for (const auto& [axis, levels] : graded)
        if (arm == arm_of({axis, 1}) && !contains(axes, axis)) axes.push_back(axis);
  return axes;
}

ArmWeights weights_of(const Setting::Scenario& scenario, const std::string& axis) {
  const std::map<std::string, int> graded = graded_axes();
  const auto known = graded.find(axis);
  std::vector<int> levels;
  for (int level = 1; known != graded.end() && level <= known->second; ++level)
    if (contains(scenario.arms, arm_of({axis, level}))) levels.push_back(level);
  if (levels.empty()) return {};
  const std::vector<double> shares = statistics::trapezoids(levels);
  ArmWeights weights{{scenario.arms.front(), shares.front()}};
  for (std::size_t i = 0; i < levels.size(); ++i) weights[arm_of({axis, levels[i]})] = shares[i + 1];
  return weights;
}

ArmWeights weights_of(const Setting::Scenario& scenario) {
  ArmWeights all;
  int axes = 0;
  for (const auto& graded : graded_axes()) {
    const ArmWeights weights = weights_of(scenario, graded.first);
    axes += !weights.empty();
    for (const auto& [arm, weight] : weights) all[arm] += weight;
  }
  for (auto& [arm, weight] : all) weight /= axes;
  return all;
}

std::optional<double> relative_area(const Entry& entry, const std::string& axis) {
  std::map<std::string, ArmWeights> area, control = controls(entry.setting);
  for (const Setting::Scenario& scenario : entry.setting.scenarios) {
    ArmWeights weights = weights_of(scenario, axis);
    if (weights.empty())
      control.erase(scenario.id);
    else
      area[scenario.id] = std::move(weights);
  }
  const double at_first = mean_of(entry, control);
  return at_first > 0 ? std::optional(mean_of(entry, area) / at_first) : std::nullopt;
}

double control_success(const Entry& entry) { return mean_of(entry, controls(entry.setting)); }

}  // namespace lgabench::leaderboard

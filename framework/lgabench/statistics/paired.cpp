#include <lgabench/statistics/paired.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>

namespace lgabench::statistics {
namespace {

// The finished cells by policy, each a training seed of a participant.
std::map<std::pair<long long, std::string>, Cells> policies_of(const Cells& cells) {
  std::map<std::pair<long long, std::string>, Cells> policies;
  for (const CellResult* cell : cells)
    if (!cell->failed) policies[{cell->training_seed, cell->participant}].push_back(cell);
  return policies;
}

std::optional<Rate> rate_of(const std::map<std::string, Outcomes>& groups, const std::string& name) {
  Samples samples;
  for (const auto& group : groups) samples.push_back(group.second.sample());
  if (samples.empty()) return {};
  return Rate{mean_outcome(samples), success_interval(samples, name), distinct_scenes(samples)};
}

// A share over the episodes that are asked for, by scenario.
std::optional<Rate> share_of(const Cells& cells, const std::string& arm, const std::string& name,
                             const std::function<bool(const Episode&)>& counts,
                             const std::function<bool(const Episode&)>& right) {
  std::map<std::string, Outcomes> scenarios;
  for (const CellResult* cell : cells) {
    if (cell->failed) continue;
    std::vector<std::string> scenes;
    std::vector<double> outcomes;
    for (const Episode& e : cell->episodes.at(arm)) {
      if (!counts(e)) continue;
      scenes.push_back(e.scene);
      outcomes.push_back(right(e) ? 1 : 0);
    }
    if (!scenes.empty()) scenarios[cell->scenario].add(cell->participant, std::move(scenes), std::move(outcomes));
  }
  return rate_of(scenarios, name);
}

Json rate_json(const Rate& rate) {
  return {{"share", rate.share}, {"low", rate.interval.low}, {"high", rate.interval.high}, {"scenes", rate.scenes}};
}

}  // namespace

std::vector<PolicyOnPairs> pairs_of_policy(const Cells& cells, const std::string& arm) {
  using Played = std::pair<const CellResult*, const Episode*>;
  std::map<std::string, std::vector<Played>> scenes;  // by pair
  for (const CellResult* cell : cells)
    if (const auto episodes = cell->episodes.find(arm); episodes != cell->episodes.end())
      for (const Episode& e : episodes->second)
        if (!e.pair.empty()) scenes[e.pair].emplace_back(cell, &e);
  std::map<std::string, PolicyOnPairs> by_commands;
  for (const auto& [scene, played] : scenes) {
    if (played.size() != 2) continue;
    const auto& [one, first] = played[0];
    const auto& [other, second] = played[1];
    const auto [before, after] = std::minmax(one->scenario, other->scenario);
    const std::string commands = one == other ? before : fmt::format("{} + {}", before, after);
    PolicyOnPairs& pairs = by_commands[commands];
    pairs.commands = commands;
    pairs.scenes.push_back(scene);
    pairs.won.push_back(first->success() && second->success() ? 1 : 0);
  }
  std::vector<PolicyOnPairs> all;
  for (auto& item : by_commands) all.push_back(std::move(item.second));
  return all;
}

std::optional<PairedSuccess> paired_success(const Cells& cells, const std::string& arm, const std::string& name) {
  std::map<std::string, Outcomes> groups;
  for (const auto& [policy, of_policy] : policies_of(cells))
    for (PolicyOnPairs& pairs : pairs_of_policy(of_policy, arm))
      groups[pairs.commands].add(policy.second, std::move(pairs.scenes), std::move(pairs.won));
  const std::optional<Rate> rate = rate_of(groups, name);
  if (!rate) return {};
  PairedSuccess paired{*rate, {}};
  std::vector<double> values;
  for (const auto& [commands, outcomes] : groups) {
    values.push_back(outcomes.sample().mean());
    paired.by_commands.emplace_back(commands, values.back());
  }
  paired.over_commands = over_clusters(values, std::vector<double>(values.size(), 1), rate->interval);
  return paired;
}

Json to_json(const PairedSuccess& paired) {
  Json json = rate_json(paired);
  if (paired.over_commands)
    json["over_commands"] = {{"low", paired.over_commands->low}, {"high", paired.over_commands->high}};
  for (const auto& [commands, share] : paired.by_commands)
    json["by_commands"].push_back({{"commands", commands}, {"share", share}});
  return json;
}

std::optional<Course> course_of(const Cells& cells, const std::string& arm, const std::string& name) {
  Course course;
  bool any = false;
  std::map<std::string, std::vector<double>> scenarios;
  for (const CellResult* cell : cells) {
    if (cell->failed) continue;
    std::vector<double> shares;
    for (const Episode& e : cell->episodes.at(arm)) {
      any = any || e.progress;
      shares.push_back(e.progress ? e.progress->share() : 0);
      if (!e.progress || e.success()) continue;
      course.too_early += e.done;
      course.went_on += !e.done && e.progress->all_taken();
    }
    scenarios[cell->scenario].push_back(mean(shares));
  }
  if (!any) return {};
  std::vector<double> means;
  for (const auto& scenario : scenarios) means.push_back(mean(scenario.second));
  course.progress = mean(means);
  const auto refuses = [](const Episode& e) { return e.progress && e.progress->nothing_to_take(); };
  const auto takes = [&refuses](const Episode& e) { return !refuses(e); };
  const auto succeeds = [](const Episode& e) { return e.success(); };
  course.first_take = share_of(cells, arm, name + "/first_take", takes,
                               [](const Episode& e) { return e.progress && e.progress->right > 0; });
  course.refusals = share_of(cells, arm, name + "/refusals", refuses, succeeds);
  course.takings = share_of(cells, arm, name + "/takings", takes, succeeds);
  return course;
}

Json to_json(const Course& course) {
  Json json{{"progress", course.progress}, {"too_early", course.too_early}, {"went_on", course.went_on}};
  for (const auto& [member, rate] :
       {std::pair("first_take", &course.first_take), {"refusals", &course.refusals}, {"takings", &course.takings}})
    if (*rate) json[member] = rate_json(**rate);
  return json;
}

PairedRow both_on_pairs(const BothRows& policies, const std::string& arm) {
  PairedRow row;
  for (const auto& [policy, cells] : policies) {
    const std::vector<PolicyOnPairs> firsts = pairs_of_policy(cells.first, arm),
                                     seconds = pairs_of_policy(cells.second, arm);
    for (const PolicyOnPairs& first : firsts) {
      const auto second = std::find_if(seconds.begin(), seconds.end(),
                                       [&](const PolicyOnPairs& one) { return one.commands == first.commands; });
      if (second == seconds.end() || second->scenes != first.scenes) continue;
      PolicyPair pair;
      pair.scenes = first.scenes;
      pair.first = first.won;
      pair.second = second->won;
      for (std::size_t i = 0; i < pair.scenes.size(); ++i) pair.count(pair.first[i] == 1, pair.second[i] == 1);
      row.add(first.commands, pair, policy.second);
    }
  }
  return row;
}

}  // namespace lgabench::statistics

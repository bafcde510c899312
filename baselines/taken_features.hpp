// What demonstrations took, by its features: what they tell of a command without its words.
#pragma once
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/abstraction/taken_looks.hpp>
#include <lgabench/core/stations.hpp>

struct TakenFeatures {
  lgabench::TakenLooks taken, received;  // the latter: what it was brought to, where actions have stations

  void add(const lgabench::Demonstration& one, const lgabench::ActionSpace& actions) {
    for (const lgabench::Step& step : one.steps) {
      add(taken, step.observation, lgabench::taken(step, actions));
      add(received, step.observation, lgabench::receiving(step, actions));
    }
  }

 private:
  static void add(lgabench::TakenLooks& to, const lgabench::Observation& seen, std::optional<std::uint8_t> id) {
    for (const lgabench::Instance& one : seen.instances)
      if (one.id == id) to.objects.emplace_back(one.object_type, one.texture);
  }
};

inline TakenFeatures taken_by(const std::vector<lgabench::Demonstration>& shown, const lgabench::ActionSpace& actions) {
  TakenFeatures features;
  for (const lgabench::Demonstration& one : shown) features.add(one, actions);
  return features;
}

// What the demonstrations of each command took, by utterance.
inline std::map<std::string, TakenFeatures> taken_by_command(const std::vector<lgabench::Demonstration>& shown,
                                                             const lgabench::ActionSpace& actions) {
  std::map<std::string, TakenFeatures> by_command;
  for (const lgabench::Demonstration& one : shown) by_command[one.instruction.utterance].add(one, actions);
  return by_command;
}

// Of the command's demonstrations.
inline TakenFeatures taken_for(const std::string& utterance, const std::vector<lgabench::Demonstration>& shown,
                               const lgabench::ActionSpace& actions) {
  TakenFeatures features;
  for (const lgabench::Demonstration& one : shown)
    if (one.instruction.utterance == utterance) features.add(one, actions);
  return features;
}

// The set and all types and all textures of these objects, in the space's order.
inline lgabench::FeatureSet with(const lgabench::TakenLooks& features, const lgabench::FeatureSet& set,
                                 const lgabench::FeatureSpace& space) {
  std::set<std::string> types(set.object_types.begin(), set.object_types.end()),
      textures(set.textures.begin(), set.textures.end());
  for (const auto& [type, texture] : features.objects) {
    types.insert(type);
    textures.insert(texture);
  }
  const auto in_order = [](std::vector<std::string> names, const std::set<std::string>& wanted) {
    const auto other = [&wanted](const std::string& name) { return wanted.count(name) == 0; };
    names.erase(std::remove_if(names.begin(), names.end(), other), names.end());
    return names;
  };
  return {in_order(space.object_types, types), in_order(space.textures, textures)};
}

// Of the visible objects that may be taken those of the highest score, all where several are alike.
template <typename Score, typename MayBe>
lgabench::TakenLooks likest(const lgabench::Observation& observation, const Score& score, const MayBe& may_be) {
  lgabench::TakenLooks best;
  double most = 0;
  for (const lgabench::Instance& one : observation.instances) {
    if (one.pixels == 0 || lgabench::is_place(one.object_type) || !may_be(one)) continue;
    const double of_it = score(one);
    if (of_it < most) continue;
    if (of_it > most) best.objects.clear();
    most = of_it;
    best.objects.emplace_back(one.object_type, one.texture);
  }
  return best;
}

// Each look as a set of its own.
inline std::vector<lgabench::FeatureSet> sets_of(const lgabench::TakenLooks& looks) {
  std::vector<lgabench::FeatureSet> sets;
  for (const auto& [type, texture] : looks.objects) sets.push_back({{type}, {texture}});
  return sets;
}

// What demonstrations took, by its features: what they tell of a command without its words.
#pragma once
#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/stations.hpp>

// Type and texture of objects, each as often as it was taken.
struct Counts {
  std::vector<std::pair<std::string, std::string>> objects;

  bool none() const { return objects.empty(); }
  bool has(const lgabench::Instance& one) const {
    return lgabench::contains(objects, std::pair(one.object_type, one.texture));
  }
  /// (times its type + 1/2) (times its texture + 1/2), as the reference row most_demonstrated has it.
  double score(const lgabench::Instance& one) const {
    double types = .5, textures = .5;
    for (const auto& [type, texture] : objects) types += type == one.object_type, textures += texture == one.texture;
    return types * textures;
  }
};

struct TakenFeatures {
  Counts taken, received;  // the latter: what it was brought to, where actions have stations

  void add(const lgabench::Demonstration& one, const lgabench::ActionSpace& actions) {
    for (const lgabench::Step& step : one.steps) add(taken, step.observation, lgabench::taken(step, actions));
    add(received, one.steps.at(0).observation, lgabench::receiving(one, actions));
  }

 private:
  static void add(Counts& to, const lgabench::Observation& seen, std::optional<std::uint8_t> id) {
    for (const lgabench::Instance& one : seen.instances)
      if (one.id == id) to.objects.emplace_back(one.object_type, one.texture);
  }
};

inline TakenFeatures taken_by(const std::vector<lgabench::Demonstration>& shown, const lgabench::ActionSpace& actions) {
  TakenFeatures features;
  for (const lgabench::Demonstration& one : shown) features.add(one, actions);
  return features;
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
inline lgabench::FeatureSet with(const Counts& features, const lgabench::FeatureSet& set,
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

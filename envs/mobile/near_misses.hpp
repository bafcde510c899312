// Which objects stand beside the one that a command of the task fetch means.
#pragma once
#include <string>
#include <vector>

#include <lgabench/core/feature_space.hpp>
#include <lgabench/core/random.hpp>
#include <mobile/fetch.hpp>

namespace lgabench::mobile {

struct Features {
  std::string type, texture;
};
inline bool operator==(const Features& a, const Features& b) { return a.type == b.type && a.texture == b.texture; }

/// All of a scene's kind, objects or receivers, as they are in life.
const std::vector<Features>& natural_objects();
const std::vector<Features>& natural_receivers();

/// Of `all`, the features that a distribution holds.
std::vector<Features> held(const std::vector<Features>& all, const FeatureSet& distribution);

/// Of `some`, those that share one feature with `one`, and not the other.
std::vector<Features> like(const std::vector<Features>& some, const Features& one);

/// One of them: a type, with equal odds, then one of its textures. @pre there is one.
Features one_of(const std::vector<Features>& some, RandomStream& random);

/// `count` of those that may stand beside `one`, each pair of type and texture once as far as that goes.
std::vector<Features> uniform_others(const std::vector<Features>& may_be, int count, RandomStream& random);

/// `count`, up to five of them near misses: two that share the target's texture, or its type; another one that the
/// command nearly means, as `near` says, with two that share a feature with that one. So what shares most with the rest
/// is mostly no target. What is left is uniform. `meant`: the target's distribution.
std::vector<Features> near_others(const std::vector<Features>& may_be, const Features& target, const FeatureSet& meant,
                                  const common::NearMiss& near, int count, RandomStream& random);

/// Two other receivers: where the command leaves out textures of the target's type, one of those and any other; else
/// two of the target's texture.
std::vector<Features> near_receivers(const std::vector<Features>& may_be, const Features& target, RandomStream& random);

}  // namespace lgabench::mobile

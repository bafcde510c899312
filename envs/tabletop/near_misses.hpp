// Distractors that a careless abstraction keeps.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include <lgabench/core/feature_space.hpp>
#include <lgabench/core/random.hpp>
#include <tabletop/content.hpp>

namespace lgabench::tabletop {

struct Features {
  std::string type, texture;
};

/// What near misses of a target are made of.
struct NearMissRequest {
  const FeatureSet& meant;                      // by the command
  Features target;                              // which it holds
  std::vector<std::string> types, textures;     // that can be shown
  const common::NearMiss& sets;                 // what is near, where that is not all that the command leaves out
  std::function<bool(const Features&)> may_be;  // a distractor
};

/// `count` objects, or one less, that share types and textures with the target and with each other alike, so that who
/// does not hear the command cannot tell the target by what it shares (docs/protocol.md, section 3): all of the
/// target's texture and of types that the command leaves out, or all of its type and of textures that the command
/// leaves out; from three on, where it leaves out both, two types crossed with two or, from five on, three textures.
/// @throws NothingToShow where the command leaves out too little for that many.
std::vector<Features> near_misses(const NearMissRequest& request, int count, RandomStream& random);

/// Scales at which each type covers the same area, but for 15 % between the first and the last: those that objects of a
/// scene of matched sizes have.
std::vector<double> matched_scales(const std::string& type);
/// Whether the type is then at most so wide, and from a third to three times its usual size.
bool fits_matched(const std::string& type, double widest_m);

}  // namespace lgabench::tabletop

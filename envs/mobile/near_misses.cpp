#include <mobile/near_misses.hpp>

#include <algorithm>
#include <iterator>

#include <mobile/tables.hpp>

#include <lgabench/core/contains.hpp>

namespace lgabench::mobile {
namespace {

using Some = std::vector<Features>;

template <typename Is>
Some those(const Some& some, const Is& is) {
  Some kept;
  std::copy_if(some.begin(), some.end(), std::back_inserter(kept), is);
  return kept;
}

Some pairs_of(const std::map<std::string, std::vector<std::string>>& textures) {
  Some all;
  for (const auto& [type, names] : textures)
    for (const std::string& texture : names) all.push_back({type, texture});
  return all;
}

// Two that share one feature with `one` and none of which shares the other: of its texture or, with even odds, of its
// type; fewer where there are none.
Some alike(const Some& may_be, const Features& one, RandomStream& random) {
  const Some by_type = those(may_be, [&](const Features& f) { return f.type == one.type && f.texture != one.texture; });
  Some by_texture = those(may_be, [&](const Features& f) { return f.texture == one.texture && f.type != one.type; });
  const bool of_type = by_type.size() >= 2 && (by_texture.size() < 2 || random.coin());
  const Some& from = of_type ? by_type : by_texture;
  Some two;
  for (const int i : random.permutation(static_cast<int>(from.size())))
    if (two.size() < 2) two.push_back(from[static_cast<std::size_t>(i)]);
  return two;
}

}  // namespace

const std::vector<Features>& natural_objects() {
  static const Some all = pairs_of(fetch_textures());
  return all;
}

const std::vector<Features>& natural_receivers() {
  static const Some all = pairs_of(receiver_textures());
  return all;
}

std::vector<Features> held(const std::vector<Features>& all, const FeatureSet& distribution) {
  return those(all, [&](const Features& f) { return distribution.contains(f.type, f.texture); });
}

std::vector<Features> like(const std::vector<Features>& some, const Features& one) {
  return those(some, [&](const Features& f) { return (f.type == one.type) != (f.texture == one.texture); });
}

Features one_of(const std::vector<Features>& some, RandomStream& random) {
  std::vector<std::string> types;
  for (const Features& f : some)
    if (!contains(types, f.type)) types.push_back(f.type);
  const std::string type = types[random.below(static_cast<std::uint32_t>(types.size()))];
  const Some of_type = those(some, [&](const Features& f) { return f.type == type; });
  return of_type[random.below(static_cast<std::uint32_t>(of_type.size()))];
}

std::vector<Features> uniform_others(const std::vector<Features>& may_be, int count, RandomStream& random) {
  Some others;
  while (static_cast<int>(others.size()) < count) {
    const Some fresh = those(may_be, [&](const Features& f) { return !contains(others, f); });
    others.push_back(one_of(fresh.empty() ? may_be : fresh, random));
  }
  return others;
}

std::vector<Features> near_others(const std::vector<Features>& may_be, const Features& target, const FeatureSet& meant,
                                  const common::NearMiss& near, int count, RandomStream& random) {
  const Some first = alike(may_be, target, random);
  const Some free = those(may_be, [&](const Features& f) { return !contains(first, f); });
  Some nearly = those(free, [&](const Features& f) {
    const bool type = contains(meant.object_types, f.type);
    return near.object_types.empty() && near.textures.empty()
               ? type || contains(meant.textures, f.texture)
               : contains(near.object_types, f.type) || (type && contains(near.textures, f.texture));
  });
  Some all;
  if (!first.empty()) all.push_back(first[0]);
  if (!nearly.empty()) {
    const Features decoy = one_of(nearly, random);
    const Some second = alike(those(free, [&](const Features& f) { return !(f == decoy); }), decoy, random);
    all.push_back(decoy);
    if (!second.empty()) all.push_back(second[0]);
    if (first.size() > 1) all.push_back(first[1]);
    if (second.size() > 1) all.push_back(second[1]);
  } else if (first.size() > 1) {
    all.push_back(first[1]);
  }
  if (all.size() > static_cast<std::size_t>(count)) all.resize(static_cast<std::size_t>(count));
  const Some fresh = those(may_be, [&](const Features& f) { return !contains(all, f); });
  for (const Features& more : uniform_others(fresh, count - static_cast<int>(all.size()), random)) all.push_back(more);
  return all;
}

std::vector<Features> near_receivers(const std::vector<Features>& may_be, const Features& target,
                                     RandomStream& random) {
  const Some wrong = those(may_be, [&](const Features& f) { return f.type == target.type; });
  if (wrong.empty())  // every texture of one type is another's too, but for stains
    return uniform_others(those(may_be, [&](const Features& f) { return f.texture == target.texture; }), 2, random);
  const Features one = one_of(wrong, random);
  const Some others = those(may_be, [&](const Features& f) { return f.type != target.type; });
  return {one, one_of(others, random)};
}

}  // namespace lgabench::mobile

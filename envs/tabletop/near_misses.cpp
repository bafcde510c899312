#include <tabletop/near_misses.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <common/objects.hpp>
#include <lgabench/core/environments.hpp>

#include <lgabench/core/contains.hpp>

namespace lgabench::tabletop {
namespace {

using Names = std::vector<std::string>;

// "red swirl" for "red paisley": textures of the same colours in another pattern, which are easily taken for each
// other.
Names alike(const std::string& texture, const Names& shown) {
  constexpr std::array pairs{std::pair{" stripe", " polka dot"}, std::pair{" swirl", " paisley"}};
  Names all;
  for (const auto& [one, other] : pairs)
    for (const auto& [from, to] : {std::pair(std::string(one), other), std::pair(std::string(other), one)})
      if (texture.size() > from.size() && texture.compare(texture.size() - from.size(), from.size(), from) == 0)
        if (const std::string like = texture.substr(0, texture.size() - from.size()) + to; contains(shown, like))
          all.push_back(like);
  return all;
}

// Names that a command leaves out: those that the scenario calls near, and the others.
struct LeftOut {
  LeftOut(const Names& shown, const Names& meant, const Names& called_near) {
    for (const std::string& name : shown)
      if (!contains(meant, name)) (called_near.empty() || contains(called_near, name) ? near : others).push_back(name);
  }

  bool suffices(std::size_t count) const { return !near.empty() && near.size() + others.size() >= count; }

  // Different ones, near ones as far as they go. @pre suffices(count)
  Names draw(std::size_t count, RandomStream& random) const {
    Names drawn;
    for (const Names* some : {&near, &others})
      for (const int i : random.permutation(static_cast<int>(some->size())))
        if (drawn.size() < count) drawn.push_back((*some)[static_cast<std::size_t>(i)]);
    return drawn;
  }

  Names near, others;
};

std::vector<Features> attempt(const Features& target, const LeftOut& types, const LeftOut& textures, std::size_t count,
                              RandomStream& random) {
  const bool by_type = types.suffices(count), by_texture = textures.suffices(count);
  std::vector<Features> all;
  const std::size_t crossed = count < 5 ? 1 : 2;
  if (count >= 3 && types.suffices(1) && textures.suffices(crossed)) {
    const std::string type = types.draw(1, random).front();
    all.push_back({type, target.texture});
    for (const std::string& texture : textures.draw(crossed, random)) {
      all.push_back({target.type, texture});
      all.push_back({type, texture});
    }
  } else if (by_type && (!by_texture || random.coin())) {
    for (const std::string& type : types.draw(count, random)) all.push_back({type, target.texture});
  } else if (by_texture) {
    for (const std::string& texture : textures.draw(count, random)) all.push_back({target.type, texture});
  }
  return all;
}

}  // namespace

std::vector<double> matched_scales(const std::string& type) {
  constexpr double area_m2 = .008;  // what compact types cover at .09 in width
  std::vector<double> scales;       // few, since an engine loads a model for each
  for (const double share : {.93, 1., 1.07})
    scales.push_back(std::round(1000 * std::sqrt(share * area_m2 / common::covered_area_m2(type))) / 1000);
  return scales;
}

bool fits_matched(const std::string& type, double widest_m) {
  const std::vector<double> scales = matched_scales(type);
  const Vec2 size = common::object_model(type).size_m;
  return scales.front() >= 1. / 3 && scales.back() <= 3 && scales.back() * std::max(size.x, size.y) <= widest_m + 1e-9;
}

std::vector<Features> near_misses(const NearMissRequest& r, int count, RandomStream& random) {
  constexpr int tries = 200;
  if (count == 0) return {};
  const LeftOut types(r.types, r.meant.object_types, r.sets.object_types),
      textures(r.textures, r.meant.textures, r.sets.alike ? alike(r.target.texture, r.textures) : r.sets.textures);
  for (int i = 0; i < tries; ++i) {
    std::vector<Features> all = attempt(r.target, types, textures, static_cast<std::size_t>(count), random);
    if (!all.empty() && std::all_of(all.begin(), all.end(), r.may_be)) return all;
  }
  throw NothingToShow(
      fmt::format("near_miss: expected a command that leaves out types or textures for {} near misses of a {} {}, "
                  "got {} and {} that can be shown",
                  count, r.target.texture, r.target.type, types.near.size() + types.others.size(),
                  textures.near.size() + textures.others.size()));
}

}  // namespace lgabench::tabletop

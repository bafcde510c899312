#include <tabletop/near_misses.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <iterator>

#include <common/sampling.hpp>
#include <lgabench/core/environments.hpp>

namespace lgabench::tabletop {
namespace {

using Names = std::vector<std::string>;

bool has(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Names that a command leaves out, and those of them that a near miss must have.
struct LeftOut {
  LeftOut(const Names& shown, const Names& meant, const Names& named) {
    std::copy_if(shown.begin(), shown.end(), std::back_inserter(all), [&](const auto& n) { return !has(meant, n); });
    std::copy_if(all.begin(), all.end(), std::back_inserter(first),
                 [&](const auto& n) { return named.empty() || has(named, n); });
  }

  bool suffices(std::size_t count) const { return !first.empty() && all.size() >= count; }

  // Different ones, of which the first must be. @pre suffices(count)
  Names draw(std::size_t count, RandomStream& random) const {
    Names drawn{common::any_of(first, random)};
    for (const int i : random.permutation(static_cast<int>(all.size()))) {
      if (drawn.size() == count) break;
      if (const std::string& name = all[static_cast<std::size_t>(i)]; name != drawn.front()) drawn.push_back(name);
    }
    return drawn;
  }

  Names all, first;
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

std::vector<Features> near_misses(const NearMissRequest& r, int count, RandomStream& random) {
  constexpr int tries = 200;
  if (count == 0) return {};
  const LeftOut types(r.types, r.meant.object_types, r.sets.object_types),
      textures(r.textures, r.meant.textures, r.sets.textures);
  for (int i = 0; i < tries; ++i) {
    std::vector<Features> all = attempt(r.target, types, textures, static_cast<std::size_t>(count), random);
    if (!all.empty() && std::all_of(all.begin(), all.end(), r.may_be)) return all;
  }
  throw NothingToShow(
      fmt::format("near_miss: expected a command that leaves out types or textures for {} near misses of a {} {}, "
                  "got {} and {} that can be shown",
                  count, r.target.texture, r.target.type, types.all.size(), textures.all.size()));
}

}  // namespace lgabench::tabletop

#include <lgabench/drawn/extent.hpp>

#include <algorithm>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/meaning.hpp>

namespace lgabench::drawn {
namespace {

Holds held(const std::string& name, const std::vector<std::string>& yes, const std::vector<std::string>& undecided) {
  return contains(yes, name) ? Holds::yes : contains(undecided, name) ? Holds::undecided : Holds::no;
}

}  // namespace

Extent of_types(const FeatureSpace& space, const std::vector<std::string>& yes,
                const std::vector<std::string>& undecided) {
  Extent extent;
  for (const std::string& type : space.object_types)
    extent.insert(extent.end(), space.textures.size(), held(type, yes, undecided));
  return extent;
}

Extent of_textures(const FeatureSpace& space, const std::vector<std::string>& yes,
                   const std::vector<std::string>& undecided) {
  Extent row, extent;
  for (const std::string& texture : space.textures) row.push_back(held(texture, yes, undecided));
  for (std::size_t i = 0; i < space.object_types.size(); ++i) extent.insert(extent.end(), row.begin(), row.end());
  return extent;
}

Extent both(const Extent& a, const Extent& b) {
  Extent extent(a.size());
  std::transform(a.begin(), a.end(), b.begin(), extent.begin(), [](Holds x, Holds y) { return std::min(x, y); });
  return extent;
}

Extent either(const Extent& a, const Extent& b) {
  Extent extent(a.size());
  std::transform(a.begin(), a.end(), b.begin(), extent.begin(), [](Holds x, Holds y) { return std::max(x, y); });
  return extent;
}

Extent none_of(Extent a) {
  for (Holds& value : a) value = static_cast<Holds>(2 - static_cast<int>(value));
  return a;
}

Extent where(Extent extent, Holds value) {
  for (Holds& one : extent) one = one == value ? Holds::yes : Holds::no;
  return extent;
}

bool is_empty(const Extent& extent) { return !contains(extent, Holds::yes); }

std::vector<FeatureSet> sets_of(const FeatureSpace& space, const Extent& extent, Holds value) {
  std::vector<FeatureSet> sets;
  for (std::size_t t = 0; t < space.object_types.size(); ++t) {
    std::vector<std::string> textures;
    if (is_place(space.object_types[t])) continue;
    for (std::size_t x = 0; x < space.textures.size(); ++x)
      if (extent[t * space.textures.size() + x] == value) textures.push_back(space.textures[x]);
    if (textures.empty()) continue;
    const auto same =
        std::find_if(sets.begin(), sets.end(), [&textures](const FeatureSet& set) { return set.textures == textures; });
    if (same != sets.end())
      same->object_types.push_back(space.object_types[t]);
    else
      sets.push_back({{space.object_types[t]}, std::move(textures)});
  }
  return sets;
}

}  // namespace lgabench::drawn

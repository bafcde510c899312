#include <lgabench/abstraction/taken_looks.hpp>

#include <algorithm>
#include <numeric>

#include <lgabench/core/contains.hpp>

namespace lgabench {

bool TakenLooks::has(const Instance& one) const { return contains(objects, std::pair(one.object_type, one.texture)); }

double TakenLooks::counted(const Instance& one) const {
  double types = .5, textures = .5;
  for (const auto& [type, texture] : objects) types += type == one.object_type, textures += texture == one.texture;
  return types * textures;
}

double alike_in_name(const Instance& one, const TakenLooks& taken, const EmbeddingOf& embedding) {
  if (taken.none()) return taken.counted(one);
  const auto similarity = [&embedding](const std::string& a, const std::string& b) {
    const std::vector<float>&x = embedding(a), &y = embedding(b);
    return std::inner_product(x.begin(), x.end(), y.begin(), 0.);
  };
  double types = 0, textures = 0;
  for (const auto& [type, texture] : taken.objects) {
    types += similarity(one.object_type, type);
    textures += similarity(one.texture, texture);
  }
  const auto count = static_cast<double>(taken.objects.size());
  return taken.counted(one) * std::max(types / count, 0.) * std::max(textures / count, 0.);
}

}  // namespace lgabench

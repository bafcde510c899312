#include "labels.hpp"

#include <algorithm>
#include <numeric>

namespace lgabench {
namespace {

template <class Map, class Key>
double times(const Map& counts, const Key& key) {
  const auto found = counts.find(key);
  return found == counts.end() ? 0 : found->second;
}

}  // namespace

Labels::Seen::Seen(const std::vector<Named>& all) {
  for (const Named& one : all)
    ++types[one.object_type], ++textures[one.texture], ++both[{one.object_type, one.texture}];
}

Labels::Labels(Rule rule, const std::vector<Named>& taken, const std::vector<Named>& left, EmbeddingOf embedding)
    : rule_(rule), embedding_(std::move(embedding)), taken_(taken), left_(left), count_(taken.size()) {
  std::vector<std::pair<double, bool>> scored;  // and whether it was taken
  for (const Named& one : left) scored.emplace_back(score(one), false);
  for (const Named& one : taken) scored.emplace_back(score(one), true);
  std::sort(scored.begin(), scored.end());
  double right = 1, most = 0;  // shares of what was taken and of what was left that are on their side of a score
  for (std::size_t i = 0; i < scored.size(); ++i) {
    const auto [score, was_taken] = scored[i];
    if (right > most && (i == 0 || score > scored[i - 1].first)) {
      most = right;
      least_ = score;
    }
    right += was_taken ? -1. / static_cast<double>(taken.size()) : 1. / static_cast<double>(left.size());
  }
}

double Labels::score(const Named& one) const {
  const double types = times(taken_.types, one.object_type), textures = times(taken_.textures, one.texture);
  const double counts = (types + .5) * (textures + .5);
  switch (rule_) {
    case Rule::names:
      return counts * alike(Part::object_type, one.object_type) * alike(Part::texture, one.texture);
    case Rule::bayes: {
      const auto both = std::pair(one.object_type, one.texture);
      return counts * (times(taken_.both, both) + .5) / (times(left_.types, one.object_type) + .5) /
             (times(left_.textures, one.texture) + .5) / (times(left_.both, both) + .5);
    }
    case Rule::part:
      return taken_.textures.size() < taken_.types.size() ? textures : types;
    case Rule::counts:
      break;
  }
  return counts;
}

double Labels::alike(Part part, const std::string& name) const {
  const auto [known, is_new] = alike_.try_emplace({part, name}, 0);
  if (is_new) {
    const std::vector<float> of_name = embedding_(name);
    double sum = 0;
    for (const auto& [other, count] : part == Part::object_type ? taken_.types : taken_.textures) {
      const std::vector<float>& of_other = embedding_(other);
      sum += count * std::inner_product(of_name.begin(), of_name.end(), of_other.begin(), 0.);
    }
    known->second = std::max(sum / static_cast<double>(count_), 0.);
  }
  return known->second;
}

std::vector<FeatureSet> Labels::in(const FeatureSpace& space) const {
  std::vector<FeatureSet> sets;
  for (const std::string& type : space.object_types) {
    if (is_place(type)) continue;
    std::vector<std::string> textures;
    for (const std::string& texture : space.textures)
      if (belongs({type, texture})) textures.push_back(texture);
    if (textures.empty()) continue;
    const auto same =
        std::find_if(sets.begin(), sets.end(), [&](const FeatureSet& s) { return s.textures == textures; });
    if (same != sets.end())
      same->object_types.push_back(type);
    else
      sets.push_back({{type}, std::move(textures)});
  }
  if (sets.empty()) sets.emplace_back();
  return sets;
}

}  // namespace lgabench

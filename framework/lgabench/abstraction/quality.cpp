#include <lgabench/abstraction/quality.hpp>

#include <algorithm>

namespace lgabench {
namespace {

Json quality(const std::vector<std::string>& selected, const std::vector<std::string>& truth) {
  const auto right = std::count_if(selected.begin(), selected.end(), [&](const std::string& name) {
    return std::find(truth.begin(), truth.end(), name) != truth.end();
  });
  const auto share = [right](std::size_t of) {
    return of == 0 ? Json() : Json(static_cast<double>(right) / static_cast<double>(of));
  };
  return {{"precision", share(selected.size())},
          {"recall", share(truth.size())},
          {"size", selected.size()},
          {"true_size", truth.size()}};
}

Json quality(const FeatureSet& selected, const FeatureSet& truth) {
  return {{"object_types", quality(selected.object_types, truth.object_types)},
          {"textures", quality(selected.textures, truth.textures)}};
}

}  // namespace

Json quality(const Selection& selection, const Selection& truth) {
  if (selection.provenance == Provenance::none) return nullptr;
  Json json{{"target", quality(selection.target, truth.target)}};
  if (selection.second || truth.second) {
    const FeatureSet nothing;
    json[(truth.second ? truth : selection).second->role] =
        quality(selection.second ? *selection.second : nothing, truth.second ? *truth.second : nothing);
  }
  return json;
}

}  // namespace lgabench

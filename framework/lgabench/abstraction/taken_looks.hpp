// What was taken, by the names of its types and textures: how well another object's names go with it.
#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/observation.hpp>

namespace lgabench {

/// Type and texture of objects, each as often as it was taken.
struct TakenLooks {
  std::vector<std::pair<std::string, std::string>> objects;

  bool none() const { return objects.empty(); }
  bool has(const Instance& one) const;
  /// (times its type was taken + 1/2) x (times its texture was + 1/2)
  double counted(const Instance& one) const;
};

/// A sentence's embedding, of norm 1.
using EmbeddingOf = std::function<const std::vector<float>&(const std::string&)>;

/// What the names of looks mean, as a sentence encoder has it: no command is read, and there is nothing to choose.
/// counted(), times the mean similarity of its type to the types that were taken, times that of its texture to the
/// textures. A similarity is the cosine of the names' embeddings, and a mean below 0 is 0. counted() where nothing was
/// taken.
double alike_in_name(const Instance& one, const TakenLooks& taken, const EmbeddingOf& embedding);

}  // namespace lgabench

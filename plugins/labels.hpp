// What belongs to a command, by the names of what demonstrations took and of what they left on the table.
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/abstraction/taken_looks.hpp>
#include <lgabench/core/meaning.hpp>

namespace lgabench {

/// One rule for what belongs. One thread.
class Labels {
 public:
  enum class Rule {
    counts,  // TakenLooks::counted()
    names,   // alike_in_name()
    bayes,   // the product, over type, texture and both together, of (times taken + 1/2) / (times left + 1/2)
    part     // how often its type was taken or, where fewer textures than types were, its texture
  };
  /// `embedding` is asked by Rule::names alone, and outlives this.
  Labels(Rule rule, const std::vector<Named>& taken, const std::vector<Named>& left, EmbeddingOf embedding);

  /// Whether it scores as much as what was taken does: from the score on that tells what was taken from what was left
  /// with the fewest errors, both weighing alike.
  bool belongs(const Named& one) const { return score(one) >= least_; }
  /// All that belongs, in the space's order: one set for each list of textures. Of nothing that belongs, one empty set.
  std::vector<FeatureSet> in(const FeatureSpace& space) const;

 private:
  using Counts = std::map<std::string, double>;  // by name
  struct Seen {
    Counts types, textures;
    std::map<std::pair<std::string, std::string>, double> both;
    explicit Seen(const std::vector<Named>& all);
  };

  double score(const Named& one) const;
  double alike(Part part, const std::string& name) const;

  Rule rule_;
  EmbeddingOf embedding_;
  Seen taken_, left_;
  std::size_t count_;  // of what was taken
  double least_ = 0;
  mutable std::map<std::pair<Part, std::string>, double> alike_;  // what was computed once
};

}  // namespace lgabench

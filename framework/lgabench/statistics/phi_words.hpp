// A Selection in words, beside what its scenario's author meant.
#pragma once
#include <string>
#include <vector>

#include <lgabench/statistics/results.hpp>

namespace lgabench::statistics {

/// One kind of feature of one set of objects; each list in the order of the feature space.
struct PhiWords {
  std::string about, feature;                     // "target", ...; "object types", "textures"; "meaning"
  std::vector<std::string> right, missed, wrong;  // selected and true; true alone; selected alone
  std::size_t known = 0;                          // names that the feature space has
};

/// Words for one of the cell's commands; empty for a method that selects nothing, and where the installed data lack the
/// scenario's feature space.
std::vector<PhiWords> phi_words(const CellResult& cell, const CommandResult& command);

/// "heart, ring", "any of 83", "a, b, c and 70 more", "–".
std::string listed(const std::vector<std::string>& names, std::size_t known);

}  // namespace lgabench::statistics

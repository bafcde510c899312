// How ids are written and ordered in tables and figures.
#pragma once
#include <string>
#include <vector>

namespace lgabench::report {

/// "lga_hill" -> "LGA-HILL", as the paper writes it; an id that is not known is its own name.
std::string display_name(const std::string& method);

/// Position in tables: the paper's methods in its order, then others (equal rank: by id), then reference rows.
int display_rank(const std::string& method);

/// Line colour as #rrggbb (Okabe and Ito's palette, told apart by colour-blind readers). `index` is taken for a method
/// that has none of its own.
std::string display_color(const std::string& method, std::size_t index);

/// A Selection's provenance in words for a reader, e.g. "true φ̂: an upper bound, no human data"; "" for none.
std::string provenance_words(const std::string& provenance);

}  // namespace lgabench::report

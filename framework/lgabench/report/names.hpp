// How methods are written and ordered in tables and figures.
#pragma once
#include <string>
#include <vector>

namespace lgabench::report {

// A method is named by its row: its id, and "+option=value" where options tell it from other rows of that id.

/// "lga_hill" -> "LGA-HILL", as the paper writes it; "lga+loss=squared" -> "LGA loss=squared". An id that is not known
/// stays as it is.
std::string display_name(const std::string& method);

/// Position in tables, by id: the paper's methods in its order, then others (equal rank: by name), then reference rows.
int display_rank(const std::string& method);

/// Line colour of the id as #rrggbb (Okabe and Ito's palette, told apart by colour-blind readers). `index` is taken for
/// a method that has none of its own.
std::string display_color(const std::string& method, std::size_t index);

/// A Selection's provenance in words for a reader, e.g. "true φ̂: an upper bound, no human data"; "" for none.
std::string provenance_words(const std::string& provenance);

/// Whether two wordings differ by more than a final full stop.
bool worded_otherwise(const std::string& asked_as, const std::string& utterance);

}  // namespace lgabench::report

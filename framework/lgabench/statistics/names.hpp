// Writes, orders and draws methods in the same way in every table and figure.
#pragma once
#include <map>
#include <string>
#include <vector>

namespace lgabench::statistics {

// A method is named by its row: its id, and "+option=value" where options tell it from other rows of that id. The
// names, order, colours and marks of the paper's methods are data (results/paper/methods.json).

/// What display_name() takes for the row `human` of a run in which no person took part: "True mask".
inline constexpr const char* true_mask_row = "true_mask";

/// "lga_hill" -> "LGA-HILL", as the paper writes it; "lga+loss=squared" -> "LGA loss=squared". An id that is not known
/// stays as it is.
std::string display_name(const std::string& method);

/// A text with words for the ids in it, as pages have it: "gcbc_seg" -> "GCBC-SEG", "policy=heat_map" -> "with a heat
/// map", other "_" and "=" inside an id -> spaces. What is quoted, and names of files and options, stay.
std::string readable(const std::string& text);

/// The text with a capital first.
std::string capital(std::string text);

/// Position in tables, by id: first the paper's methods in its order, then others (by name), then reference rows.
int display_rank(const std::string& method);

/// Orders rows' names as tables do.
struct ByRank {
  bool operator()(const std::string& a, const std::string& b) const;
};

/// What tells a row from other rows in figures.
struct MethodStyle {
  std::string colour;  // #rrggbb; "" for a reference row, which is grey
  int sides = 0;       // of its mark, a regular polygon; 0 for a circle
  double turned = 0;   // degrees, of a corner, clockwise from the right
  bool hollow = false;
  std::vector<double> dashes{};

  bool reference() const { return colour.empty(); }
};

/// The styles of a run's rows: a method's own; the second variant of a method has its mark hollow; a method that has
/// none of its own takes a spare one.
class MethodStyles {
 public:
  /// `shown_names`: a row's name -> the name that readers are shown in its place.
  explicit MethodStyles(const std::vector<std::string>& methods = {},
                        std::map<std::string, std::string> shown_names = {});
  /// What readers are shown of a row's name.
  std::string name(const std::string& method) const;
  /// The style of a row; a reference row's for a name that is none of `methods`.
  const MethodStyle& operator()(const std::string& method) const;

 private:
  std::map<std::string, MethodStyle> styles_;
  std::map<std::string, std::string> told_;
};

/// A Selection's provenance in words for a reader, e.g. "true φ̂: no human data"; "" for none.
/// `erring`: errors were made in it on purpose.
std::string provenance_words(const std::string& provenance, bool erring);

/// Whether somebody was asked each question that a Selection counts. Of the shipped answers GPT-4's were; Claude's are
/// lists that were written in one pass (the files say how), though a row counts a question a candidate.
/// `source`: the model, as the Selection names it.
bool was_asked(const std::string& provenance, const std::string& source);

/// Whether two wordings differ by more than a final full stop. `asked_as`: "" where nobody was asked.
bool worded_otherwise(const std::string& asked_as, const std::string& utterance);

}  // namespace lgabench::statistics

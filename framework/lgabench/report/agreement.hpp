// Does a cell that was computed again agree with what was recorded?
#pragma once
#include <string>

#include <lgabench/core/files.hpp>

namespace lgabench::report {

enum class Agreement {
  identical,        // every byte of what holds no clock
  same_outcomes,    // every episode won or failed as recorded; actions or training differ
  within_interval,  // some episodes ended otherwise, in each arm no more of them one way than chance allows
  differs
};
/// "bit-identical", "same outcomes", "within interval", "differs"
std::string to_string(Agreement agreement);

struct CellAgreement {
  Agreement agreement = Agreement::differs;
  std::string detail;  // what differs first, in one line; empty where nothing does
};

/// Compares the directories of two finished cells. `excused`: build, processor or data are not those of the record.
/// Without that the same bytes are owed, and anything else differs. What was selected is not a matter of numerics: it
/// differs, excused or not. By chance: McNemar's exact p of each arm, Holm's over the arms, above .05.
/// @throws InputError for files that are not as docs/formats says.
CellAgreement compare_cells(const fs::path& recorded, const fs::path& recomputed, bool excused);

}  // namespace lgabench::report

// Compares cells that were computed again with the recorded ones.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/files.hpp>
#include <lgabench/statistics/statistics.hpp>

namespace lgabench::statistics {

enum class Agreement {
  identical,       // every byte of the files without times
  same_outcomes,   // every episode succeeded or failed as recorded; actions or training differ
  other_outcomes,  // some episodes ended differently: whether they are few enough, the verdict over all cells says
  differs          // the same bytes are owed, or nothing can be compared: another Selection, scene or arm
};
/// "bit-identical", "same outcomes", "other outcomes", "differs"
std::string to_string(Agreement agreement);

struct CellAgreement {
  Agreement agreement = Agreement::differs;
  std::string detail;  // what differs first, in one line; empty where nothing does
  // Episodes, over all arms, and those that succeeded in one of them alone. Of outcomes that can be compared; else 0.
  int only_recorded = 0, only_recomputed = 0, episodes = 0;
};

/// Compares the directories of two finished cells. `excused`: build or data are not those of the record, or the
/// processors owe no equal bits (owe_same_bits()). Otherwise the cells must be bit-identical. Selections do not depend
/// on numerics: unequal ones differ, excused or not. Attributions are compared where both have some.
/// @throws InputError for files that are not as docs/formats says.
CellAgreement compare_cells(const fs::path& recorded, const fs::path& recomputed, bool excused);

/// Cells in which episodes ended differently, pooled. Episodes of one cell are one policy's, so they change together:
/// what is counted for chance are cells.
struct PooledAgreement {
  std::string row;  // "" over all rows
  int cells = 0, only_recorded = 0, only_recomputed = 0;
  int worse = 0, better = 0;  // cells in which fewer or more episodes succeeded than in the record
  double p_holm = 1;          // sign test over these cells, Holm's p over the rows and all rows

  void add(const CellAgreement& cell);
  bool differs() const { return p_holm <= alpha; }
};

/// How many of so many episodes may end otherwise where cells need not be bit-identical, as on a processor that owes no
/// equal bits: 1 %, and of fewer than 1,000, which a single cell's policy can change, up to ten, at most 4 %.
double most_flips(int episodes);

/// The verdict on all cells that were computed again.
enum class Reproduction {
  identical,  // every cell, to the bit
  agrees,     // at most most_flips() episodes ended differently, and no more cells one way than chance allows
  differs
};
/// "identical", "agrees", "differs"
std::string to_string(Reproduction verdict);

/// The one rule for `verify` and the leaderboard. By chance: no row of pooled() differs, nor all rows together.
/// `cells`: row and agreement. @pre not empty
Reproduction verdict_of(const std::vector<std::pair<std::string, CellAgreement>>& cells);
/// The verdict on cells that are not all identical, and may differ.
Reproduction verdict_of(int flips, int episodes, const std::vector<PooledAgreement>& rows);

/// Pools the cells of each row in which an episode changed, by name, and all of them where there are several such rows.
/// `cells`: row and agreement.
std::vector<PooledAgreement> pooled(const std::vector<std::pair<std::string, CellAgreement>>& cells);

}  // namespace lgabench::statistics

#include <lgabench/leaderboard/add.hpp>

#include <fmt/format.h>

#include <lgabench/core/contains.hpp>
#include <lgabench/harness/answers.hpp>
#include <lgabench/leaderboard/row_entries.hpp>

namespace lgabench::leaderboard {
namespace {

// Whether two entries of one identity tell the same of every cell, clocks and builds aside.
int other_cells(const Entry& there, const Entry& here) {
  int differing = 0;
  for (std::size_t i = 0; i < there.cells.size(); ++i) {
    const PlayedCell &a = there.cells[i], &b = here.cells[i];
    differing += a.outcomes != b.outcomes || a.scenes != b.scenes || a.failed.empty() != b.failed.empty();
  }
  return differing;
}

// The answers that an entry is based on, kept beside the entries for whoever verifies it.
std::vector<AnswerFile> answers_of(const fs::path& run, const Entry& entry) {
  std::vector<AnswerFile> files;
  for (AnswerFile& file : kept_answers(run))
    if (file.name == answers_file(entry.identity).filename()) files.push_back(std::move(file));
  return files;
}

}  // namespace

Added add_run(const fs::path& board, const fs::path& directory, const Json& about,
              const std::vector<std::string>& wanted) {
  Added added;
  RowEntries rows = row_entries(directory, about, wanted);
  added.refused = std::move(rows.refused);
  std::vector<Entry> entries, known;
  std::vector<std::string> there_already;  // of a run that was added in part, when `add` was killed
  for (Entry& entry : rows.entries) {
    if (!fs::exists(board / entry.place())) {
      entries.push_back(std::move(entry));
      continue;
    }
    Entry there = read_entry(board, entry.place());
    const Json evidence = entry.evidence.front();
    const bool is_there = contains(there.evidence, evidence);
    if (const int differing = other_cells(there, entry))
      added.refused.push_back(fmt::format("{}: this identity is on the board, with other outcomes in {} of {} cells",
                                          entry.place().string(), differing, there.cells.size()));
    else if (!there.withdrawn.is_null())
      added.refused.push_back(fmt::format("{}: this identity was withdrawn", entry.place().string()));
    else if (is_there)
      there_already.push_back(fmt::format("{}: this run is on the board already", entry.place().string()));
    if (is_there) continue;
    there.evidence.push_back(evidence);
    known.push_back(std::move(there));
  }
  if (added.refused.empty() && entries.empty() && known.empty()) added.refused = there_already;
  if (!added.refused.empty()) return added;
  for (const Entry& entry : entries) {
    write_entry(board, entry, answers_of(directory, entry));
    read_entry(board, entry.place());  // what is written is what every reader takes
    added.entries.push_back(entry.place().string());
  }
  for (const Entry& entry : known) {
    write_entry(board, entry);
    added.evidence.push_back(entry.place().string());
  }
  return added;
}

}  // namespace lgabench::leaderboard

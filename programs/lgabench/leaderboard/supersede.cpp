#include <lgabench/leaderboard/supersede.hpp>

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include <lgabench/leaderboard/row_entries.hpp>
#include <lgabench/leaderboard/scenes.hpp>
#include <lgabench/leaderboard/superseded.hpp>

namespace lgabench::leaderboard {
namespace {

bool same_results(const Entry& there, const Entry& here) {
  return std::equal(there.cells.begin(), there.cells.end(), here.cells.begin(), here.cells.end(),
                    [](const PlayedCell& a, const PlayedCell& b) {
                      return a.outcomes == b.outcomes && a.digest == b.digest && a.failed.empty() == b.failed.empty();
                    });
}

// The entry of the row on the board, in whose place it goes; else why it does not, as a reason.
Entry entry_on(const fs::path& board, const Entry& row, std::vector<std::string>& reasons) {
  const std::string place = row.place().string();
  if (!fs::exists(board / row.place())) {
    reasons.push_back(place + ": not on the board, so there is nothing to supersede; leaderboard add takes the row");
    return row;
  }
  Entry there = read_entry(board, row.place());
  if (!there.withdrawn.is_null()) reasons.push_back(place + ": this identity was withdrawn");
  if (const std::string other = other_cell(there, row); !other.empty())
    reasons.push_back(fmt::format("{}: {}", place, other));
  return there;
}

// What the row says of its cells, in the entry's words.
Entry successor(const Entry& there, Entry row, const std::string& reason, const std::string& when) {
  row.about = there.about;
  row.score = there.score;  // of the answers, which are the same
  row.supersedes = there.supersedes;
  row.supersedes.push_back({{"hash", there.hash()}, {"when", when}, {"reason", reason}});
  return row;
}

void exchange(const fs::path& one, const fs::path& other) {
  if (::renameat2(AT_FDCWD, one.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) != 0)
    throw InputError(fmt::format("{}: cannot be replaced: {}", other.string(), std::strerror(errno)));
}

// The last step alone changes the entry: before it, a call that was killed can be given again.
void replace(const fs::path& board, const Entry& there, const Entry& now) {
  const fs::path adding = board / adding_directory, place = there.place(),
                 kept = superseded_place(there.id(), there.hash());
  forget(board, there);
  drop_scenes(board, there.id());
  for (const char* file : entry_files)
    if (fs::exists(board / place / file)) write_file(adding / kept / file, read_file(board / place / file));
  fs::remove_all(board / kept);  // of a call that was killed
  fs::create_directories((board / kept).parent_path());
  fs::rename(adding / kept, board / kept);
  write_file(adding / place / "cells.jsonl", cells_text(now));
  write_file(adding / place / "entry.json", entry_text(now));
  exchange(adding / place, board / place);
}

}  // namespace

Superseded supersede(const fs::path& board, const fs::path& run, const std::vector<std::string>& wanted,
                     const std::string& by, const std::string& reason, const std::string& when) {
  if (!is_reason(reason)) throw InputError(fmt::format("--reason: expected 1 to {} bytes in one line", longest_reason));
  Superseded done;
  RowEntries rows = row_entries(run, {{"by", by}}, wanted);
  done.refused = std::move(rows.refused);
  std::vector<std::pair<Entry, Entry>> pairs;  // the entry, and what takes its place
  for (Entry& row : rows.entries) {
    const std::size_t before = done.refused.size();
    Entry there = entry_on(board, row, done.refused);
    if (done.refused.size() > before) continue;
    if (same_results(there, row)) {
      done.same.push_back(row.place().string());
      continue;
    }
    Entry now = successor(there, std::move(row), reason, when);
    pairs.emplace_back(std::move(there), std::move(now));
  }
  if (!done.refused.empty()) {
    done.same.clear();
    return done;
  }
  const BoardWriter writer(board);
  for (const auto& [there, now] : pairs) {
    replace(board, there, now);
    read_entry(board, now.place());  // what is written is what every reader takes
    done.entries.push_back(now.place().string());
  }
  return done;
}

}  // namespace lgabench::leaderboard

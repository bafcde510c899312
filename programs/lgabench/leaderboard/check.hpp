// What continuous integration runs over the board: files alone, nothing is played.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/files.hpp>
#include <lgabench/leaderboard/labels.hpp>
#include <lgabench/leaderboard/scenes.hpp>
#include <lgabench/leaderboard/tracks.hpp>
#include <lgabench/leaderboard/vouched.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench::leaderboard {

struct Checked {
  std::size_t entries = 0;
  std::vector<std::string> problems;  // a line each
};

/// Files of the board that nobody else's request may change.
inline constexpr std::array maintainers_files{vouched_file, vouched_entries_file, instructions_file,
                                              labels_file,  tracks_file,          scenes_file};

/// What became of an entry's file that had these bytes; "" where that may be: added verifications, evidence, a
/// withdrawal. @throws InputError for a link in its place.
std::string what_changed(const fs::path& file, const std::string& before);

struct CheckOptions {
  std::string against;      // a revision (files_at()) whose outcomes must not have changed; "": none
  bool maintainer = false;  // who asks may change maintainers_files
  std::vector<fs::path> documents;
  std::optional<Catalogue> installed{};  // what entries that are not yet replayed must fit; none: it is not asked
  OnProgress on_progress{};
};

/// Schema, identity and completeness of every entry; that entries of one table played the same scenes; that cassettes
/// are there, and pictures of scenes those that are listed; that lines and entries that are vouched for are those that
/// were; that a preset and engine that an entry names are the installed ones, unless it was replayed; that the pages
/// and the tables in documents are those of the entries; that nothing else lies in the board; and, with a revision,
/// that the directories of its entries differ by appended verifications, evidence and a withdrawal at most (in either
/// form of entry.json), or by a superseding of the maintainers', and the maintainers' files not at all, that pages are
/// around their tables as they were or as this build writes them, and that nothing is left of an `add` that was killed.
/// Keeps on after a problem. @throws InputError as files_at().
Checked check(const fs::path& board, const CheckOptions& options = {});

}  // namespace lgabench::leaderboard

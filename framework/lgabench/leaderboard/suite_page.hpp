// The tables of one suite as a document, and what its page shows on a click.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <lgabench/leaderboard/labels.hpp>
#include <lgabench/leaderboard/standings.hpp>
#include <lgabench/report/document.hpp>

namespace lgabench::leaderboard {

/// One table with what its rows are called.
struct NamedTable {
  Setting setting;
  std::vector<Standing> standings;
  std::vector<std::string> names;   // of each standing, as report/names.hpp takes them; no two alike
  std::vector<std::string> labels;  // what readers are shown in place of the names; no two alike
  std::vector<bool> best;           // of each standing, whether it is the first of its method
  std::vector<Standing> waiting;    // not yet replayed
  std::vector<std::string> waiting_labels;
  int withdrawn = 0;
  Track track{};
};
NamedTable named_table(const std::vector<const Entry*>& table, const Labels& labels, const Tracks& tracks);

/// "q1, preset leaderboard"
std::string title_of(const Setting& setting);
/// "heart, 13 scenarios, ..." in a sentence.
std::string what_was_played(const Setting& setting);
/// "3", "–" where there is none.
std::string rank_text(const Standing& standing);
/// "0.516 [0.443, 0.582]"
std::string score_text(const Standing& standing);
/// § of an entry below the random visible object, and what it means; the line below a table that has it.
report::Span below_random_mark();
std::optional<report::Paragraph> below_random_note(const std::vector<Standing>& standings);
/// What else is known of an entry: "replayed; fresh", "recomputed; partly confined; 2 cells failed; claimed by B.
/// Reader: replayed"
std::string tier_and_marks(const Standing& standing);

/// What ranks, marks and tiers mean, for readers who have read nothing else.
report::Section words_of_the_board();

/// Entries whose files are all that is known of them, and what they claim; none where there is none. `board` is where
/// links find the board.
std::optional<report::Grid> waiting_grid(const NamedTable& table, const fs::path& board = "");

/// A page for the tables of one suite.
report::Document suite_document(const std::string& suite, const std::vector<NamedTable>& tables);
/// What page/leaderboard.js shows (docs/formats).
Json suite_data(const std::vector<NamedTable>& tables);

}  // namespace lgabench::leaderboard

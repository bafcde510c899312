// The tables of one suite as a document, and what its page shows on a click.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <lgabench/document/document.hpp>
#include <lgabench/leaderboard/board_steps.hpp>
#include <lgabench/leaderboard/labels.hpp>
#include <lgabench/leaderboard/scenes.hpp>
#include <lgabench/leaderboard/standings.hpp>
#include <lgabench/statistics/names.hpp>

namespace lgabench::leaderboard {

/// A row of a ranking, with what it is called.
struct NamedStanding : Standing {
  std::string name{};             // as statistics/names.hpp takes it; no two of a table alike
  std::string label{}, policy{};  // what readers are shown in place of the name; no two pairs alike
  bool more = false;              // another row of its method stands above it, as trained or untrained as it is

  bool is_reference() const { return entry->identity.row.is_reference(); }
  /// "LGA, heat map"
  std::string full_name() const { return label + (policy.empty() ? "" : ", ") + policy; }
};

/// One ranking of a preset.
struct NamedTable {
  Setting setting;
  std::vector<NamedStanding> standings;
  std::vector<NamedStanding> waiting;  // not yet replayed; of a preset's first ranking, like `withdrawn`
  int withdrawn = 0;
  Track track{};
  Ranking ranking = Ranking::any_policy;
  std::optional<Undisputed> undisputed;  // of the abstraction track
  std::optional<BoardSteps> steps;
  std::vector<BoardSteps> curve;  // by number of demonstrations, where there are several

  /// The place of one of its standings.
  std::size_t row(const NamedStanding& standing) const {
    return static_cast<std::size_t>(&standing - standings.data());
  }
};
/// The tables of a preset's entries: the first, and each other in which some entry has a rank.
std::vector<NamedTable> named_tables(const std::vector<const Entry*>& table, const Labels& labels,
                                     const Tracks& tracks);

/// Whether some of the tables have pairs for units (units.hpp).
bool is_paired(const std::vector<NamedTable>& tables);

/// A table without rows. `what`: of its name, behind the preset's.
document::Grid grid_of(const NamedTable& table, const std::string& what, std::string caption);
/// Adds a row without cells for it, which document::put() gives it.
void add_row(document::Grid& grid, const NamedStanding& standing);

/// "Fewer demonstrations?, any policy"
std::string title_of(const NamedTable& table);
/// The title, and the table's preset where another table of the suite has the same ranking.
std::string with_preset(const std::string& title, const NamedTable& table, const std::vector<NamedTable>& tables);
/// What a page calls it: its ranking.
std::string section_title(const NamedTable& table, const std::vector<NamedTable>& tables);
/// The day when an entry was computed first, and that of its last verification that counts; "" without one.
std::string computed_on(const Entry& entry);
std::string replayed_on(const Entry& entry);
/// Who submitted it.
document::Span by_span(const Entry& entry);
/// The entry's id, which leads to its entry.json.
document::Span id_span(const Entry& entry);
/// The entry's commit or file, which leads to the repository where that has an address.
document::Span source_span(const Entry& entry);
/// "heart, 13 scenarios, ..." in a sentence.
std::string what_was_played(const Setting& setting);
/// "3", "–" where there is none.
std::string rank_text(const Standing& standing);
/// The rank as a table of a page has it; where there is none its title says why.
document::Span rank_span(const Standing& standing);
/// "0.516"; "[0.443, 0.582]"; both
std::string score_text(double score);
std::string interval_text(const Standing& standing);
std::string score_text(const Standing& standing);
/// § of an entry below the random visible object, and what it means; the line below a table that has it.
document::Span below_random_mark();
std::optional<document::Paragraph> below_random_note(const std::vector<NamedStanding>& standings);
/// What else is known of an entry: "replayed; fresh", "recomputed; partly confined; 2 cells failed; claimed by B.
/// Reader: replayed"
std::string tier_and_marks(const Standing& standing);

/// What ranks, marks and tiers mean, for readers who have read nothing else.
document::Section words_of_the_board();

/// Entries whose files are all that is known of them, and what they claim; none where there is none.
std::optional<document::Grid> waiting_grid(const NamedTable& table);

/// What the answers of a table's entries keep, without a policy, language models side by side: rows by scenes exact, a
/// column for each group of the suite, and the price; then what each got wrong. None where no entry of the table has a
/// score of its answers.
std::optional<document::Section> answers_section(const NamedTable& table, const std::string& id);

/// A page for the tables of one suite.
document::Document suite_document(const std::string& suite, const std::vector<NamedTable>& tables);
/// What page/leaderboard.js shows.
Json suite_data(const std::vector<NamedTable>& tables, const BoardScenes& scenes);

}  // namespace lgabench::leaderboard

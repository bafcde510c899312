// The parts of a run's tables: the columns that stand side by side, marks, notes.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <lgabench/record/reference_rows.hpp>
#include <lgabench/statistics/about_suite.hpp>
#include <lgabench/statistics/summary.hpp>

namespace lgabench::statistics {

/// A column of a table for readers.
struct Column {
  std::string head, arm;
  int demonstrations = 0;
};

/// What is shown side by side: with a single arm its numbers of demonstrations; with several the arms, in a view of
/// their own for each number of demonstrations.
struct View {
  std::string corner;  // what the columns are: "demonstrations", or e.g. "50 demonstrations"
  std::vector<Column> columns;
  std::vector<Column> shifted;  // those with a change against the first arm

  /// Columns without the levels of perturbations, which have a section of their own.
  static std::vector<Column> unperturbed(const Table& table, std::vector<Column> columns);
};
std::vector<View> views(const Table& table);

/// The column that the suite's question is about: its main arm and number of demonstrations, else the last arm that all
/// scenarios have and the most demonstrations. None for a table without rows.
std::optional<Column> main_column(const Table& table, const AboutSuite& about);

/// Rows' marks in the order in which tables show them, those of reference rows first.
const std::vector<RowMark>& table_marks();

/// "†§": the row's.
std::string marks_text(const Row& row);

/// Whether the row acted exactly as in the first arm. This tells something of methods alone: reference rows act alike
/// whatever they see.
bool acts_the_same(const Row& row);

/// Whether a row of the table tells.
bool any_seen(const Table& table);

/// Why the numbers are no whole run's, one line each: no people answered, cells that have not run or cannot be read,
/// rows that learned nothing since their Selection keeps no object.
std::vector<std::string> what_it_lacks(const RunResults& run);

/// The notes that a reader of the tables must know, one line each: what †, §, ‡, !, ?, ¶ and = say, how many people
/// made Selections or that none did, the model behind a cassette, cells that have not run, that the run is not for the
/// leaderboard.
std::vector<std::string> notes(const RunResults& run, const Summary& summary);

/// "5 of 5 episodes of X are method_error: what the first one threw", and the log of its cell, relative to the run.
struct MethodError {
  std::string text, log;
};
/// One for each row's name that has such episodes, over all of its cells.
std::vector<MethodError> method_errors(const RunResults& run);

/// Mean seconds of each of phases() over the finished cells of a row's name, in the order of tables.
struct PhaseTimes {
  std::string layout, engine, method;
  int cells = 0;
  std::vector<double> mean_s = std::vector<double>(phases().size());
};
std::vector<PhaseTimes> phase_times(const RunResults& run);

/// The Selections of all rows, equal ones of a scenario and method (of other layouts, demonstrations, arms) once, as
/// the index into their row's phi.
struct PhiOfRow {
  const Row* row;
  std::size_t command;
};
std::vector<PhiOfRow> distinct_phi(const Summary& summary);

/// Whether a command of the run is tested only: then each says which it is.
bool has_unseen(const RunResults& run);

/// The command, and where `tell` whether demonstrations with it were given.
std::string command_text(const std::string& utterance, bool seen, bool tell);

}  // namespace lgabench::statistics

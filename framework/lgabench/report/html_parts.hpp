// The parts of report.html. Every number of a table that stands in summary.json is wrapped with the JSON pointer to it.
#pragma once
#include <initializer_list>
#include <map>
#include <string>

#include <lgabench/report/claims.hpp>
#include <lgabench/report/paper.hpp>
#include <lgabench/report/pictures.hpp>
#include <lgabench/report/summary.hpp>
#include <lgabench/report/tables.hpp>

namespace lgabench::report::html_parts {

/// Text as it may stand in an element or a quoted attribute.
std::string escaped(const std::string& text);

/// Where rows stand in summary.json.
class RowNumbers {
 public:
  explicit RowNumbers(const Summary& summary);
  std::size_t operator()(const Row& row) const { return numbers_.at(&row); }
  /// `text`, wrapped with the place of the number that it shows: `member` of the row, e.g. "shift/low".
  std::string value(const Row& row, const std::string& member, const std::string& text) const;

 private:
  std::map<const Row*, std::size_t> numbers_;
};

/// A table in a frame that scrolls sideways, with its caption; `heads` and `body` are escaped already.
std::string table(const std::string& caption, const std::vector<std::string>& heads, const std::string& body,
                  bool sortable = false);
/// <tr>: the first `words` cells head the row.
std::string row_of(const std::vector<std::string>& cells, std::size_t words = 1);
/// <section> with a heading and an id that links lead to.
std::string section(const std::string& id, const std::string& title, const std::string& body);
/// A dot in the method's colour, and its name.
std::string named(const std::string& method, std::size_t index = 0);

/// Success of a mean or scenario against demonstrations (or, with a single number of them, over the arms): an SVG.
/// Hollow, dashed: the paper's. @pre the table has rows
std::string chart(const Table& table, const std::string& arm, const std::string& scenario, const PaperValues& paper,
                  const RowNumbers& numbers);
/// What the charts' colours and marks mean.
std::string legend(const Table& table, const PaperValues& paper);

// Sections, "" where there is nothing to show.
std::string success(const Summary& summary, const PaperValues& paper, const RowNumbers& numbers);
std::string arms(const Summary& summary, const PaperValues& paper, const RowNumbers& numbers);
std::string scenarios(const Summary& summary, const PaperValues& paper, const RowNumbers& numbers);
std::string seen_inputs(const Summary& summary, const RowNumbers& numbers);
std::string claims(const std::vector<Claim>& all);
std::string phi(const RunResults& run, const Summary& summary, const RowNumbers& numbers);
std::string failures(const Summary& summary, const RowNumbers& numbers);
std::string attribution(const Summary& summary, const RowNumbers& numbers);
std::string times(const RunResults& run);
/// With the scene of each disagreement, and its end on either engine, side by side.
std::string engines(const std::vector<EngineAgreement>& agreements, const Pictures& pictures);
std::string failed_cells(const Summary& summary);

/// What the script shows of a row: its episodes, and the pictures of those that failed.
Json episodes(const RunResults& run, const Summary& summary, const Pictures& pictures, const RowNumbers& numbers);

}  // namespace lgabench::report::html_parts

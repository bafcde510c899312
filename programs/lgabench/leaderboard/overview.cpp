#include <lgabench/leaderboard/overview.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <tuple>

#include <lgabench/core/rounding.hpp>
#include <lgabench/leaderboard/titles.hpp>
#include <lgabench/leaderboard/units.hpp>
#include <lgabench/statistics/about_suite.hpp>

namespace lgabench::leaderboard {
namespace {

using document::Document;
using document::Grid;
using document::on_page;
using document::Paragraph;
using document::reading;
using document::Section;
using document::Span;
using document::TableCell;

constexpr std::array rankings{Ranking::any_policy, Ranking::papers_network, Ranking::answers_only};

std::string section_of(Ranking ranking) {
  std::string id = "overview-" + to_string(ranking);
  std::replace(id.begin(), id.end(), ' ', '-');
  id.erase(std::remove(id.begin(), id.end(), '\''), id.end());
  return id;
}

// A row of the overview: what it is called, its policy and whose answers it acts on.
using RowWords = std::tuple<std::string, std::string, std::string>;

struct Numbers {
  bool reference = false;
  std::map<std::size_t, TableCell> cells;  // by column
  std::map<std::size_t, double> scores;

  double mean() const {
    double sum = 0;
    for (const auto& score : scores) sum += score.second;
    return sum / static_cast<double>(scores.size());
  }
};

// Success in each column, on average over the rows that are in all of them; over all rows where none is.
std::vector<double> typical_success(const std::map<RowWords, Numbers>& rows, std::size_t columns) {
  const bool some_are_whole =
      std::any_of(rows.begin(), rows.end(), [&](const auto& row) { return row.second.scores.size() == columns; });
  std::vector<std::vector<double>> by_column(columns);
  for (const auto& [row, numbers] : rows)
    if (!some_are_whole || numbers.scores.size() == columns)
      for (const auto& [column, score] : numbers.scores) by_column[column].push_back(score);
  std::vector<double> typical;
  for (const std::vector<double>& scores : by_column) typical.push_back(statistics::mean(scores));
  return typical;
}

// A suite's number: the best of the row's, which leads to its episodes.
TableCell number_cell(const Standing& s, const std::string& suite, std::size_t row) {
  TableCell cell(Span::number(fixed(s.score), "", s.rank == 1 ? document::Emphasis::strong : document::Emphasis::none));
  cell.link = fmt::format("{}.html#row={}", suite, row * 1000);
  return cell;
}

// A suite in which nobody is ranked is one for diagnosis, and no column; in answers only some tables have no ranks.
bool is_column(const NamedTable& table, Ranking ranking) {
  return table.ranking == ranking && !table.standings.empty() &&
         (ranking == Ranking::answers_only ||
          std::any_of(table.standings.begin(), table.standings.end(), [](const Standing& s) { return s.rank; }));
}

std::optional<Grid> overview_grid(const Suites& suites, Ranking ranking) {
  Grid grid;
  grid.name = section_of(ranking);
  grid.caption = statistics::capital(to_string(ranking)) + ": success of every method in every suite; bold: rank 1";
  grid.heads = {"method", "policy", "answers"};
  std::map<RowWords, Numbers> rows;
  std::size_t columns = 0;
  for (const auto& [suite, tables] : suites) {
    std::size_t first_row = 0;
    for (const NamedTable& table : tables) {
      if (is_column(table, ranking)) {
        Span head(with_preset(Titles(suite).suite(), table, tables));
        head.title = statistics::about_suite(suite).question;
        if (table.setting.paired()) head.title += " " + words_of_success(table.setting);
        grid.heads.emplace_back(std::move(head));
        for (const NamedStanding& s : table.standings) {
          if (!s.entry->identity.conditions.none()) continue;  // a row of its suite's page alone
          Numbers& row = rows[{s.label, s.policy, answers_label(*s.entry)}];
          row.reference = s.is_reference();
          if (row.cells.emplace(columns, number_cell(s, suite, first_row + table.row(s))).second)
            row.scores[columns] = s.score;
        }
        ++columns;
      }
      first_row += table.standings.size();
    }
  }
  if (columns == 0) return std::nullopt;
  grid.heads.emplace_back("mean");
  grid.align = "lll" + std::string(columns + 1, 'r');
  // By success beside the typical one of the same suites: of rows in all suites, that is by their mean.
  const std::vector<double> typical = typical_success(rows, columns);
  const auto beside_typical = [&typical](const Numbers& row) {
    double sum = 0;
    for (const auto& [column, score] : row.scores) sum += score - typical[column];
    return sum / static_cast<double>(row.scores.size());
  };
  std::vector<std::pair<double, std::pair<RowWords, Numbers>>> sorted;
  for (auto& row : rows) sorted.emplace_back(beside_typical(row.second), row);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& one, const auto& other) { return one.first > other.first; });
  for (const auto& placed : sorted) {
    const auto& [row, numbers] = placed.second;
    const auto& [label, policy, answers] = row;
    const bool in_few = 2 * numbers.scores.size() < columns;
    Grid::Row line{{}, {Span(label), Span(policy), Span(answers)}, numbers.reference, in_few};
    for (std::size_t k = 0; k < columns; ++k) {
      const auto found = numbers.cells.find(k);
      line.cells.push_back(found == numbers.cells.end() ? TableCell(Span::number("–")) : found->second);
    }
    line.cells.emplace_back(Span::number(numbers.scores.size() == columns ? fixed(numbers.mean()) : "–"));
    grid.rows.push_back(std::move(line));
  }
  return grid;
}

}  // namespace

Section how_to_enter() {
  Section enter{"enter", "How to enter"};
  enter.add<Paragraph>(
      reading,
      {{"Run a suite's preset ", Span("leaderboard", document::Emphasis::code),
        " with your method, add the result, and send it as a pull request: ",
        Span::link("in ten minutes, with a real entry", "../../docs/entering-the-leaderboard.md"), ". See ",
        Span::link("the rules", "../../docs/leaderboard.md"), " for what is accepted and how it is checked, and ",
        Span::link("the suites", "../../docs/suites.md"), " for what is played."}});
  return enter;
}

Document overview(const Suites& suites) {
  const bool paired =
      std::any_of(suites.begin(), suites.end(), [](const auto& suite) { return is_paired(suite.second); });
  Document document;
  document.title = "lgabench leaderboard";
  document.description =
      "How often policies succeed that imitate a few demonstrations and see only what a language model says matters.";
  document.headline = {
      "lgabench asks which features of a scene matter for a command, and what leaving out the rest is worth to a "
      "policy that imitates a few demonstrations. These tables say how often such policies succeed in scenes that were "
      "not demonstrated. A click on a number leads to its episodes."};
  for (const Ranking ranking : rankings) {
    auto grid = overview_grid(suites, ranking);
    if (!grid) continue;
    Section section{section_of(ranking), statistics::capital(to_string(ranking))};
    section.add<Paragraph>(
        reading,
        {{fmt::format("{} The mean is that of rows which are in every suite of the table; a suite of perturbed scenes "
                      "enters with its area{}. A row that lacks suites stands where its success in the others puts it; "
                      "rows of less than half of the suites are shown on request.",
                      words_of(ranking), paired ? ", one of paired scenes with its paired success" : "")}});
    section.add<Grid>(reading, std::move(*grid));
    document.sections.push_back(std::move(section));
  }
  Section list{"suites", "Suites"};
  document::List questions;
  for (const auto& [suite, tables] : suites)
    questions.items.push_back(
        {Span::link(Titles(suite).suite(), suite + ".html"), ": " + statistics::about_suite(suite).question});
  if (suites.empty())
    list.add<Paragraph>(reading, {{"No entry yet. docs/leaderboard.md says how to submit one."}});
  else
    list.add<document::List>(reading, std::move(questions));
  for (const auto& suite : suites)
    for (const NamedTable& table : suite.second)
      if (auto waiting = waiting_grid(table)) list.add<Grid>(reading, std::move(*waiting));
  document.sections.push_back(std::move(list));
  document.sections.push_back(how_to_enter());
  document.sections.push_back(words_of_the_board());
  return document;
}

Json overview_data(const Suites& suites) {
  Json tabs = Json::array();
  for (const Ranking ranking : rankings)
    if (std::any_of(suites.begin(), suites.end(), [&](const auto& suite) {
          return std::any_of(suite.second.begin(), suite.second.end(),
                             [&](const NamedTable& table) { return is_column(table, ranking); });
        }))
      tabs.push_back({{"title", statistics::capital(to_string(ranking))}, {"sections", {section_of(ranking)}}});
  return {{"tabs", tabs}};
}

}  // namespace lgabench::leaderboard

// Tables of success: on the mean, of the arms, of each scenario; and of what was tested by heart.
#include <fmt/format.h>

#include <cmath>

#include <lgabench/report/html_parts.hpp>
#include <lgabench/report/names.hpp>

namespace lgabench::report::html_parts {
namespace {

std::string signed_text(double x) {
  const double rounded = std::round(x * 100) / 100;
  return rounded == 0 ? "0.00" : fmt::format("{:+.2f}", rounded);
}

// One number of success with its interval, its marks and its change against the first arm. A click shows its episodes.
std::string success_cell(const Row* row, const RowNumbers& numbers) {
  if (!row) return "";
  const std::string marks = marks_text(*row);
  if (!row->success) return "–" + marks;
  const auto value = [&](const char* member, double x) {
    return numbers.value(*row, member, fmt::format("{:.2f}", x));
  };
  std::string text = fmt::format(
      "<button type=button class=rate data-row={} style=\"--rate:{:.0f}%\"><b>{}</b>{} <small>[{}, "
      "{}]</small></button>",
      numbers(*row), *row->success * 100, value("success", *row->success), marks, value("low", row->interval.low),
      value("high", row->interval.high));
  if (!row->shift) return text;
  const Shift& shift = *row->shift;
  const auto change = [&](const char* member, double x) { return numbers.value(*row, member, signed_text(x)); };
  return text + fmt::format("<span class=\"change {}\">{}{} <small>[{}, {}]</small></span>",
                            shift.interval.high < 0  ? "worse"
                            : shift.interval.low > 0 ? "better"
                                                     : "open",
                            change("shift/difference", shift.difference),
                            !row->is_reference() && shift.same_actions ? " =" : "",
                            change("shift/low", shift.interval.low), change("shift/high", shift.interval.high));
}

std::string paper_cell(const PaperValues& paper, const std::string& scenario, const std::string& method, int n) {
  const auto rate = paper.find(scenario, method, n), error = paper.error(scenario, method, n);
  if (!rate) return "";
  return fmt::format("<i class=paper>{:.3f}{}</i>", *rate, error ? fmt::format(" ± {:.3f}", *error) : "");
}

// Columns for every method of `scenarios`.
std::string rates(const std::string& caption, const Table& table_, const std::vector<Column>& columns,
                  const std::vector<std::string>& scenarios, const PaperValues& paper, const RowNumbers& numbers) {
  const bool several_arms = table_.arms.size() > 1;  // then the paper's value pools its own, in a column
  bool beside = false;
  for (const std::string& scenario : scenarios)
    for (const std::string& id : table_.methods(scenario))
      beside = beside ||
               (several_arms && paper.find(scenario, display_name(id), columns.front().demonstrations).has_value());
  const bool mean_alone = scenarios.front() == mean_scenario;  // then the caption names it
  std::vector<std::string> heads{"method"};
  if (!mean_alone) heads.insert(heads.begin(), "scenario");
  for (const Column& column : columns) heads.push_back(escaped(column.head));
  if (beside) heads.emplace_back("<i>the paper, its arms pooled</i>");

  std::string body;
  for (const std::string& scenario : scenarios) {
    const auto line = [&](const std::string& id, std::size_t index) {
      std::vector<std::string> cells{named(id, index)};
      if (!mean_alone) cells.insert(cells.begin(), escaped(scenario));
      for (const Column& c : columns)
        cells.push_back(success_cell(table_.find(c.arm, scenario, id, c.demonstrations), numbers));
      if (beside) cells.push_back(paper_cell(paper, scenario, display_name(id), columns.front().demonstrations));
      body += row_of(cells, mean_alone ? 1 : 2);
    };
    const std::vector<std::string> methods = table_.methods(scenario);
    for (std::size_t i = 0; i < methods.size(); ++i) {
      line(methods[i], i);
      if (several_arms || !mean_alone) continue;
      bool published = false;
      std::vector<std::string> cells{
          fmt::format("<i class=theirs>{}, the paper</i>", escaped(display_name(methods[i])))};
      for (const Column& c : columns) {
        cells.push_back(paper_cell(paper, scenario, display_name(methods[i]), c.demonstrations));
        published = published || !cells.back().empty();
      }
      if (published) body += row_of(cells);
    }
    for (const std::string& id : table_.references(scenario)) line(id, 0);
  }
  return table(caption, heads, body, scenarios.size() > 1);
}

std::string corner(const View& view, const Table& table) {
  return table.arms.size() > 1 ? fmt::format("arms, {}", view.corner) : "number of demonstrations";
}

// What the paper's values are, in the section that shows them: the mean's, or the scenarios'.
std::string of_paper(const PaperValues& paper, bool section_of_means) {
  if (paper.rates.empty() || (paper.rates.count(mean_scenario) != 0) != section_of_means) return "";
  return fmt::format(
      "<p class=hint>The paper’s values, <i class=paper>in italics</i>, are those of its figure {}, {}.</p>",
      escaped(paper.figure),
      section_of_means ? "± its error bars, on the mean over its own scenarios, not only those of this run"
                       : "at 50 demonstrations, a scenario’s arms pooled; its scenes are not public");
}

}  // namespace

std::string success(const Summary& summary, const PaperValues& paper, const RowNumbers& numbers) {
  std::string text;
  for (const Table& table : summary.tables) {
    text +=
        fmt::format("<h3>{}</h3>{}<div class=beside><div class=charts>", escaped(table.title()), legend(table, paper));
    const bool curves = table.demonstrations().size() > 1;
    for (const std::string& arm : table.arms) {
      text += chart(table, arm, mean_scenario, paper, numbers);
      if (!curves) break;  // a single chart holds every arm
    }
    text += "</div>";
    for (const View& view : views(table)) {
      if (table.arms.size() > 1) break;  // the next section's
      text += rates(fmt::format("Success [95 % interval over test scenes and training seeds], {}, {}; columns: {}",
                                table.title(mean_scenario), escaped(table.title()), corner(view, table)),
                    table, view.columns, {mean_scenario}, paper, numbers);
    }
    text += "</div>";
  }
  return section("success", "Success against demonstrations", text + of_paper(paper, true));
}

std::string arms(const Summary& summary, const PaperValues& paper, const RowNumbers& numbers) {
  std::string text;
  for (const Table& table : summary.tables) {
    if (table.arms.size() == 1) continue;
    for (const View& view : views(table))
      text += rates(fmt::format("Success [95 % interval over test scenes and training seeds], {}, and below it the "
                                "change against {} where it is paired, {}; "
                                "columns: {}",
                                table.title(mean_scenario), escaped(table.arms.front()), escaped(table.title()),
                                corner(view, table)),
                    table, view.columns, {mean_scenario}, paper, numbers);
  }
  return text.empty() ? "" : section("arms", "Arms side by side", text);
}

std::string scenarios(const Summary& summary, const PaperValues& paper, const RowNumbers& numbers) {
  std::string text;
  for (const Table& table : summary.tables) {
    std::vector<std::string> each = table.scenarios();
    each.pop_back();  // the mean
    text += fmt::format("<h3>{}</h3><div class=\"charts small\">", escaped(table.title()));
    if (table.demonstrations().size() > 1)
      for (const std::string& scenario : each) text += chart(table, table.arms.front(), scenario, paper, numbers);
    text += "</div>";
    for (const View& view : views(table))
      text += rates(fmt::format("Each scenario, {}; columns: {}", escaped(table.title()), corner(view, table)), table,
                    view.columns, each, paper, numbers);
  }
  return section("scenarios", "Each scenario", text + of_paper(paper, false));
}

std::string seen_inputs(const Summary& summary, const RowNumbers& numbers) {
  std::string text;
  for (const Table& table_ : summary.tables) {
    if (!any_seen(table_)) continue;
    for (const View& view : views(table_)) {
      std::vector<std::string> heads{"scenario", "method"};
      for (const Column& column : view.columns) heads.push_back(escaped(column.head));
      std::string body;
      for (const std::string& scenario : table_.scenarios()) {
        const std::vector<std::string> methods = table_.methods(scenario);
        for (std::size_t i = 0; i < methods.size(); ++i) {
          std::vector<std::string> cells{escaped(table_.title(scenario)), named(methods[i], i)};
          for (const Column& c : view.columns) {
            const Row* row = table_.find(c.arm, scenario, methods[i], c.demonstrations);
            const bool told = row && row->seen_share();
            cells.push_back(told ? numbers.value(*row, "inputs_seen", seen_text(row)) : seen_text(row));
          }
          body += row_of(cells, 2);
        }
      }
      text += table(fmt::format("Share of test inputs that stood in training to the byte, {}; columns: {}",
                                escaped(table_.title()), corner(view, table_)),
                    heads, body, true);
    }
  }
  return text.empty() ? "" : section("seen", "Test inputs seen in training", text);
}

}  // namespace lgabench::report::html_parts

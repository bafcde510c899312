// Success against errors made in what was selected.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/environment.hpp>
#include <lgabench/document/document.hpp>
#include <lgabench/report/sections.hpp>
#include <lgabench/statistics/about_suite.hpp>

namespace lgabench::report {
namespace {

const char* words_of(const std::string& kind) {
  return kind == "missing" ? "each true feature missing" : "each wrong feature added";
}

TableCell erring_cell(const Row* row) {
  if (!row || !row->success) return {};
  Spans spans{Span::number(fixed(*row->success), place_of(*row, "success"))};
  const auto empty = row->failures.find(failure::abstraction_empty);
  if (empty != row->failures.end() && row->episodes > 0) {
    spans.emplace_back(", ");
    spans.push_back(Span::number(fixed(static_cast<double>(empty->second) / row->episodes), "", Emphasis::detail));
    spans.emplace_back(" empty");
  }
  TableCell cell(std::move(spans));
  cell.episodes = row->index;
  return cell;
}

TableCell slope_cell(const std::vector<ErrorCurve>& curves, const Row& row, const std::string& kind) {
  const auto curve = std::find_if(curves.begin(), curves.end(), [&](const ErrorCurve& c) {
    return std::tie(c.layout, c.engine, c.arm, c.method, c.kind, c.demonstrations) ==
           std::tie(row.layout, row.engine, row.arm, row.method, kind, row.demonstrations);
  });
  if (curve == curves.end()) return {};
  const std::string place = fmt::format("/error_curves/{}/", curve - curves.begin());
  if (!curve->interval) return Span::number(signed_rate(curve->slope), place + "slope", Emphasis::strong);
  return with_interval(curve->slope, *curve->interval, place, {"slope", "low", "high"}, signed_rate, Emphasis::strong);
}

// Of one kind by size, then of the other, then of both.
bool in_columns(const SelectionErrors& a, const SelectionErrors& b) {
  const auto place = [](const SelectionErrors& e) {
    return std::tuple((e.missing != 0) + 2 * (e.added != 0), e.missing, e.added);
  };
  return place(a) < place(b);
}

// An arm at a number of demonstrations: methods against errors. Without rows where none has an error.
Grid grid_of(const Material& material, const AboutSuite& about, const Table& table, const std::string& arm, int n) {
  Grid grid;
  std::vector<SelectionErrors> columns;
  for (const Row& row : table.rows)
    if (row.arm == arm && row.demonstrations == n && row.is_mean() && !row.errors.none() &&
        !contains(columns, row.errors))
      columns.push_back(row.errors);
  if (columns.empty()) return grid;
  std::sort(columns.begin(), columns.end(), in_columns);
  grid.name = fmt::format("errors_{}_{}_{}_{}", slug(table.layout), slug(table.engine), slug(arm), n);
  grid.caption = fmt::format("Success with errors of the Selection, {}, arm {}, {}; {}", table.title(mean_scenario),
                             table.arm_head(arm), table.demonstrations_text(n), table.title());
  grid.group_head = about.rows.empty() ? "" : "where the knowledge enters";
  grid.align = "l";
  const auto ends = [&](std::size_t i) {  // whether a kind's columns end there, behind which its slope stands
    return (columns[i].missing == 0) != (columns[i].added == 0) &&
           (i + 1 == columns.size() || (columns[i + 1].missing != 0) != (columns[i].missing != 0) ||
            (columns[i + 1].added != 0) != (columns[i].added != 0));
  };
  const auto head = [](const SelectionErrors& e) {
    return e.missing == 0 ? fmt::format("added {:g}", e.added)
           : e.added == 0 ? fmt::format("missing {:g}", e.missing)
                          : fmt::format("missing {:g}, added {:g}", e.missing, e.added);
  };
  for (const std::string& method : table.without_errors().methods(mean_scenario)) {
    const Row* right = table.find(arm, mean_scenario, method, n);
    if (!right) continue;
    grid.rows.push_back({about.row(method), {}});
    put(grid, "method", 'l', named(material, method, Emphasis::strong));
    put(grid, "no errors", 'r', erring_cell(right));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      put(grid, head(columns[i]), 'r', erring_cell(table.find(arm, mean_scenario, method + columns[i].suffix(), n)));
      if (ends(i))
        put(grid, "slope per 0.1", 'r',
            slope_cell(material.summary.error_curves, *right, columns[i].missing != 0 ? "missing" : "added"));
    }
  }
  std::stable_sort(grid.rows.begin(), grid.rows.end(),
                   [](const Grid::Row& a, const Grid::Row& b) { return a.group.text() < b.group.text(); });
  return grid;
}

// Curves of one table's arm and kind, at one number of demonstrations.
Chart chart_of(const Material& material, const ErrorCurve& first) {
  Chart chart;
  std::set<double> at{0};
  for (const ErrorCurve& curve : material.summary.error_curves) {
    if (curve.layout != first.layout || curve.engine != first.engine || curve.arm != first.arm ||
        curve.kind != first.kind || curve.demonstrations != first.demonstrations)
      continue;
    Series series{Series::measured, material.styles.name(curve.method), material.styles(curve.method), true};
    for (const ErrorCurve::Point& point : curve.points) {
      at.insert(point.p);
      series.points.push_back({point.p, point.success, point.low, point.high,
                               fmt::format("{} at {:g}: {} [{}, {}]", series.name, point.p, fixed(point.success),
                                           fixed(point.low), fixed(point.high)),
                               point.row});
    }
    chart.series.push_back(std::move(series));
  }
  for (const double p : at) chart.ticks.push_back({p, fmt::format("{:g}", p)});
  chart.left = -.05 * *at.rbegin();
  chart.right = 1.05 * *at.rbegin();
  chart.file = fmt::format("errors_{}_{}_{}_{}_{}", first.kind, slug(first.layout), slug(first.engine), slug(first.arm),
                           first.demonstrations);
  chart.title = fmt::format("arm {}, {} demonstrations", material.about.arm_title(first.arm), first.demonstrations);
  chart.subtitle = fmt::format("success in {}, layout {}, engine {}", material.about.title, first.layout, first.engine);
  chart.axis = fmt::format("probability of {}", words_of(first.kind));
  chart.alternative = fmt::format("{}, against errors of the Selection: {}", chart.subtitle, chart.title);
  return chart;
}

}  // namespace

Section selection_errors(const Material& material) {
  Section section{"errors", "What an error of the Selection costs"};
  const AboutSuite& about = material.about;
  std::vector<Grid> main, others;
  for (const Table& table : material.summary.tables)
    for (const std::string& arm : table.arms)
      for (const int n : table.demonstrations())
        if (Grid grid = grid_of(material, about, table, arm, n); !grid.rows.empty())
          (arm == about.main_arm || about.main_arm.empty() ? main : others).push_back(std::move(grid));
  if (main.empty()) std::swap(main, others);
  if (main.empty()) return section;
  section.add(reading,
              Paragraph{{"lgabench made errors in each method's Selection before the method learned: each true feature "
                         "went missing, or each wrong one was added, with the probability in the column's head. All "
                         "methods got the same errors, and a larger probability keeps those of a smaller one. Empty: "
                         "the share of episodes with an empty Selection. The slope is that of the least-squares line, "
                         "with its 95 % interval; – where a row selects nothing."}});
  for (Grid& grid : main) section.add(everywhere, std::move(grid));
  for (Grid& grid : others) section.add(reading, grid, grid.caption);
  Charts charts, other_arms;
  std::set<std::string> drawn;
  for (const ErrorCurve& curve : material.summary.error_curves)
    if (Chart chart = chart_of(material, curve); drawn.insert(chart.file).second)
      (curve.arm == about.main_arm || about.main_arm.empty() ? charts : other_arms).charts.push_back(std::move(chart));
  if (!charts.charts.empty()) section.add(reading, std::move(charts));
  if (!other_arms.charts.empty()) section.add(reading, std::move(other_arms), "Figures of the other arms");
  return section;
}

}  // namespace lgabench::report

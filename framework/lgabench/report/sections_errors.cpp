// Success against errors made in what was selected.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include <lgabench/report/sections.hpp>

namespace lgabench::report {
namespace {

const char* words_of(const std::string& kind) {
  return kind == "missing" ? "each true feature missing" : "each wrong feature added";
}

TableCell point_cell(const ErrorCurve& curve, std::size_t index, double p) {
  const auto point = std::find_if(curve.points.begin(), curve.points.end(), [p](const auto& a) { return a.p == p; });
  if (point == curve.points.end()) return {};
  const std::string place =
      fmt::format("/error_curves/{}/points/{}/", index, static_cast<std::size_t>(point - curve.points.begin()));
  Spans spans{Span::number(fixed(point->success), place + "success")};
  if (point->empty > 0) {
    spans.emplace_back(", ");
    spans.push_back(Span::number(fixed(point->empty), place + "empty", Emphasis::detail));
    spans.emplace_back(" empty");
  }
  TableCell cell(std::move(spans));
  cell.episodes = point->row;
  return cell;
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
  chart.title = fmt::format("arm {}, {} demonstrations", first.arm, first.demonstrations);
  chart.subtitle = fmt::format("success in {}, layout {}, engine {}", material.run.suite, first.layout, first.engine);
  chart.axis = fmt::format("probability of {}", words_of(first.kind));
  chart.alternative = fmt::format("{}, against errors of the Selection: {}", chart.subtitle, chart.title);
  return chart;
}

}  // namespace

Section selection_errors(const Material& material) {
  Section section{"errors", "What an error of the Selection costs"};
  const std::vector<ErrorCurve>& curves = material.summary.error_curves;
  if (curves.empty()) return section;
  std::set<double> levels;
  for (const ErrorCurve& curve : curves)
    for (const ErrorCurve::Point& point : curve.points) levels.insert(point.p);
  Grid grid;
  grid.name = "errors";
  grid.caption = "Success, mean over scenarios, against the probability of an error, and its slope per 0.1";
  grid.group_head = "table";
  grid.heads = {"arm", "method", "demonstrations", "errors", "slope per 0.1"};
  grid.align = "llllrr";
  for (const double p : levels) grid.heads.emplace_back(fmt::format("{:g}", p));
  grid.align += std::string(levels.size(), 'r');
  Charts charts;
  std::set<std::string> drawn;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const ErrorCurve& curve = curves[i];
    const std::string place = fmt::format("/error_curves/{}/", i);
    std::vector<TableCell> cells{curve.arm, named(material, curve.method),
                                 Span::number(std::to_string(curve.demonstrations), place + "demonstrations"),
                                 words_of(curve.kind),
                                 Span::number(signed_text(curve.slope), place + "slope", Emphasis::strong)};
    for (const double p : levels) cells.push_back(point_cell(curve, i, p));
    grid.rows.push_back({fmt::format("layout {}, engine {}", curve.layout, curve.engine), std::move(cells)});
    if (Chart chart = chart_of(material, curve); drawn.insert(chart.file).second)
      charts.charts.push_back(std::move(chart));
  }
  section.add(reading,
              Paragraph{{"Errors were made in what each method selected, before it learned: each true feature missing, "
                         "or each wrong one added, with the probability at the head of the column, the same ones for "
                         "every method; a larger probability keeps those of a smaller one. Empty: share of episodes "
                         "for which nothing was left. The slope is that of the line of least squares."}});
  section.add(reading, std::move(charts));
  section.add(everywhere, std::move(grid));
  return section;
}

}  // namespace lgabench::report

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include <lgabench/core/contains.hpp>
#include <lgabench/report/perturbation_parts.hpp>
#include <lgabench/report/sections.hpp>
#include <lgabench/statistics/pairs.hpp>

namespace lgabench::report {
namespace {

using Curve = PerturbationCurve;
using Part = PerturbationPart;

bool moves(const Curve& curve) {
  return std::any_of(curve.levels.begin(), curve.levels.end(), [](const auto& l) { return l.change.difference != 0; });
}

// Distinct values in their order.
std::vector<std::string> distinct(const std::vector<const Curve*>& curves, std::string Curve::*member) {
  std::vector<std::string> all;
  for (const Curve* curve : curves)
    if (!contains(all, curve->*member)) all.push_back(curve->*member);
  return all;
}

Chart axis_chart(const Material& material, const Part& part, const std::string& axis) {
  Chart chart;
  std::map<int, std::string> at{{0, "control"}};
  bool named_levels = false;
  for (const Curve* curve : part.curves) {
    if (curve->axis != axis) continue;
    named_levels = curve->named;
    Series series{curve->kind == "reference" ? Series::reference : Series::measured,
                  material.styles.name(curve->method), material.styles(curve->method), !curve->named};
    series.points.push_back({0, curve->control, curve->control, curve->control,
                             fmt::format("{} in the control: {}", series.name, fixed(curve->control)),
                             curve->control_row});
    for (const Curve::Level& level : curve->levels) {
      at.emplace(level.level, curve->named && !level.name.empty() ? level.name : std::to_string(level.level));
      const Interval& paired = level.change.interval;
      series.points.push_back({static_cast<double>(level.level), level.success,
                               std::clamp(curve->control + paired.low, 0., 1.),
                               std::clamp(curve->control + paired.high, 0., 1.),
                               fmt::format("{} at level {}: {}, change {}", series.name, level.level,
                                           fixed(level.success), change_text(level.change)),
                               level.row});
    }
    chart.series.push_back(std::move(series));
  }
  for (const auto& [level, name] : at) chart.ticks.push_back({static_cast<double>(level), name});
  const double last = at.rbegin()->first;
  chart.left = -.08 * last;
  chart.right = 1.08 * last;
  chart.width = 460;
  chart.height = 300;
  chart.file = fmt::format("perturbations_{}_{}", slug(axis), part.file());
  chart.title = axis;
  chart.subtitle = fmt::format("{}, {}", material.about.title, part.title());
  chart.axis = named_levels ? "" : "level";
  chart.values = "success";
  chart.alternative = fmt::format("success in {} against the levels of {}", chart.subtitle, axis);
  return chart;
}

}  // namespace

std::string PerturbationPart::title() const {
  return fmt::format("{}, {}", table->title(), table->demonstrations_text(demonstrations));
}

std::string PerturbationPart::file() const {
  return fmt::format("{}_{}_{}", slug(table->layout), slug(table->engine), demonstrations);
}

std::vector<std::string> PerturbationPart::methods() const { return distinct(curves, &Curve::method); }
std::vector<std::string> PerturbationPart::axes() const { return distinct(curves, &Curve::axis); }

PerturbationPart PerturbationPart::with_areas() const {
  Part some = *this;
  some.curves.erase(
      std::remove_if(some.curves.begin(), some.curves.end(), [](const Curve* curve) { return !curve->area; }),
      some.curves.end());
  return some;
}

const PerturbationCurve* PerturbationPart::find(const std::string& method, const std::string& axis) const {
  const auto found = std::find_if(curves.begin(), curves.end(),
                                  [&](const Curve* c) { return c->method == method && c->axis == axis; });
  return found == curves.end() ? nullptr : *found;
}

std::vector<PerturbationPart> perturbation_parts(const Material& material) {
  std::vector<Part> all;
  for (const Table& table : material.summary.tables)
    for (const int n : table.demonstrations()) {
      Part part{&table, n, {}};
      for (const Curve& curve : material.summary.perturbations) {
        const bool reference = curve.kind == "reference";
        if (curve.layout == table.layout && curve.engine == table.engine &&
            (curve.demonstrations == n || (reference && curve.demonstrations == 0)) && (!reference || moves(curve)))
          part.curves.push_back(&curve);
      }
      if (!part.curves.empty()) all.push_back(std::move(part));
    }
  return all;
}

Charts perturbation_charts(const Material& material, const PerturbationPart& part) {
  Charts charts;
  for (const std::string& axis : part.axes()) charts.charts.push_back(axis_chart(material, part, axis));
  return charts;
}

Chart perturbation_heat_map(const Material& material, const PerturbationPart& part) {
  const Part with = part.with_areas();
  const std::vector<std::string> axes = with.axes();
  Chart chart;
  chart.heat = true;
  for (std::size_t i = 0; i < axes.size(); ++i) chart.ticks.push_back({static_cast<double>(i), axes[i]});
  for (const std::string& method : with.methods()) {
    Series series{Series::measured, material.styles.name(method), material.styles(method)};
    for (std::size_t i = 0; i < axes.size(); ++i)
      if (const Curve* curve = with.find(method, axes[i])) {
        const auto& [relative, interval] = *curve->area;
        series.points.push_back({static_cast<double>(i), relative, interval.low, interval.high,
                                 fmt::format("{}, {}: {} [{}, {}]", series.name, curve->axis, fixed(relative),
                                             fixed(interval.low), fixed(interval.high))});
      }
    chart.series.push_back(std::move(series));
  }
  chart.width = std::max(460., 170 + 52. * static_cast<double>(axes.size()));
  chart.file = "perturbations_" + part.file();
  chart.title = "Area under the curve relative to the control";
  chart.subtitle = fmt::format("{}, {}", material.about.title, part.title());
  chart.axis = "1: nothing is lost at any level";
  chart.alternative = fmt::format("{} of each method and axis: {}", chart.title, chart.subtitle);
  return chart;
}

PictureRow perturbation_pictures(const Material& material, const std::string& axis) {
  const Pictures& drawn = material.pictures;
  PictureRow best;
  for (const CellResult& cell : material.run.cells) {
    if (cell.failed || cell.is_reference()) continue;
    const std::vector<Episode>& control = cell.episodes.at(cell.arms.front());
    for (std::size_t i = 0; i < control.size(); ++i) {
      const auto first = drawn.scenes.find(control[i].scene);
      if (first == drawn.scenes.end()) continue;
      PictureRow row;
      row.caption = fmt::format("{}: scene {} of {}", axis, i, cell.scenario);
      row.pictures.emplace_back("control", first->second);
      bool changed = false;
      for (const std::string& arm : cell.arms) {
        const auto perturbation = cell.perturbations.find(arm);
        if (perturbation == cell.perturbations.end() || perturbation->second.axis != axis) continue;
        const std::string& scene = cell.episodes.at(arm).at(i).scene;
        const auto plain = drawn.scenes.find(scene);
        if (plain == drawn.scenes.end()) continue;
        const auto made = drawn.perturbed.find(scene);
        const bool is_made = made != drawn.perturbed.end();
        if (is_made) row.pictures.front().second = made->second.first;
        const std::string& png = is_made ? made->second.second : plain->second;
        changed = changed || png != row.pictures.front().second;
        row.pictures.emplace_back(fmt::format("level {}", perturbation->second.level), png);
      }
      if (changed && row.pictures.size() > best.pictures.size()) best = std::move(row);
    }
  }
  return best;
}

}  // namespace lgabench::report

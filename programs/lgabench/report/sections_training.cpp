// How training went: what the methods logged, along the epochs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include <lgabench/report/sections.hpp>

#include <lgabench/core/contains.hpp>

namespace lgabench::report {
namespace {

// The mean over cells at the epochs that all of them logged.
std::map<long long, double> mean_curve(const std::vector<const std::map<long long, double>*>& cells) {
  std::map<long long, double> sums;
  std::map<long long, std::size_t> counts;
  for (const auto* cell : cells)
    for (const auto& [epoch, value] : *cell) {
      sums[epoch] += value;
      ++counts[epoch];
    }
  std::map<long long, double> means;
  for (const auto& [epoch, sum] : sums)
    if (counts.at(epoch) == cells.size()) means[epoch] = sum / static_cast<double>(cells.size());
  return means;
}

// Round numbers from low to high, both inclusive: about four, and at least two. What lies closer together than their
// labels' digits tell apart is taken for one number: a method may log any.
std::vector<Chart::Tick> round_ticks(double low, double high) {
  const double range = std::max({high - low, 1e-9, 1e-4 * std::max(std::abs(low), std::abs(high))});
  const double rough = range / 4, unit = std::pow(10, std::floor(std::log10(rough)));
  const double step = unit * (rough < 1.5 * unit ? 1 : rough < 3.5 * unit ? 2 : rough < 7.5 * unit ? 5 : 10);
  const double first = std::floor(low / step + 1e-9);
  const int steps = std::max(1, static_cast<int>(std::ceil(high / step - 1e-9) - first));
  std::vector<Chart::Tick> ticks;
  for (int i = 0; i <= steps; ++i) ticks.push_back({(first + i) * step, fmt::format("{:g}", (first + i) * step + 0.)});
  return ticks;
}

// The same on a scale of powers of ten, in whose exponents the places are: .1, .2, .5, 1, ...
std::vector<Chart::Tick> power_ticks(double low, double high) {
  std::vector<Chart::Tick> ticks;
  const bool between = high - low < 2.5;
  const int apart = 1 + static_cast<int>(high - low) / 20, end = static_cast<int>(std::ceil(high)) + apart;
  for (int power = static_cast<int>(std::floor(low)) - 1; power < end; power += apart)
    for (const double digit : {1., 2., 5.}) {
      if (!between && digit > 1) continue;
      ticks.push_back({power + std::log10(digit), fmt::format("{:g}", digit * std::pow(10, power))});
    }
  const auto first = std::find_if(ticks.begin(), ticks.end(), [low](const auto& tick) { return tick.at > low + 1e-9; });
  const auto last =
      std::find_if(ticks.begin(), ticks.end(), [high](const auto& tick) { return tick.at >= high - 1e-9; });
  return {first - (first == ticks.begin() ? 0 : 1), last + (last == ticks.end() ? 0 : 1)};
}

// The curves of one name of the cells, by method.
Chart chart_of(const Material& material, const std::string& name, const std::vector<const CellResult*>& cells) {
  Chart chart;
  std::map<std::string, std::vector<const std::map<long long, double>*>, ByRank> by_method;
  for (const CellResult* cell : cells)
    if (const auto found = cell->training.find(name); found != cell->training.end())
      by_method[cell->method].push_back(&found->second);
  double low = INFINITY, high = -INFINITY;
  for (const auto& [method, curves] : by_method) {
    Series series{Series::curve, material.styles.name(method), material.styles(method), true};
    for (const auto& [epoch, value] : mean_curve(curves)) {
      series.points.push_back({static_cast<double>(epoch), value, value, value, ""});
      low = std::min(low, value);
      high = std::max(high, value);
    }
    if (!series.points.empty()) chart.series.push_back(std::move(series));
  }
  if (chart.series.empty()) return chart;
  const bool powers = low > 0 && high > 4 * low;
  if (powers) {
    for (Series& series : chart.series)
      for (ChartPoint& point : series.points) point.y = std::log10(point.y);
    low = std::log10(low);
    high = std::log10(high);
  }
  chart.levels = powers ? power_ticks(low, high) : round_ticks(low, high);
  chart.bottom = chart.levels.front().at;
  chart.top = std::max(chart.levels.back().at, chart.bottom + 1e-9);
  double most = 1;
  for (const Series& series : chart.series) most = std::max(most, series.points.back().x);
  chart.ticks = round_ticks(0, most);
  chart.right = chart.ticks.back().at * 1.03;
  return chart;
}

}  // namespace

Section learning_curves(const Material& material) {
  Section section{"training", "Learning curves", reading};
  for (const Table& table : material.summary.tables) {
    const std::vector<int> demonstrations = table.demonstrations();
    std::set<std::string> names;
    std::vector<const CellResult*> cells;
    std::vector<std::string> scenarios;
    for (const CellResult& cell : material.run.cells) {
      if (cell.failed || cell.layout != table.layout || cell.engine != table.engine || cell.training.empty() ||
          cell.demonstrations != demonstrations.back())
        continue;
      cells.push_back(&cell);
      for (const auto& item : cell.training) names.insert(item.first);
      if (!contains(scenarios, cell.scenario)) scenarios.push_back(cell.scenario);
    }
    Charts large, small;
    for (const std::string& name : names) {
      Chart chart = chart_of(material, name, cells);
      if (chart.series.empty()) continue;
      chart.file = fmt::format("training_{}_{}_{}", slug(name), slug(table.layout), slug(table.engine));
      chart.title = fmt::format("{}, {}", name, table.title(mean_scenario));
      chart.subtitle = fmt::format("{}, {}, {}", material.about.title, table.title(),
                                   table.demonstrations_text(demonstrations.back()));
      chart.axis = "passes over the demonstrations";
      chart.alternative = fmt::format("{} along training: {}, {}", name, chart.title, chart.subtitle);
      large.charts.push_back(std::move(chart));
      for (const std::string& scenario : scenarios) {
        std::vector<const CellResult*> of;
        std::copy_if(cells.begin(), cells.end(), std::back_inserter(of),
                     [&](const CellResult* cell) { return cell->scenario == scenario; });
        Chart one = chart_of(material, name, of);
        if (one.series.empty()) continue;
        one.title = names.size() > 1 ? fmt::format("{}, {}", scenario, name) : scenario;
        one.alternative = fmt::format("{} along training: {}, {}", name, scenario, table.title());
        one.width = 300;
        one.height = 200;
        one.legend = false;
        small.charts.push_back(std::move(one));
      }
    }
    if (large.charts.empty()) continue;
    section.add(reading, std::move(large), "Mean over the scenarios");
    if (small.charts.size() > 1) section.add(reading, std::move(small), "Each scenario");
  }
  if (!section.blocks.empty())
    section.add(reading, Paragraph{{"What methods logged while they trained, mean over training seeds, with the most "
                                    "demonstrations. Losses of different kinds are not comparable."}});
  return section;
}

}  // namespace lgabench::report

// Success: of each method and reference row, its change between arms, what of it may have been memorised.
#include <fmt/format.h>

#include <algorithm>

#include <lgabench/report/sections.hpp>
#include <lgabench/statistics/tables.hpp>

namespace lgabench::report {
namespace {

TableCell success_cell(const Row* row) {
  if (!row) return {};
  const Spans marks = marks_spans(*row);
  if (!row->success) {
    Spans none{Span::number("–")};
    none.insert(none.end(), marks.begin(), marks.end());
    return none;
  }
  TableCell cell =
      with_interval(*row->success, row->interval, place_of(*row, ""), {"success", "low", "high"}, rate_text);
  cell.spans.insert(cell.spans.end(), marks.begin(), marks.end());
  cell.episodes = row->index;
  cell.rate = *row->success;
  return cell;
}

TableCell shift_cell(const Row* row) {
  if (!row || !row->shift) return {};
  const Interval& interval = row->shift->interval;
  const Emphasis emphasis = interval.high < 0 ? Emphasis::worse : interval.low > 0 ? Emphasis::better : Emphasis::none;
  TableCell cell = with_interval(row->shift->difference, interval, place_of(*row, "shift/"),
                                 {"difference", "low", "high"}, signed_rate, emphasis);
  if (acts_the_same(*row)) cell.spans.push_back(Span::number(" ="));
  return cell;
}

TableCell otherwise_cell(const Row* row) {
  if (!row || !row->shift || !row->shift->selected_otherwise) return {};
  return Span::number(rate_text(*row->shift->selected_otherwise), place_of(*row, "shift/selected_otherwise"));
}

TableCell seen_cell(const Row* row) {
  if (!row) return {};
  const std::optional<double> share = row->seen_share();
  if (!share) return Span::number("–");
  return Span::number(fixed(*share), place_of(*row, "inputs_seen"));
}

// "0.293 ± 0.078", with its error bar where the figure has one; empty where the paper has no value.
TableCell paper_cell(const PaperValues& paper, const std::string& scenario, const std::string& method, int n,
                     int digits) {
  const std::string name = display_name(method);
  const auto rate = paper.find(scenario, name, n), error = paper.error(scenario, name, n);
  if (!rate) return {};
  return Span::number(fixed(*rate, digits) + (error ? " ± " + fixed(*error, digits) : ""), "", Emphasis::published);
}

// A table of `cell_of` every method of `scenarios`, without what the paper says.
Grid own_grid(const Material& material, const Table& table, const std::vector<Column>& columns,
              TableCell (*cell_of)(const Row*), const std::vector<std::string>& scenarios, bool plain_names) {
  Grid grid;
  grid.group_head = "scenario";
  grid.heads.emplace_back("method");
  for (const Column& column : columns) grid.heads.emplace_back(column.head);
  grid.align = "ll" + std::string(columns.size(), 'r');
  for (const std::string& scenario : scenarios) {
    const auto line = [&](const std::string& id, bool reference) {
      TableCell name = named(material, id, reference || plain_names ? Emphasis::none : Emphasis::strong);
      if (reference && !plain_names) name.spans.insert(name.spans.begin(), "reference: ");
      Grid::Row row{table.title(scenario), {name}, reference};
      for (const Column& c : columns) row.cells.push_back(cell_of(table.find(c.arm, scenario, id, c.demonstrations)));
      grid.rows.push_back(std::move(row));
    };
    for (const std::string& id : table.methods(scenario)) line(id, false);
    for (const std::string& id : table.references(scenario)) line(id, true);
  }
  return grid;
}

// The same with the paper's values: beside several arms, pooled over its own, they have a column; else its curve a row.
Grid success_grid(const Material& material, const Table& table, const std::vector<Column>& columns,
                  const std::vector<std::string>& scenarios) {
  const Grid alone = own_grid(material, table, columns, success_cell, scenarios, false);
  Grid grid = alone;
  grid.rows.clear();
  const bool arms = table.arms.size() > 1;
  bool pooled = false;
  std::size_t at = 0;  // in own.rows
  for (const std::string& scenario : scenarios) {
    for (const std::string& id : table.methods(scenario)) {
      Grid::Row& row = grid.rows.emplace_back(alone.rows[at++]);
      if (arms) {
        row.cells.push_back(paper_cell(material.paper, scenario, id, columns.front().demonstrations, 2));
        pooled = pooled || !row.cells.back().spans.empty();
        continue;
      }
      if (scenario != mean_scenario) continue;
      Grid::Row published{Span("the paper's scenarios", Emphasis::published),
                          {Span(display_name(id) + ", the paper", Emphasis::published)}};
      bool any = false;
      for (const Column& c : columns) {
        published.cells.push_back(paper_cell(material.paper, scenario, id, c.demonstrations, 3));
        any = any || !published.cells.back().spans.empty();
      }
      if (any) grid.rows.push_back(std::move(published));
    }
    for (std::size_t i = table.references(scenario).size(); i > 0; --i) grid.rows.push_back(alone.rows[at++]);
  }
  if (pooled) {
    grid.heads.emplace_back(Span("the paper, its arms pooled", Emphasis::published));
    grid.align += 'r';
  }
  for (Grid::Row& row : grid.rows) row.cells.resize(grid.heads.size());
  return grid;
}

// Without the rows that have no value.
Grid without_empty_rows(Grid grid) {
  const auto says_nothing = [](const TableCell& cell) { return cell.spans.empty() || cell.text() == "–"; };
  grid.rows.erase(std::remove_if(grid.rows.begin(), grid.rows.end(),
                                 [&](const Grid::Row& row) {
                                   return std::all_of(row.cells.begin() + 1, row.cells.end(), says_nothing);
                                 }),
                  grid.rows.end());
  return grid;
}

bool any_seen_input(const Table& table) {
  return std::any_of(table.rows.begin(), table.rows.end(), [](const Row& row) { return row.inputs_seen > 0; });
}

// Success of a mean or a scenario along the demonstrations, or over the arms with a single number of them, or with a
// single arm as well a row for each method: as points, not bars, so that a method has the same mark in every figure.
Chart chart_of(const Material& material, const Table& table, const std::string& arm, const std::string& scenario) {
  const std::vector<int> demonstrations = table.demonstrations();
  const bool joined = demonstrations.size() > 1;
  Chart chart;
  struct Place {
    double x;
    std::string label, arm;
    int n;
  };
  std::vector<Place> places;
  if (joined)
    for (const int n : demonstrations) places.push_back({static_cast<double>(n), std::to_string(n), arm, n});
  else
    for (const std::string& each : table.arms)
      if (!table.perturbs(each))
        places.push_back({static_cast<double>(places.size()), table.arm_head(each), each, demonstrations.front()});
  const double pad = joined ? .08 * (places.back().x - places.front().x) : .6;
  chart.left = places.front().x - pad;
  chart.right = places.back().x + pad;
  for (const Place& place : places) chart.ticks.push_back({place.x, place.label});

  const auto add = [&](const std::string& id, Series::Kind kind) {
    Series series{kind, material.styles.name(id), material.styles(id), joined};
    for (const Place& place : places) {
      if (kind == Series::published) {
        const auto rate = material.paper.find(scenario, display_name(id), place.n);
        const double error = material.paper.error(scenario, display_name(id), place.n).value_or(0);
        if (rate && joined)
          series.points.push_back({place.x, *rate, *rate - error, *rate + error,
                                   fmt::format("{}, the paper’s, at {}: {}{}", series.name, place.label,
                                               fixed(*rate, 3), error > 0 ? " ± " + fixed(error, 3) : "")});
        continue;
      }
      const Row* row = table.find(place.arm, scenario, id, place.n);
      if (!row || !row->success) continue;
      series.points.push_back({place.x, *row->success, row->interval.low, row->interval.high,
                               fmt::format("{} at {}: {} [{}, {}]", series.name, place.label, fixed(*row->success),
                                           fixed(row->interval.low), fixed(row->interval.high)),
                               row->index});
    }
    if (!series.points.empty()) chart.series.push_back(std::move(series));
  };
  for (const std::string& id : table.methods(scenario)) {
    add(id, Series::measured);
    add(id, Series::published);
  }
  for (const std::string& id : table.references(scenario)) add(id, Series::reference);

  const bool one_of_arms = joined && table.arms.size() > 1;
  chart.rows = places.size() == 1;
  const std::string where = fmt::format("{}, {}", material.about.title, table.title());
  chart.title = one_of_arms ? table.arm_head(arm) : table.title(scenario);
  chart.subtitle = one_of_arms ? table.title(scenario) + ", " + where : where;
  const std::string one_number = table.demonstrations_text(demonstrations.front());
  chart.values = "success";
  chart.axis = chart.rows ? "success, " + one_number : joined ? "demonstrations" : "arm, " + one_number;
  chart.alternative = fmt::format("success in {}{}, {}: {}", where, one_of_arms ? ", arm " + table.arm_title(arm) : "",
                                  chart.rows ? "a row for each method"
                                  : joined   ? "against demonstrations"
                                             : "against arms",
                                  table.title(scenario));
  return chart;
}

// The figures of a table: one of all arms, or one for each where they are curves.
Charts figures(const Material& material, const Table& table) {
  const std::string file = "success_" + slug(table.layout) + "_" + slug(table.engine);
  const bool curves = table.demonstrations().size() > 1;
  Charts all;
  for (const std::string& arm : table.arms) {
    if (table.perturbs(arm)) continue;
    Chart chart = chart_of(material, table, arm, mean_scenario);
    if (chart.series.empty()) continue;
    chart.file = curves && table.arms.size() > 1 ? file + "_" + slug(arm) : file;
    all.charts.push_back(std::move(chart));
    if (!curves) break;
  }
  return all;
}

// A small curve of each scenario, in the first arm.
Charts scenario_charts(const Material& material, const Table& table, const std::vector<std::string>& scenarios) {
  Charts all;
  if (table.demonstrations().size() < 2) return all;
  for (const std::string& scenario : scenarios) {
    Chart chart = chart_of(material, table, table.arms.front(), scenario);
    chart.title = table.title(scenario);
    chart.subtitle = chart.axis = chart.values = "";
    chart.width = 300;
    chart.height = 180;
    chart.legend = false;
    all.charts.push_back(std::move(chart));
  }
  return all;
}

void add_view(const Material& material, const Table& table, const statistics::View& view, const std::string& name,
              bool first, bool last, Section& section) {
  const bool arms = table.arms.size() > 1;
  const std::vector<std::string> all = table.scenarios(), each(all.begin(), all.end() - 1);
  const std::string field = fmt::format("{}, {}", material.summary.suite, table.title()),
                    columns = arms ? view.corner : "columns: number of demonstrations";
  const auto add = [&](Grid grid, const char* file, const std::string& caption, const std::string& folded = "",
                       const std::string& lead = "") {
    grid.name = name + "_" + file;
    grid.caption = caption;
    section.add(reading, std::move(grid), folded, lead);
  };
  const auto add_brief = [&](Grid grid, const std::string& caption) {
    grid.caption = field + caption;
    grid.heads.front() = view.corner;
    section.add_brief(std::move(grid));
  };
  const auto grid_of = [&](TableCell (*cell_of)(const Row*), const std::vector<Column>& shown,
                           const std::vector<std::string>& scenarios, bool plain_names) {
    return own_grid(material, table, shown, cell_of, scenarios, plain_names);
  };
  const std::vector<Column> plain = statistics::View::unperturbed(table, view.columns),
                            shifted = statistics::View::unperturbed(table, view.shifted);
  if (arms) section.add(reading, Heading{view.corner});
  section.add(
      reading,
      Paragraph{{fmt::format("Columns: {}. Brackets: 95 % interval over test scenes and training seeds of these "
                             "scenarios.",
                             arms ? "arms of the test" : "number of demonstrations")}});
  add(success_grid(material, table, plain, {mean_scenario}), "mean",
      fmt::format("Success, {}, {}; {}", table.title(mean_scenario), table.title(), columns));
  add_brief(grid_of(success_cell, plain, all, true), ": success [95 % interval over test scenes and training seeds]");
  if (Charts small = scenario_charts(material, table, each); first && !small.charts.empty())
    section.add(reading, std::move(small));
  add(success_grid(material, table, view.columns, each), "scenarios",
      fmt::format("Success in each scenario, {}; {}", table.title(), columns), "Each scenario, as a table",
      "Each scenario:");
  const std::string control = table.arm_title(table.arms.front());
  if (!view.shifted.empty()) {
    add(without_empty_rows(grid_of(shift_cell, view.shifted, all, false)), "change",
        fmt::format("Change against {}, scene by scene, {}; {}", control, table.title(), columns),
        "Change against " + control, fmt::format("Change against {}, scene by scene:", control));
    if (!shifted.empty())
      add_brief(without_empty_rows(grid_of(shift_cell, shifted, all, true)),
                fmt::format(": change against {} [95 % interval]", control));
  }
  if (const Grid otherwise = without_empty_rows(grid_of(otherwise_cell, view.shifted, {mean_scenario}, true));
      !otherwise.rows.empty()) {
    const std::string what = fmt::format("commands for which something else was selected than in {}, share", control);
    add(otherwise, "otherwise", fmt::format("{}, {}; {}", capital(what), table.title(), columns),
        "Selected otherwise than in " + control, capital(what) + ":");
    add_brief(otherwise, ": " + what);
  }
  if (!any_seen(table)) return;
  if (!any_seen_input(table)) {
    if (last) section.add(everywhere, Paragraph{{"No test input occurred in training."}});
    return;
  }
  const std::string seen = "test inputs that occurred in training, share";
  add(without_empty_rows(grid_of(seen_cell, view.columns, all, false)), "seen",
      fmt::format("{}, {}; {}", capital(seen), table.title(), columns), "Test inputs that occurred in training",
      capital(seen) + ":");
  add_brief(without_empty_rows(grid_of(seen_cell, plain, {mean_scenario}, true)), ": " + seen);
}

}  // namespace

std::vector<Section> success(const Material& material) {
  std::vector<Section> sections;
  for (const Table& all_rows : material.summary.tables) {
    const Table table = all_rows.without_errors();  // they have a section of their own
    const std::string number = sections.empty() ? "" : fmt::format("-{}", sections.size() + 1);
    Section& section = sections.emplace_back(
        Section{"success" + number, fmt::format("{}: {}", success_title(material), table.title())});
    if (Charts drawn = figures(material, table); !drawn.charts.empty())
      section.add(reading, std::move(drawn));
    else
      section.add(reading, Paragraph{{"No figure: no cell has finished."}});
    const std::vector<statistics::View> all = views(table);
    for (const statistics::View& view : all) {
      const int n = view.columns.front().demonstrations;
      const std::string name = fmt::format("{}_{}{}", slug(table.layout), slug(table.engine),
                                           table.arms.size() > 1 ? fmt::format("_{}", n) : "");
      add_view(material, table, view, name, &view == &all.front(), &view == &all.back(), section);
    }
  }
  const PaperValues& paper = material.paper;
  if (!sections.empty() && !paper.rates.empty())
    sections.back().add(
        reading,
        Paragraph{{fmt::format("The paper's values, in italics, are those of its figure {}, {}.", paper.figure,
                               paper.rates.count(mean_scenario) != 0
                                   ? "± its error bars, of the mean over its own scenarios, not only those of this run"
                                   : "at 50 demonstrations, a scenario's arms pooled; its scenes are not public")}});
  return sections;
}

}  // namespace lgabench::report

// How a policy breaks: success against the levels of perturbations, beside the control.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include <lgabench/core/perturbations.hpp>
#include <lgabench/report/pairs.hpp>
#include <lgabench/report/sections.hpp>
#include <lgabench/report/tables.hpp>

namespace lgabench::report {
namespace {

using Curve = PerturbationCurve;
using Curves = std::vector<const Curve*>;

const Row& row_at(const Material& material, std::size_t index) {
  for (const Table& table : material.summary.tables)
    if (index < table.rows.back().index + 1) return table.rows[index - table.rows.front().index];
  throw Error(fmt::format("no row {}", index));
}

// The part of a run that is compared: one table's rows at one number of demonstrations.
std::string part_of(const Curve& curve) { return fmt::format("layout {}, engine {}", curve.layout, curve.engine); }

std::string part_file(const Curve& curve, int demonstrations) {
  return fmt::format("{}_{}_{}", slug(curve.layout), slug(curve.engine), demonstrations);
}

bool moves(const Curve& curve) {
  return std::any_of(curve.levels.begin(), curve.levels.end(), [](const auto& l) { return l.change.difference != 0; });
}

// A reference row bounds methods only where something keeps it from what it does in the control.
bool is_shown(const Curve& curve) { return curve.kind != "reference" || moves(curve); }

std::string place_of(const Material& material, const Curve& curve, const std::string& member) {
  return fmt::format("/perturbations/{}/{}", &curve - material.summary.perturbations.data(), member);
}
std::string place_of(const Material& material, const Curve& curve, const Curve::Level& level,
                     const std::string& member) {
  return place_of(material, curve, fmt::format("levels/{}/{}", &level - curve.levels.data(), member));
}

// Distinct values in their order.
template <class Of>
auto distinct(const Curves& curves, Of of) {
  std::vector<std::decay_t<decltype(of(*curves.front()))>> all;
  for (const Curve* curve : curves)
    if (const auto value = of(*curve); std::find(all.begin(), all.end(), value) == all.end()) all.push_back(value);
  return all;
}

std::vector<std::string> axes_of(const Curves& curves) {
  return distinct(curves, [](const Curve& curve) { return curve.axis; });
}

// Curves of one table at one number of demonstrations, with the reference rows, which may learn nothing.
std::vector<Curves> parts(const Material& material) {
  std::vector<Curves> all;
  for (const Table& table : material.summary.tables)
    for (const int n : table.demonstrations()) {
      Curves part;
      for (const Curve& curve : material.summary.perturbations)
        if (curve.layout == table.layout && curve.engine == table.engine && is_shown(curve) &&
            (curve.demonstrations == n || (curve.kind == "reference" && curve.demonstrations == 0)))
          part.push_back(&curve);
      if (!part.empty()) all.push_back(std::move(part));
    }
  return all;
}

int demonstrations_of(const Curves& part) { return part.front()->demonstrations; }

std::string group_of(const Material& material, const Curves& part) {
  for (const Table& table : material.summary.tables)
    if (table.layout == part.front()->layout && table.engine == part.front()->engine)
      return fmt::format("{}, {}", table.title(), table.demonstrations_text(demonstrations_of(part)));
  return part_of(*part.front());
}

// Cells.

Spans interval_spans(const Interval& interval, const std::string& low, const std::string& high,
                     std::string (*text)(double)) {
  const auto aside = [](const std::string& words, const std::string& place) {
    return Span::number(words, place, Emphasis::detail);
  };
  return {aside(" [", ""), aside(text(interval.low), low), aside(", ", ""), aside(text(interval.high), high),
          aside("]", "")};
}

std::string rate(double x) { return fixed(x); }
std::string change(double x) { return signed_text(x); }

TableCell p_cell(double p, const std::string& place) {
  return p < .001 ? Span::number("< 0.001") : Span::number(fixed(p, 3), place);
}

TableCell control_cell(const Material& material, const Curve& curve) {
  TableCell cell(Span::number(fixed(curve.control), place_of(material, curve, "control/success")));
  if (!curve.control_row) return cell;
  cell.episodes = *curve.control_row;
  cell.rate = curve.control;
  return cell;
}

// Success at a level, "*" where it is less, or more, beyond chance.
TableCell level_cell(const Material& material, const Curve& curve, int number) {
  const Curve::Level* level = curve.find(number);
  if (!level) return {};
  const bool beyond_chance = level->p_holm && *level->p_holm <= alpha && level->change.difference != 0;
  TableCell cell(Span::number(fixed(level->success), place_of(material, curve, *level, "success"),
                              !beyond_chance     ? Emphasis::none
                              : level->is_loss() ? Emphasis::worse
                                                 : Emphasis::better));
  if (beyond_chance) {
    cell.spans.push_back(Span::number("*"));
    cell.spans.back().title = level->is_loss() ? "a significant loss" : "a significant gain";
  }
  const Spans marks = marks_spans(row_at(material, level->row));
  cell.spans.insert(cell.spans.end(), marks.begin(), marks.end());
  cell.episodes = level->row;
  cell.rate = level->success;
  return cell;
}

TableCell area_cell(const Material& material, const Curve& curve) {
  if (!curve.area) return Span::number("–");
  TableCell cell(Span::number(fixed(curve.area->relative), place_of(material, curve, "area/relative")));
  for (Span& span : interval_spans(curve.area->interval, place_of(material, curve, "area/low"),
                                   place_of(material, curve, "area/high"), rate))
    cell.spans.push_back(std::move(span));
  return cell;
}

std::vector<const Curve::Level*> losses(const Curve& curve) {
  std::vector<const Curve::Level*> all;
  for (const Curve::Level& level : curve.levels)
    if (level.is_loss()) all.push_back(&level);
  return all;
}

// The level, or of levels without an order each one's name.
std::string loss_text(const Curve& curve) {
  const std::vector<const Curve::Level*> all = losses(curve);
  if (all.empty()) return "none";
  if (!curve.named) return std::to_string(all.front()->level);
  std::vector<std::string> names;
  for (const Curve::Level* level : all)
    names.push_back(level->name.empty() ? std::to_string(level->level) : level->name);
  return fmt::format("{}", fmt::join(names, "; "));
}

TableCell loss_cell(const Material& material, const Curve& curve) {
  if (curve.kind == "reference") return {};
  const std::string text = loss_text(curve);
  if (curve.named || text == "none") return text;
  return Span::number(text, place_of(material, curve, "first_loss"));
}

TableCell inputs_cell(int unchanged, int of) {
  return of == 0 ? Span::number("–") : Span::number(fmt::format("{} of {}", unchanged, of));
}

TableCell inputs_cell(const Curve& curve) {
  if (curve.kind == "reference") return {};
  UnchangedInputs all;
  for (const Curve::Level& level : curve.levels) all.unchanged += level.inputs.unchanged, all.of += level.inputs.of;
  return inputs_cell(all.unchanged, all.of);
}

// Tables.

// `by_row`: grouped by the row, which a narrow terminal needs; else by the part, the row's name in a column.
Grid curves_grid(const Material& material, const std::vector<Curves>& all, bool by_row) {
  std::set<int> levels;
  for (const Curves& part : all)
    for (const Curve* curve : part)
      for (const Curve::Level& level : curve->levels) levels.insert(level.level);
  Grid grid;
  grid.name = by_row ? "" : "perturbations";
  grid.caption =
      "Success in the control and at each level, mean over scenarios; area under the curve relative to the "
      "control [95 % interval]";
  grid.group_head = by_row ? "row" : "table";
  grid.align = "l";
  const auto head = [&grid](const std::string& text, char align) {
    grid.heads.emplace_back(text);
    grid.align += align;
  };
  if (!by_row) head("method", 'l');
  head("axis", 'l');
  head("control", 'r');
  for (const int level : levels) head(std::to_string(level), 'r');
  for (const char* text : {"area", "first significant loss", "unchanged input"}) head(text, 'r');
  for (const Curves& part : all)
    for (const Curve* curve : part) {
      const std::string group = group_of(material, part);
      Grid::Row row{
          by_row ? material.styles.name(curve->method) + ", " + group : group, {}, curve->kind == "reference"};
      if (!by_row) row.cells.push_back(named(material, curve->method));
      row.cells.emplace_back(curve->axis);
      row.cells.push_back(control_cell(material, *curve));
      for (const int level : levels) row.cells.push_back(level_cell(material, *curve, level));
      row.cells.push_back(area_cell(material, *curve));
      row.cells.push_back(loss_cell(material, *curve));
      row.cells.push_back(inputs_cell(*curve));
      grid.rows.push_back(std::move(row));
    }
  return grid;
}

const Curve* find(const Curves& part, const std::string& method, const std::string& axis) {
  const auto found =
      std::find_if(part.begin(), part.end(), [&](const Curve* c) { return c->method == method && c->axis == axis; });
  return found == part.end() ? nullptr : *found;
}

// Of a part, in which a method has an area.
struct Areas {
  std::vector<std::string> methods, axes;

  explicit Areas(const Curves& part) {
    Curves with;
    std::copy_if(part.begin(), part.end(), std::back_inserter(with),
                 [](const Curve* c) { return c->area.has_value(); });
    if (with.empty()) return;
    methods = distinct(with, [](const Curve& curve) { return curve.method; });
    axes = axes_of(with);
  }
};

// A column for each axis, none for their mean.
Grid areas_grid(const Material& material, const Curves& part) {
  const Areas areas(part);
  Grid grid;
  grid.name = "perturbations_areas_" + part_file(*part.front(), demonstrations_of(part));
  grid.caption =
      fmt::format("Area under the curve relative to the control [95 % interval], {}", group_of(material, part));
  grid.heads = {"method", "control"};
  grid.align = "lr";
  for (const std::string& axis : areas.axes) grid.heads.emplace_back(axis);
  grid.align += std::string(areas.axes.size(), 'r');
  for (const std::string& method : areas.methods) {
    Grid::Row row{{}, {named(material, method)}};
    const Curve* any = nullptr;
    for (const std::string& axis : areas.axes)
      if (const Curve* curve = find(part, method, axis); curve && (!any || (!any->control_row && curve->control_row)))
        any = curve;
    row.cells.push_back(control_cell(material, *any));
    for (const std::string& axis : areas.axes) {
      const Curve* curve = find(part, method, axis);
      row.cells.push_back(curve ? area_cell(material, *curve) : TableCell());
    }
    grid.rows.push_back(std::move(row));
  }
  return grid;
}

Grid levels_grid(const Material& material, const std::vector<Curves>& all) {
  Grid grid;
  grid.name = "perturbations_levels";
  grid.caption =
      "Each level against the control, scene by scene; lost, gained: episodes that failed at the level alone, "
      "or in the control alone";
  grid.group_head = "table";
  grid.heads = {"method", "axis",   "level",       "which is",     "success",        "change",
                "lost",   "gained", "McNemar’s p", "p after Holm", "unchanged input"};
  grid.align = "llllrrrrrrrr";
  for (const Curves& part : all)
    for (const Curve* curve : part)
      for (const Curve::Level& level : curve->levels) {
        const auto place = [&](const char* member) { return place_of(material, *curve, level, member); };
        const auto count = [&](const char* member, int n) { return Span::number(std::to_string(n), place(member)); };
        TableCell success = level_cell(material, *curve, level.level);
        const Row& row = row_at(material, level.row);
        for (Span& span :
             interval_spans(level.interval, report::place_of(row, "low"), report::place_of(row, "high"), rate))
          success.spans.push_back(std::move(span));
        TableCell differs(Span::number(change(level.change.difference), place("change/difference")));
        for (Span& span : interval_spans(level.change.interval, place("change/low"), place("change/high"), change))
          differs.spans.push_back(std::move(span));
        grid.rows.push_back({group_of(material, part),
                             {named(material, curve->method), curve->axis, count("level", level.level), level.name,
                              std::move(success), std::move(differs), count("lost", level.lost),
                              count("gained", level.gained), p_cell(level.p_mcnemar, place("p_mcnemar")),
                              level.p_holm ? p_cell(*level.p_holm, place("p_holm")) : TableCell(),
                              inputs_cell(level.inputs.unchanged, level.inputs.of)},
                             curve->kind == "reference"});
      }
  return grid;
}

// Figures.

Chart axis_chart(const Material& material, const Curves& part, const std::string& axis) {
  Chart chart;
  std::map<int, std::string> at{{0, "control"}};
  bool named_levels = false;
  for (const Curve* curve : part) {
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
  chart.width = 460, chart.height = 300;
  chart.file = fmt::format("perturbations_{}_{}", slug(axis), part_file(*part.front(), demonstrations_of(part)));
  chart.title = axis;
  chart.subtitle = fmt::format("{}, {}", material.run.suite, group_of(material, part));
  chart.axis = named_levels ? "" : "level";
  chart.values = "success";
  chart.alternative = fmt::format("success in {} against the levels of {}", chart.subtitle, axis);
  return chart;
}

Chart heat_map(const Material& material, const Curves& part) {
  const Areas areas(part);
  Chart chart;
  chart.heat = true;
  for (std::size_t i = 0; i < areas.axes.size(); ++i) chart.ticks.push_back({static_cast<double>(i), areas.axes[i]});
  for (const std::string& method : areas.methods) {
    Series series{Series::measured, material.styles.name(method), material.styles(method)};
    for (std::size_t i = 0; i < areas.axes.size(); ++i)
      if (const Curve* curve = find(part, method, areas.axes[i]); curve && curve->area) {
        const auto& [relative, interval] = *curve->area;
        series.points.push_back({static_cast<double>(i), relative, interval.low, interval.high,
                                 fmt::format("{}, {}: {} [{}, {}]", series.name, curve->axis, fixed(relative),
                                             fixed(interval.low), fixed(interval.high))});
      }
    chart.series.push_back(std::move(series));
  }
  chart.width = std::max(460., 170 + 52. * static_cast<double>(areas.axes.size()));
  chart.file = "perturbations_" + part_file(*part.front(), demonstrations_of(part));
  chart.title = "Area under the curve relative to the control";
  chart.subtitle = fmt::format("{}, {}", material.run.suite, group_of(material, part));
  chart.axis = "1: nothing is lost at any level";
  chart.alternative = fmt::format("{} of each method and axis: {}", chart.title, chart.subtitle);
  return chart;
}

Charts figures_of(const Material& material, const Curves& part) {
  Charts charts;
  for (const std::string& axis : axes_of(part)) charts.charts.push_back(axis_chart(material, part, axis));
  return charts;
}

// Pictures.

// One scene in the control and at each level of an axis; none where the axis changes no picture that is there.
PictureRow pictures_of(const Material& material, const std::string& axis) {
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
        const auto made = drawn.perturbed.find(scene), plain = drawn.scenes.find(scene);
        if (plain == drawn.scenes.end()) continue;
        const std::string& png = made == drawn.perturbed.end() ? plain->second : made->second;
        changed = changed || png != first->second;
        row.pictures.emplace_back(fmt::format("level {}", perturbation->second.level), png);
      }
      if (changed && row.pictures.size() > best.pictures.size()) best = std::move(row);
    }
  }
  return best;
}

// "LGA: from level 3 of light_colour, level 2 of all; at no level of sensor_noise": of each method.
List losses_list(const Material& material, const std::vector<Curves>& all) {
  List list;
  for (const Curves& part : all)
    for (const std::string& method : distinct(part, [](const Curve& curve) { return curve.method; })) {
      std::vector<std::string> some, none;
      for (const Curve* curve : part) {
        if (curve->method != method || curve->kind == "reference") continue;
        if (losses(*curve).empty())
          none.push_back(curve->axis);
        else
          some.push_back(curve->named ? fmt::format("{} ({})", curve->axis, loss_text(*curve))
                                      : fmt::format("{} from level {}", curve->axis, loss_text(*curve)));
      }
      if (some.empty() && none.empty()) continue;
      const std::string where = all.size() > 1 ? ", " + group_of(material, part) : "";
      Spans line{Span(material.styles.name(method), Emphasis::strong), Span(where + " loses significantly along ")};
      line.emplace_back(some.empty() ? "no axis" : fmt::format("{}", fmt::join(some, ", ")));
      if (!none.empty() && !some.empty()) line.emplace_back(fmt::format("; not along {}", fmt::join(none, ", ")));
      line.emplace_back(".");
      list.items.push_back(std::move(line));
    }
  return list;
}

}  // namespace

Section perturbations(const Material& material) {
  Section section{"perturbations", "How a policy breaks"};
  const std::vector<Curves> all = parts(material);
  if (all.empty()) return section;
  int tests = 0;
  bool any_named = false;
  for (const Curves& part : all)
    for (const Curve* curve : part) {
      tests = std::max(tests, curve->tests);
      any_named = any_named || curve->named;
    }
  section.add(reading, losses_list(material, all));
  section.add(reading,
              Paragraph{{fmt::format(
                  "Each level plays the control’s scenes, and is compared with it scene by scene. * marks a "
                  "difference beyond chance after Holm’s correction over the {} levels of all axes of its row. "
                  "Whiskers in the figures: the control’s success and the 95 % interval of the change. The area "
                  "is that under the curve from the control to the last level, as a share of what it would be "
                  "had nothing been lost{}; there is no mean over axes, which differ in what a level is. "
                  "Unchanged input: episodes in which all that the policy was given is the control’s, to the "
                  "bit.",
                  tests, any_named ? " (levels that are kinds have none)" : "")}});
  Charts maps;
  for (const Curves& part : all)
    if (!Areas(part).axes.empty()) maps.charts.push_back(heat_map(material, part));
  if (!maps.charts.empty()) section.add(reading, std::move(maps));
  for (const Curves& part : all) {
    if (all.size() > 1) section.add(reading, Heading{group_of(material, part)});
    section.add(reading, figures_of(material, part));
  }
  section.add(in_terminal, curves_grid(material, all, true));
  section.add(reading, curves_grid(material, all, false));
  for (const Curves& part : all)
    if (!Areas(part).axes.empty()) {
      Grid areas = areas_grid(material, part);
      section.add(in_markdown, Paragraph{{areas.caption + ":"}});
      section.add(reading, std::move(areas));
    }
  section.add(in_markdown, Paragraph{{"Each level against the control:"}});
  section.add(reading, levels_grid(material, all), "Each level against the control");
  for (const std::string& axis : axes_of(all.front()))
    if (PictureRow row = pictures_of(material, axis); !row.pictures.empty()) section.add(on_page, std::move(row));
  return section;
}

}  // namespace lgabench::report

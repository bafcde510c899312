// How a policy breaks: success against the levels of perturbations, beside the control.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include <lgabench/document/document.hpp>
#include <lgabench/report/perturbation_parts.hpp>
#include <lgabench/report/sections.hpp>
#include <lgabench/statistics/tables.hpp>

namespace lgabench::report {
namespace {

using Curve = PerturbationCurve;
using Part = PerturbationPart;

const Row& row_at(const Material& material, std::size_t index) {
  for (const Table& table : material.summary.tables)
    if (index < table.rows.back().index + 1) return table.rows[index - table.rows.front().index];
  throw Error(fmt::format("no row {}", index));
}

std::string place_of(const Material& material, const Curve& curve, const std::string& member) {
  return fmt::format("/perturbations/{}/{}", &curve - material.summary.perturbations.data(), member);
}
std::string place_of(const Material& material, const Curve& curve, const Curve::Level& level,
                     const std::string& member) {
  return place_of(material, curve, fmt::format("levels/{}/{}", &level - curve.levels.data(), member));
}

// Cells.

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
  return with_interval(curve.area->relative, curve.area->interval, place_of(material, curve, "area/"),
                       {"relative", "low", "high"}, rate_text);
}

TableCell change_cell(const Change& change, const std::string& place) {
  return with_interval(change.difference, change.interval, place, {"difference", "low", "high"}, signed_rate);
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
  for (const Curve::Level& level : curve.levels) {
    all.unchanged += level.inputs.unchanged;
    all.of += level.inputs.of;
  }
  return inputs_cell(all.unchanged, all.of);
}

// Of what the episodes of a level took: "0.12, 0.80, 0.05, 0.03" in the order of `takings`.
TableCell took_cell(const std::map<std::string, int>& took) {
  int all = 0;
  for (const auto& [what, n] : took) all += n;
  std::vector<std::string> shares;
  for (const char* const what : takings)
    if (all > 0) shares.push_back(fixed(took.count(what) > 0 ? static_cast<double>(took.at(what)) / all : 0));
  return Span::number(fmt::format("{}", fmt::join(shares, ", ")));
}

// Of the level that gives another command; empty where none does.
TableCell use_cell(const Material& material, const Curve& curve) {
  for (const Curve::Level& level : curve.levels)
    if (level.use_of_language)
      return change_cell(*level.use_of_language, place_of(material, curve, level, "use_of_language/"));
  return {};
}

bool gives_other_commands(const std::vector<Part>& all) {
  return std::any_of(all.begin(), all.end(), [](const Part& part) {
    return std::any_of(part.curves.begin(), part.curves.end(), [](const Curve* curve) { return !curve->took.empty(); });
  });
}

// Tables.

// `by_row`: grouped by the row, which few columns need; else by the part, the row's name in a column.
Grid curves_grid(const Material& material, const std::vector<Part>& all, bool by_row) {
  std::set<int> levels;
  for (const Part& part : all)
    for (const Curve* curve : part.curves)
      for (const Curve::Level& level : curve->levels) levels.insert(level.level);
  const bool language = gives_other_commands(all);
  Grid grid;
  grid.name = by_row ? "" : "perturbations";
  grid.caption =
      "Success in the control and at each level, mean over scenarios; area under the curve relative to the "
      "control [95 % interval]";
  grid.group_head = by_row ? "row" : "table";
  grid.align = "l";
  for (const Part& part : all)
    for (const Curve* curve : part.curves) {
      const std::string group = part.title();
      grid.rows.push_back(
          {by_row ? material.styles.name(curve->method) + ", " + group : group, {}, curve->kind == "reference"});
      if (!by_row) put(grid, "method", 'l', named(material, curve->method));
      put(grid, "axis", 'l', curve->axis);
      put(grid, "control", 'r', control_cell(material, *curve));
      for (const int level : levels) put(grid, std::to_string(level), 'r', level_cell(material, *curve, level));
      if (language) put(grid, "use of language", 'r', use_cell(material, *curve));
      put(grid, "area", 'r', area_cell(material, *curve));
      put(grid, "first significant loss", 'r', loss_cell(material, *curve));
      put(grid, "unchanged input", 'r', inputs_cell(*curve));
    }
  return grid;
}

// A column for each axis, none for their mean.
Grid areas_grid(const Material& material, const Part& part) {
  const std::vector<std::string> axes = part.axes();
  Grid grid;
  grid.name = "perturbations_areas_" + part.file();
  grid.caption = fmt::format("Area under the curve relative to the control [95 % interval], {}", part.title());
  grid.heads = {"method", "control"};
  grid.align = "lr";
  for (const std::string& axis : axes) grid.heads.emplace_back(axis);
  grid.align += std::string(axes.size(), 'r');
  for (const std::string& method : part.methods()) {
    Grid::Row row{{}, {named(material, method), {}}};
    for (const std::string& axis : axes) {
      const Curve* curve = part.find(method, axis);
      row.cells.push_back(curve ? area_cell(material, *curve) : TableCell());
      if (curve && (curve->control_row || row.cells[1].spans.empty())) row.cells[1] = control_cell(material, *curve);
    }
    grid.rows.push_back(std::move(row));
  }
  return grid;
}

Grid levels_grid(const Material& material, const std::vector<Part>& all) {
  const bool language = gives_other_commands(all);
  Grid grid;
  grid.name = "perturbations_levels";
  grid.caption =
      "Each level against the control, scene by scene; lost, gained: episodes that failed at the level alone, "
      "or in the control alone";
  grid.group_head = "table";
  grid.align = "l";
  for (const Part& part : all)
    for (const Curve* curve : part.curves)
      for (const Curve::Level& level : curve->levels) {
        const bool reference = curve->kind == "reference";
        const auto place = [&](const char* member) { return place_of(material, *curve, level, member); };
        const auto count = [&](const char* member, int n) { return Span::number(std::to_string(n), place(member)); };
        TableCell success = level_cell(material, *curve, level.level);
        const Spans all_of_it =
            with_interval(level.success, level.interval, report::place_of(row_at(material, level.row), ""),
                          {"success", "low", "high"}, rate_text)
                .spans;
        success.spans.insert(success.spans.end(), all_of_it.begin() + 1, all_of_it.end());
        grid.rows.push_back({part.title(), {}, reference});
        put(grid, "method", 'l', named(material, curve->method));
        put(grid, "axis", 'l', curve->axis);
        put(grid, "level", 'l', count("level", level.level));
        put(grid, "which is", 'r', level.name);
        put(grid, "success", 'r', std::move(success));
        put(grid, "change", 'r', change_cell(level.change, place("change/")));
        put(grid, "lost", 'r', count("lost", level.lost));
        put(grid, "gained", 'r', count("gained", level.gained));
        put(grid, "McNemar’s p", 'r', p_cell(level.p_mcnemar, place("p_mcnemar")));
        put(grid, "p after Holm", 'r', level.p_holm ? p_cell(*level.p_holm, place("p_holm")) : TableCell());
        put(grid, "unchanged input", 'r',
            reference ? TableCell() : inputs_cell(level.inputs.unchanged, level.inputs.of));
        if (!language) continue;
        put(grid, "took its own, the other’s, a third, none", 'r', took_cell(level.took));
        put(grid, "the same in the control", 'r', took_cell(curve->took));
      }
  return grid;
}

// "LGA: from level 3 of light_colour, level 2 of all; at no level of sensor_noise": of each method.
List losses_list(const Material& material, const std::vector<Part>& all) {
  List list;
  for (const Part& part : all)
    for (const std::string& method : part.methods()) {
      std::vector<std::string> some, none;
      for (const Curve* curve : part.curves) {
        if (curve->method != method || curve->kind == "reference") continue;
        if (losses(*curve).empty())
          none.push_back(curve->axis);
        else
          some.push_back(curve->named ? fmt::format("{} ({})", curve->axis, loss_text(*curve))
                                      : fmt::format("{} from level {}", curve->axis, loss_text(*curve)));
      }
      if (some.empty() && none.empty()) continue;
      const std::string where = all.size() > 1 ? ", " + part.title() : "";
      Spans line{Span(material.styles.name(method), Emphasis::strong), Span(where + " loses significantly along ")};
      line.emplace_back(some.empty() ? "no axis" : fmt::format("{}", fmt::join(some, ", ")));
      if (!none.empty() && !some.empty()) line.emplace_back(fmt::format("; not along {}", fmt::join(none, ", ")));
      line.emplace_back(".");
      list.items.push_back(std::move(line));
    }
  return list;
}

// Whose axes they are, where some are plugins'; "" where none is.
std::string plugins_text(const RunResults& run) {
  std::vector<std::string> plugins;
  for (const RunRecord::Plugin& plugin : run.record.plugins)
    if (plugin.kind == "perturbation") plugins.push_back(plugin.id + " " + plugin.version);
  return plugins.empty()
             ? ""
             : fmt::format("Axes of plugins, under which no leaderboard ranks a row: {}.", fmt::join(plugins, ", "));
}

}  // namespace

Section perturbations(const Material& material) {
  Section section{"perturbations", "How a policy breaks"};
  const std::vector<Part> all = perturbation_parts(material);
  if (all.empty()) return section;
  int tests = 0;
  bool any_named = false;
  for (const Part& part : all)
    for (const Curve* curve : part.curves) {
      tests = std::max(tests, curve->tests);
      any_named = any_named || curve->named;
    }
  section.add(reading, losses_list(material, all));
  section.add(reading,
              Paragraph{{fmt::format(
                  "Each level plays the control’s scenes and is compared with the control scene by scene. * marks a "
                  "difference beyond chance after Holm’s correction over the {} levels of all axes of its row. "
                  "Whiskers in the figures: the control’s success and the 95 % interval of the change. The area "
                  "is that under the curve from the control to the last level, as a share of what it would be "
                  "had nothing been lost{}; there is no mean over axes, since their levels differ in kind. "
                  "Unchanged input: episodes in which the policy’s whole input is bit-identical to the "
                  "control’s.{}",
                  tests, any_named ? " (levels that are kinds have none)" : "",
                  gives_other_commands(all)
                      ? " Use of language: the share of episodes that took what the other command means when it "
                        "was given, minus that share in the control."
                      : "")}});
  std::vector<Part> with_areas;
  for (const Part& part : all)
    if (Part some = part.with_areas(); !some.curves.empty()) with_areas.push_back(std::move(some));
  Charts maps;
  for (const Part& part : with_areas) maps.charts.push_back(perturbation_heat_map(material, part));
  if (!maps.charts.empty()) section.add(reading, std::move(maps));
  for (const Part& part : all) {
    if (all.size() > 1) section.add(reading, Heading{part.title()});
    section.add(reading, perturbation_charts(material, part));
  }
  section.add_brief(curves_grid(material, all, true));
  section.add_brief(
      Paragraph{{fmt::format("* beyond chance, after Holm’s correction over the {} levels of all "
                             "axes of a row.",
                             tests)}});
  if (const std::string plugins = plugins_text(material.run); !plugins.empty()) {
    section.add(everywhere, Paragraph{{plugins}});
  }
  section.add(reading, curves_grid(material, all, false));
  for (const Part& part : with_areas) {
    Grid areas = areas_grid(material, part);
    const std::string lead = areas.caption + ":";
    section.add(reading, std::move(areas), "", lead);
  }
  section.add(reading, levels_grid(material, all), "Each level against the control", "Each level against the control:");
  for (const std::string& axis : all.front().axes())
    if (PictureRow row = perturbation_pictures(material, axis); !row.pictures.empty())
      section.add(reading, std::move(row));
  return section;
}

}  // namespace lgabench::report

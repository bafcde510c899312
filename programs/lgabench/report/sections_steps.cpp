// What labels, the command and the truth add.
#include <fmt/format.h>

#include <lgabench/report/sections.hpp>
#include <lgabench/statistics/tables.hpp>

namespace lgabench::report {
namespace {

Grid grid_of(const Material& material, const Table& table) {
  Grid grid;
  grid.name = fmt::format("steps_{}_{}", slug(table.layout), slug(table.engine));
  grid.group_head = "demonstrations";
  grid.heads = {"told", "row", "success", "added", "these commands", "other commands too"};
  grid.align = "lllrrll";
  for (const Steps& one : material.summary.steps) {
    if (one.layout != table.layout || one.engine != table.engine) continue;
    grid.caption = fmt::format(
        "Success in {}, {} commands, and what each row adds to the one above it, {}; brackets: 95 % intervals",
        table.arm_title(one.arm), one.commands, table.title());
    const std::string place = fmt::format("/steps/{}/", &one - material.summary.steps.data());
    for (std::size_t i = 0; i < one.played.size(); ++i) {
      const Steps::Played& played = one.played[i];
      Grid::Row row{table.demonstrations_text(one.demonstrations),
                    {played.stage->what, named(material, played.stage->method),
                     Span::number(fixed(played.success), fmt::format("{}stages/{}/success", place, i))}};
      row.cells.back().episodes = played.row;
      row.cells.back().rate = played.success;
      row.cells.resize(grid.heads.size());
      if (i > 0) {
        const statistics::Step& step = one.steps[i - 1];
        const std::string step_place = fmt::format("{}steps/{}/", place, i - 1);
        const auto interval = [](const Interval& of, const std::string& where) {
          return Spans{Span::number("["), Span::number(signed_rate(of.low), where + "low"), Span::number(", "),
                       Span::number(signed_rate(of.high), where + "high"), Span::number("]")};
        };
        row.cells[3] = Span::number(signed_rate(step.difference), step_place + "difference", Emphasis::strong);
        row.cells[4] = interval(step.interval, step_place);
        row.cells[5] = step.over_commands ? interval(*step.over_commands, step_place + "over_commands/")
                                          : Spans{statistics::signed_interval(step.over_commands)};
      }
      grid.rows.push_back(std::move(row));
    }
  }
  return grid;
}

}  // namespace

Section steps(const Material& material) {
  Section section{"steps", "What labels, the command and the truth add"};
  for (const Table& table : material.summary.tables)
    if (Grid grid = grid_of(material, table); !grid.rows.empty()) section.add(reading, std::move(grid));
  if (section.blocks.empty()) return section;
  section.add(reading, Paragraph{{words_of_steps}});
  return section;
}

}  // namespace lgabench::report

// What was run, how long it took, what failed, and what it was built of.
#include <fmt/format.h>

#include <lgabench/core/contains.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/report/sections.hpp>
#include <lgabench/statistics/tables.hpp>

namespace lgabench::report {
namespace {

std::string text_of(const Json& value) { return value.is_string() ? value.get<std::string>() : canonical(value); }

// Members of the record that are text or numbers, then the machine.
Facts facts(const RunResults& run) {
  Facts all;
  const Json record = to_json(run.record);
  for (const auto& [name, value] : record.items())
    if (value.is_primitive() && !value.is_null() && value != "") all.items.emplace_back(name, text_of(value));
  for (const auto& [name, value] : run.record.machine.items())
    all.items.emplace_back("machine, " + name, text_of(value));
  return all;
}

}  // namespace

Section what_was_run(const Material& material) {
  const RunResults& run = material.run;
  Section section{"run", "What was run"};
  const std::size_t failed = material.summary.failed.size();
  std::size_t episodes = 0;
  for (const CellResult& cell : run.cells)
    for (const auto& item : cell.episodes) episodes += item.second.size();
  const std::pair<std::string, std::string> cells{
      "cells", fmt::format("{} finished, {} failed, {} not run", run.cells.size() - failed, failed, run.not_run)};
  section.add_detail(Facts{{cells, {"episodes", std::to_string(episodes)}}, true});
  Facts known = facts(run);
  known.items.insert(known.items.begin(), cells);
  section.add(in_markdown, std::move(known));
  if (!run.unreadable.empty()) {
    section.add(reading, Paragraph{{"Cells that cannot be read; those whose cell.json can count as failed:"}});
    List lines;
    for (const std::string& why : run.unreadable) lines.items.push_back({Span(why, Emphasis::code)});
    section.add(reading, std::move(lines));
  }

  Grid grid;
  grid.name = "commands";
  grid.caption = "Scenarios and their commands";
  grid.heads = {"scenario", "command"};
  grid.align = "ll";
  const bool tell = has_unseen(run);
  std::vector<std::string> known_rows;
  for (const CellResult& cell : run.cells)
    for (const CommandResult& command : cell.commands) {
      const std::string words = command_text(command.utterance, command.seen, tell), row = cell.scenario + '\n' + words;
      if (contains(known_rows, row)) continue;
      known_rows.push_back(row);
      grid.rows.push_back({{}, {cell.scenario, words}});
    }
  const bool few = grid.rows.size() <= 4;
  section.add(reading, std::move(grid), few ? "" : "The commands");
  return section;
}

Section times(const Material& material) {
  Section section{"times", "Time per cell"};
  const std::vector<PhaseTimes> all = phase_times(material.run);
  if (all.empty()) return section;
  Grid grid;
  grid.name = "times";
  grid.caption = "Seconds of a cell, mean";
  grid.heads = {"layout", "engine", "method", "cells"};
  for (const std::string& phase : phases()) grid.heads.emplace_back(phase.substr(0, phase.size() - 2));
  grid.align = "lllr" + std::string(phases().size(), 'r');
  for (const PhaseTimes& one : all) {
    Grid::Row row{{}, {one.layout, one.engine, named(material, one.method), Span::number(std::to_string(one.cells))}};
    for (const double s : one.mean_s) row.cells.emplace_back(Span::number(fixed(s)));
    grid.rows.push_back(std::move(row));
  }
  section.add(reading, std::move(grid), "Mean seconds of each phase", "Mean seconds of each phase.");
  return section;
}

Section failed_cells(const Material& material) {
  Section section{"failed", "Cells that failed"};
  const std::vector<CellResult>& failed = material.summary.failed;
  if (failed.empty()) return section;
  section.add(reading, Paragraph{{"They count for nothing above; ", Span(cell_file::log, Emphasis::code),
                                  " in a cell's directory says more."}});
  Grid grid;
  grid.name = "failed_cells";
  grid.caption = section.title;
  grid.heads = {"cell", "method", "scenario", "layout", "engine", "demonstrations", "training seed", "fault", "reason"};
  grid.align = std::string(grid.heads.size(), 'l');
  List lines;
  for (const CellResult& cell : failed) {
    TableCell reason(Span(cell.reason, Emphasis::code));
    reason.log = cell.log_tail;
    grid.rows.push_back(
        {{},
         {Span(cell.key, Emphasis::code), named(material, cell.method), cell.scenario, cell.layout, cell.engine,
          std::to_string(cell.demonstrations), std::to_string(cell.training_seed), cell.fault, reason}});
    lines.items.push_back(
        {fmt::format("failed: {} {} {} {} n={} seed={} ({}): {}", cell.method, cell.scenario, cell.layout, cell.engine,
                     cell.demonstrations, cell.training_seed, cell.fault, cell.reason)});
  }
  section.add(reading, std::move(grid));
  section.add_brief(std::move(lines));
  return section;
}

Section provenance(const Material& material) {
  const RunResults& run = material.run;
  Section section{"provenance", "Provenance and machine"};
  Facts all = facts(run);
  for (const RunRecord::Plugin& plugin : run.record.plugins)
    all.items.emplace_back("plugin " + plugin.id,
                           fmt::format("{} {}, sha256 {:.16}", plugin.kind, plugin.version, plugin.sha256));
  for (const auto& [name, value] : run.record.build.items())
    if (value.is_string())
      all.items.emplace_back("built file", fmt::format("{}, sha256 {:.16}", name, value.get<std::string>()));
  section.add_detail(std::move(all), "Command, versions, checksums, machine");
  return section;
}

}  // namespace lgabench::report

#include <lgabench/report/index.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <map>

#include <lgabench/core/descriptor.hpp>
#include <lgabench/core/file_lock.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/record/cell_status.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/report/sections.hpp>
#include <lgabench/statistics/settings.hpp>
#include <lgabench/statistics/tables.hpp>

namespace lgabench::report {
namespace {

TableCell linked(const Report& report, const fs::path& place) {
  const fs::path directory = report.run.directory.lexically_normal(),
                 named = directory.has_filename() ? directory : directory.parent_path();
  TableCell cell(Span(named.filename().string(), Emphasis::code));  // a name of a file keeps its underscores
  cell.link = (fs::absolute(named).lexically_normal().lexically_relative(
                   fs::absolute(place.empty() ? "." : place).lexically_normal()) /
               report_file::page)
                  .generic_string();
  return cell;
}

Grid runs_grid(const std::vector<Report>& reports, const fs::path& place) {
  Grid grid;
  grid.name = "runs";
  grid.caption = "The runs";
  grid.heads = {"run", "suite", "preset", "version", "begun", "cells", "failed", "not run"};
  grid.align = "lllllrrr";
  for (const Report& report : reports) {
    const RunResults& run = report.run;
    const std::size_t failed = report.summary.failed.size();
    grid.rows.push_back({{},
                         {linked(report, place), run.suite, run.record.preset, run.record.version, run.record.started,
                          Span::number(std::to_string(run.cells.size() - failed)), Span::number(std::to_string(failed)),
                          Span::number(std::to_string(run.not_run))}});
  }
  return grid;
}

// What rows must share to be compared, in words.
std::string setting(const Report& report, const Table& table, const std::string& arm) {
  const std::vector<std::string> scenarios = table.scenarios_with(arm);
  const std::string through = seen_through(report.run);
  return fmt::format("{}, {}, arm {}, {}{}: {}", about_suite(report.run.suite, report.run.record.about).title,
                     table.title(), table.arm_title(arm), table.demonstrations_text(table.demonstrations().back()),
                     through.empty() ? "" : " seen through " + through, fmt::join(scenarios, ", "));
}

Grid success_grid(const std::vector<Report>& reports, const fs::path& place) {
  struct Entry {
    const Report* report;
    const Row* row;
  };
  std::map<std::string, std::vector<Entry>> settings;
  for (const Report& report : reports)
    for (const Table& table : report.summary.tables)
      for (const std::string& arm : table.arms)
        for (const std::string& method : table.methods(mean_scenario))
          if (const Row* row = table.find(arm, mean_scenario, method, table.demonstrations().back());
              row && row->success && !row->perturbation)
            settings[setting(report, table, arm)].push_back({&report, row});
  std::vector<std::string> methods;
  for (const auto& item : settings)
    for (const Entry& entry : item.second) methods.push_back(entry.row->method);
  const MethodStyles styles(methods);
  std::vector<const RunResults*> runs;
  for (const Report& report : reports) runs.push_back(&report.run);
  const std::vector<std::map<std::string, std::string>> names = told_names(runs);
  Grid grid;
  grid.name = "runs_success";
  grid.caption = "Mean success, best first; brackets: 95 % interval over test scenes and training seeds";
  grid.group_head = "setting";
  grid.heads = {"method", "run", "success", "interval", "seeds", "failed"};
  grid.align = "lllrrrr";
  for (auto& [words, entries] : settings) {
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return *a.row->success > *b.row->success; });
    for (const Entry& entry : entries) {
      const Row& row = *entry.row;
      const std::string& name = names[static_cast<std::size_t>(entry.report - reports.data())].at(row.method);
      TableCell method(Span(display_name(name), Emphasis::strong));
      method.style = styles(row.method);
      grid.rows.push_back(
          {words,
           {method, linked(*entry.report, place), Span::number(fixed(*row.success) + marks_text(row)),
            Span::number(fmt::format("[{}, {}]", fixed(row.interval.low), fixed(row.interval.high))),
            Span::number(std::to_string(row.seeds)), Span::number(std::to_string(row.episodes - row.successes))}});
    }
  }
  return grid;
}

}  // namespace

Document index_document(const std::vector<Report>& reports, const fs::path& place) {
  Document document{"", fmt::format("{} runs", reports.size()), {}, {}, {}};
  Section& runs = document.sections.emplace_back(Section{"run", "The runs"});
  runs.add(everywhere, runs_grid(reports, place));
  Section& success = document.sections.emplace_back(Section{"success", "Success of all methods"});
  Grid grid = success_grid(reports, place);
  if (grid.rows.empty())
    document.sections.pop_back();
  else
    success.add(everywhere, std::move(grid));
  return document;
}

bool is_being_written(const fs::path& run) {
  const Descriptor directory(::open(run.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  return directory.fd >= 0 && is_locked(directory.fd);
}

Progressed progress_of(const fs::path& run, const std::string& name) {
  Progressed progressed{name, {}};
  try {
    progressed.record = read_run_record(run);
    for (const std::string& cell : progressed.record.cells)
      if (const fs::path directory = run / "cells" / cell; has_status(directory))
        ++(read_cell_status(directory).failed ? progressed.failed : progressed.done);
    progressed.computing = is_being_written(run);
    progressed.has_report = fs::is_regular_file(fs::symlink_status(run / report_file::page));
  } catch (const std::exception& e) {
    progressed.problem = one_line(e.what());
  }
  return progressed;
}

Document progress_document(const std::vector<Progressed>& runs, const std::string& where) {
  Document document{"", fmt::format("{} run{} in {}", runs.size(), runs.size() == 1 ? "" : "s", where), {}, {}, {}};
  Grid grid;
  grid.name = "runs";
  grid.heads = {"run", "suite", "preset", "begun", "cells", "failed", "state"};
  grid.align = "llllrrl";
  for (const Progressed& run : runs) {
    const std::size_t cells = run.record.cells.size();
    TableCell name(Span(run.name, Emphasis::code));
    if (run.has_report) name.link = (fs::path(run.name) / report_file::page).generic_string();
    grid.rows.push_back({{},
                         {name, run.record.suite, run.record.preset, run.record.started,
                          fmt::format("{} of {}", run.done + run.failed, cells), std::to_string(run.failed),
                          !run.problem.empty()            ? run.problem
                          : run.computing                 ? "computing"
                          : run.done + run.failed < cells ? "stopped"
                          : run.has_report                ? "finished"
                                                          : "finished, without a report"}});
  }
  document.sections.emplace_back(Section{"run", "The runs"}).add(everywhere, std::move(grid));
  return document;
}

}  // namespace lgabench::report

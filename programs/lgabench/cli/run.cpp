// lgabench run: a suite, or a part of it, from cells to the table.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <set>

#include <lgabench/cli/causes.hpp>
#include <lgabench/cli/run_plan.hpp>
#include <lgabench/core/shell.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/answers.hpp>
#include <lgabench/harness/debug_cell.hpp>
#include <lgabench/harness/missing_encoder.hpp>

namespace lgabench::cli {
namespace {

// The command that takes this run up again, wherever its default directory was.
std::string resuming_command(const RunArguments& a, const fs::path& out) {
  Words words = command_line();
  words.erase(
      std::remove_if(words.begin(), words.end(), [](const auto& w) { return w == "--fresh" || w == "--resume"; }),
      words.end());
  if (a.out.empty()) words.insert(words.end(), {"--out", out.string()});
  words.push_back("--resume");
  return shell_line(words);
}

// What --dry-run says.
int print_forecast(const RunPlan& plan, const Catalogue& catalogue, const Forecast& all) {
  to_stdout("{}: {} cells, {} already computed, {} to compute\n", plan.out.string(), all.cells, all.there,
            all.cells - all.there);
  if (all.cells < plan.cells.size())
    to_stdout("shard {}/{} of a run of {} cells\n", plan.shard.index, plan.shard.count, plan.cells.size());
  std::size_t width = 3;
  for (const Forecast::Row& row : all.rows) width = std::max(width, row.name.size());
  to_stdout("\n{:<{}}  cells  there        one core  according to\n", "row", width);
  for (const Forecast::Row& row : all.rows)
    to_stdout("{:<{}}  {:5}  {:5}  {:>14}  {}\n", row.name, width, row.cells, row.there,
              (row.unknown ? "at least " : "") + duration_text(row.seconds),
              row.based_on.empty() ? "all there" : row.based_on);
  if (all.questions) to_stdout("\nbefore the cells: {}\n", all.questions->text());
  to_stdout("\n{} with {} worker{}\n", all.duration(), plan.pool.jobs, plan.pool.jobs == 1 ? "" : "s");
  std::set<std::string> others;
  for (const Cell& cell : plan.cells)
    if (is_strangers(cell, catalogue)) others.insert(cell.method.name);
  if (!others.empty() && plan.shard.count == 1 && plan.strangers == Strangers::told_afterwards)
    to_stdout("then at most as long again for cells of {}, to find the causes of failures\n", fmt::join(others, ", "));
  to_stdout("disk: {} in {}, and at most {} of demonstrations in {}\n", size_text(all.run_bytes), plan.out.string(),
            size_text(all.cache_bytes), plan.cache.string());
  return ok;
}

void print_counts(const RunOutcome& outcome, const RunPlan& plan) {
  if (plan.quiet) return;
  to_stderr("{} cells computed, {} reused, {} failed\n", outcome.computed, outcome.reused, outcome.failed.size());
  if (outcome.computed) to_stderr("{}\n", outcome.time.text(plan.pool.jobs));
  if (outcome.elsewhere)
    to_stderr("shard {}/{}: {} of the run's {} cells are not run here; lgabench merge combines the shards\n",
              plan.shard.index, plan.shard.count, outcome.elsewhere, plan.cells.size());
}

Words commands_of(const RunPlan& plan) {
  std::set<std::string> commands;
  for (const Cell& cell : plan.cells)
    for (const Json& command : cell.scenario->at("commands")) commands.insert(command.at("utterance"));
  return {commands.begin(), commands.end()};
}

// Cells of the shard that a method of others played, with failures whose causes are not known.
std::vector<Recorded> without_causes(const RunPlan& plan, const Catalogue& catalogue) {
  std::vector<Recorded> cells;
  for (const Cell* cell : cells_of(plan.cells, plan.shard))
    if (const fs::path directory = plan.out / "cells" / key(*cell);
        is_strangers(*cell, catalogue) && has_status(directory))
      cells.push_back({directory, *cell, {}});
  return without_causes(cells);
}

// Finds the causes of failures of others' methods, which takes telling them the truth: after the run's last cell, as a
// cell that is told can tell those that are still being scored. False where it was interrupted.
bool find_others_causes(const RunPlan& plan, const Catalogue& catalogue, const RunOutcome& outcome) {
  if (plan.strangers != Strangers::told_afterwards) return true;
  const std::vector<Recorded> cells = without_causes(plan, catalogue);
  if (cells.empty()) return true;
  const bool is_part = plan.shard.count > 1;
  if (is_part || !outcome.failed.empty()) {
    to_stderr("the causes of failures of {} are found after the run's last cell: {}\n", one_line(rows_of(cells)),
              is_part ? "merge the parts, then run lgabench attribute MERGED"
                      : "compute the failed cells, or run lgabench attribute " + shell_line({plan.out.string()}));
    return true;
  }
  const RunRecord record = read_run_record(plan.out);
  const RunDirectory directory(plan.out, record, Existing::same);
  RunPlan again = plan_again(plan.out, record, {cells.front().cell}, plan.pool.jobs, plan.pool.timeout_s);
  again.command = plan.command;
  again.pool = plan.pool;
  again.cache = plan.cache;
  again.confined = plan.confined;
  again.quiet = plan.quiet;
  const std::optional<Causes> causes = find_causes(cells, again, catalogue);
  if (causes) keep_causes(*causes, directory);
  return causes.has_value();
}

void print_notes(const RunArguments& a, const RunPlan& plan, const Catalogue& catalogue) {
  if (plan.request.at("answers") == to_string(NoAnswers()))
    if (const auto rows = lacking_answers(plan.cells, catalogue, NoAnswers(), "").rows; !rows.empty())
      to_stderr("note: --answers none, and a language model is asked by {}, whose cells will fail\n",
                fmt::join(rows, ", "));
  if (const std::string missing = missing_encoder(commands_of(plan)); !missing.empty())
    to_stderr("note: {}\n", missing);
  if (a.scene_seed && !a.quiet)
    to_stderr("--scene-seed {}: the test scenes are new; the demonstrations stay, as the training seeds draw them\n",
              *a.scene_seed);
}

// Prints the results as the options ask for; why there are none, "" where they are printed.
std::string print_results(const RunArguments& a, const fs::path& out) {
  const Printed form = a.json ? Printed::json : a.tables ? Printed::tables : a.quiet ? Printed::table : Printed::end;
  try {
    print_report(out, form);
  } catch (const std::exception& e) {  // a full disk, or a damaged run: the counts are told all the same
    return e.what();
  }
  return "";
}

int run(const RunArguments& a) {
  const auto [catalogue, plan] = plan_run(a);
  print_notes(a, plan, catalogue);
  if (a.dry_run) return print_forecast(plan, catalogue, forecast(plan, catalogue));
  if (!a.debug.empty()) return debug_cell(plan, catalogue, a.debug);
  if (a.unconfined) to_stderr("--unconfined: methods run as you, with your files\n");
  const RunOutcome outcome = run_suite(plan, catalogue);
  if (outcome.interrupted) {
    to_stderr("interrupted; what was finished is kept. To resume:\n  {}\n", resuming_command(a, plan.out));
    return interrupted;
  }
  std::string no_causes;
  try {
    if (!find_others_causes(plan, catalogue, outcome)) {
      to_stderr("interrupted; all cells are scored, some causes of failures are not found. To find them:\n  {}\n",
                resuming_command(a, plan.out));
      return interrupted;
    }
  } catch (const std::exception& e) {  // a full disk, or replies that were not kept: the cells are there all the same
    no_causes = e.what();
  }
  print_counts(outcome, plan);
  const bool has_report = outcome.elsewhere < plan.cells.size();
  const std::string no_report = has_report ? print_results(a, plan.out) : "";
  for (const FailedCell& cell : outcome.failed)
    to_stderr("failed: {}: {} ({})\n", one_line(cell.title), one_line(cell.reason), cell.log.string());
  if (!outcome.failed.empty())
    to_stderr("To compute only the failed cells again:\n  {}\n", resuming_command(a, plan.out));
  if (!no_causes.empty()) to_stderr("no causes of failures: {}\n", no_causes);
  if (!no_report.empty())
    to_stderr("no report: {}\n", no_report);
  else if (has_report && !a.json && !a.quiet)
    print_page(plan.out);
  if (outcome.plugin_refused) return plugin_refused;
  if (!(no_causes + no_report).empty() && outcome.failed.empty()) return usage;
  return outcome.failed.empty() ? ok : cells_failed;
}

}  // namespace

void add_run(CLI::App& app, int& exit) {
  auto a = std::make_shared<RunArguments>();
  Verb verb(app, "run", "Compute a suite's cells and print their means");
  add_run_options(verb, *a);
  verb->footer(
      "Examples\n"
      "  lgabench run q1 --preset smoke                                        a first look\n"
      "  lgabench run q1 --scenarios heart --demos 10,50 --seeds 0:3           a part of a suite\n"
      "  lgabench run q1 --methods lga,lga+loss=squared --set '*.epochs=200'   variants, each a row\n"
      "  lgabench run q1 --methods lga,my_method --plugin-path build           a method of your own\n"
      "  lgabench run q1 --methods lga --answers openai --model M --cassette M.jsonl   asks a model\n"
      "  lgabench run q1 --shard 1/2 --out a                                   a part, for `merge`");
  verb->callback([a, &app, &exit] {
    a->program = app.version();
    exit = run(*a);
  });
}

}  // namespace lgabench::cli

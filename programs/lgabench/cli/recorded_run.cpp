#include <lgabench/cli/recorded_run.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include <lgabench/core/version.hpp>
#include <lgabench/harness/run_directory.hpp>
#include <lgabench/host/python_method.hpp>
#include <lgabench/record/answer_source.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench::cli {

Inventory take_stock(const fs::path& run, const RunRecord& record) {
  expect_plain_run(run);
  Inventory inventory;
  for (const std::string& name : std::set<std::string>(record.cells.begin(), record.cells.end())) {
    const fs::path directory = run / "cells" / name;
    if (!has_status(directory)) {
      ++inventory.not_played;
      continue;
    }
    const CellState state = cell_state(directory, name, Json::object());  // of whatever build
    if (state.failed) {
      ++inventory.failed;
      continue;
    }
    try {
      if (!state.complete) throw InputError(state.why);
      inventory.cells.push_back({directory, recorded_cell(directory), state.build});
    } catch (const InputError& e) {
      inventory.edited.emplace_back(e.what());
    }
  }
  return inventory;
}

Catalogue RecomputeArguments::catalogue() const {
  Catalogue catalogue = plugins_at(plugin_path, python);
  for (const std::string& method : methods) with_python_method(method, python, catalogue);
  return catalogue;
}

void add_methods_in_python(Verb& verb, RecomputeArguments& a) {
  verb.option("--methods FILE.py:CLASS,...", a.methods,
              "Methods in Python, as FILE.py:Class; separate several with commas");
  add_python(verb, a.python);
}

RunRecord record_to_recompute(const fs::path& run, const std::string& verb) {
  expect_run(run);
  RunRecord record = read_run_record(run);
  if (!same_cells(record.version, LGABENCH_VERSION))
    throw InputError(fmt::format("{}: lgabench {} made this run, and {} computes other cells; {} it with {}",
                                 run.string(), record.version, LGABENCH_VERSION, verb, record.version));
  return record;
}

RunPlan plan_again(const fs::path& run, const RunRecord& record, std::vector<Cell> cells, int jobs, double timeout_s) {
  RunPlan plan;
  plan.cells = std::move(cells);
  plan.request = {{"suite", plan.cells.front().suite}, {"preset", ""}};
  plan.answers = kept_answers(run);
  if (std::holds_alternative<LiveAnswers>(plan.cells.front().answers)) {
    const std::optional<AnswerFile> replies = kept_replies(run);
    if (!replies)
      throw InputError(
          fmt::format("{}: answers/ lacks the language model's replies, as after a kill; run its command again: {}",
                      run.string(), record.command));
    plan.live.emplace().cassette = replies->path;
    plan.live->asks = false;
  }
  plan.pool.jobs = jobs_of(jobs);
  plan.pool.timeout_s = timeout_s;
  return plan;
}

}  // namespace lgabench::cli

#include <lgabench/cli/recorded_run.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <thread>

#include <lgabench/core/version.hpp>
#include <lgabench/harness/run_directory.hpp>
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

void expect_same_version(const fs::path& run, const RunRecord& record, const std::string& verb) {
  if (!same_cells(record.version, LGABENCH_VERSION))
    throw InputError(fmt::format("{}: a run of lgabench {}, and this is {}, which computes other cells: {} it with {}",
                                 run.string(), record.version, LGABENCH_VERSION, verb, record.version));
}

RunPlan plan_again(const fs::path& run, const RunRecord& record, std::vector<Cell> cells, int jobs, double timeout_s) {
  RunPlan plan;
  plan.cells = std::move(cells);
  plan.request = {{"suite", plan.cells.front().suite}, {"preset", ""}};
  plan.answers = kept_answers(run);
  if (std::holds_alternative<LiveAnswers>(plan.cells.front().answers)) {
    const std::optional<AnswerFile> replies = kept_replies(run);
    if (!replies)
      throw InputError(fmt::format(
          "{}: its language model's replies are not kept in answers/, as after a kill; give its command again: {}",
          run.string(), record.command));
    plan.live.emplace().cassette = replies->path;
    plan.live->asks = false;
  }
  plan.pool.jobs = jobs != 0 ? jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  plan.pool.timeout_s = timeout_s;
  return plan;
}

}  // namespace lgabench::cli

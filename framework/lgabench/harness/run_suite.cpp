#include <lgabench/harness/run_suite.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <random>
#include <set>

#include <lgabench/core/colour.hpp>
#include <lgabench/core/directories.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/scratch.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/cell_plugins.hpp>
#include <lgabench/harness/progress.hpp>
#include <lgabench/harness/run_description.hpp>
#include <lgabench/harness/settle.hpp>
#include <lgabench/host/confine.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench {
namespace {

// Cells that others will compute again are played in another order each time: who passes anything on acts otherwise.
std::optional<std::uint32_t> order_of(const RunPlan& plan) {
  if (plan.strangers != Strangers::told_nothing) return std::nullopt;
  return std::random_device()();
}

// A run that goes on must find what its cells were told: what was asked is not asked again.
void expect_replies_of(const RunPlan& plan) {
  const std::optional<AnswerFile> kept = kept_replies(plan.out);
  if (kept && (!fs::exists(plan.live->cassette) || !holds_lines(plan.live->cassette, kept->path)))
    throw InputError(fmt::format("{}: lacks replies that the run {} used; copy {} there", plan.live->cassette.string(),
                                 plan.out.string(), kept->path.string()));
}

// What the model said until now goes with the run. A full disk costs the copy, not the cells.
void keep_replies_of(const RunPlan& plan, const RunDirectory& directory) {
  try {
    const std::optional<AnswerFile> replies = keep_replies(plan.live->cassette, plan.live_about, plan.out);
    if (!replies) return;
    std::vector<AnswerFile> files = plan.answers;
    files.push_back(*replies);
    directory.amend([&](RunRecord& run) { run.answers = answers_json(files); });
    drop_other_replies(replies->name, plan.out);
  } catch (const InputError& e) {
    to_stderr("the language model's replies are not kept with the run: {}\n", one_line(e.what()));
  }
}

void add_phases(const fs::path& cell, TimeSpent& time) {
  const fs::path file = cell / cell_file::timing;
  const Json timing = read_json(file, Links::refused);
  const JsonReader reader(timing, file.string());
  for (const auto& phase : timing.items())
    if (phase.key() != "total_s") time.phase_s[phase.key()] += reader.at(phase.key()).number();
}

// The shard's cells: those that are there, and those still to be computed. Says why one that was there is computed
// again.
struct ShardState {
  std::vector<const Cell*> complete, missing;
};
ShardState shard_state(const RunPlan& plan, const Catalogue& catalogue, const RunDirectory& directory) {
  ShardState all;
  std::size_t other_build = 0;
  std::string why;
  for (const Cell* cell : cells_of(plan.cells, plan.shard)) {
    const CellState state = directory.state(key(*cell), build_of(*cell, catalogue));
    (state.complete ? all.complete : all.missing).push_back(cell);
    if (state.complete) continue;
    if (state.other_build) {
      ++other_build;
      why = state.why;
    } else if (!state.why.empty()) {
      to_stderr("{}: {}; computed again\n", cell->title(), state.why);
    }
  }
  if (other_build && plan.existing == Existing::same)
    throw InputError(fmt::format("{}: {} cells were {}; --resume computes them again, --fresh drops the run",
                                 plan.out.string(), other_build, why));
  if (other_build) to_stderr("{} cells were {}; computed again\n", other_build, why);
  return all;
}

// Of the cells whose methods declare what they ask, each once.
std::vector<Json> asked_about(const std::vector<const Cell*>& cells, const Catalogue& catalogue) {
  std::vector<Json> scenarios;
  std::set<std::string> seen;
  for (const Cell* cell : cells) {
    const PluginInfo* method = method_plugin(*cell, catalogue);
    const bool asks_them = method && method->questionnaire && cell->method.options.value("meaning", "flat") == "flat";
    if (asks_them && seen.insert(canonical(*cell->scenario)).second) scenarios.push_back(*cell->scenario);
  }
  return scenarios;
}

std::string asked_model_of(const RunPlan& plan) { return plan.live_about.at("model"); }

// The questions that cells declare, before any begins. @returns false if a signal came.
bool ask_for(const std::vector<const Cell*>& cells, const RunPlan& plan, const Catalogue& catalogue) {
  const std::vector<Json> scenarios = asked_about(cells, catalogue);
  if (scenarios.empty()) return true;
  const Questions questions = count_questions(*plan.live, asked_model_of(plan), scenarios);
  if (!plan.quiet) to_stderr("{}\n", questions.text());
  return questions.open == 0 || ask_beforehand({asked_model_of(plan), *plan.live, scenarios}, questions, plan.quiet);
}

// What the disks lack, said before cells are computed for them.
void warn_of_disks(const RunPlan& plan, double run_bytes) {
  std::error_code error;
  const fs::space_info space = fs::space(plan.out, error);
  if (!error && static_cast<double>(space.available) < run_bytes)
    to_stderr("{}: the cells need about {} of disk, and {} are free\n", plan.out.string(), size_text(run_bytes),
              size_text(static_cast<double>(space.available)));
  std::string why = try_make_directories(plan.cache);
  if (why.empty() && ::access(plan.cache.c_str(), W_OK) != 0) why = std::strerror(errno);
  if (!why.empty())
    to_stderr("{}: cannot be written: {}; each cell makes its demonstrations again\n", plan.cache.string(), why);
}

// The cells that a run lacks, from the plan to the directory.
class Run {
 public:
  Run(const RunPlan& plan, const Catalogue& catalogue)
      : plan_(plan),
        catalogue_(catalogue),
        was_unconfined_(plan.existing != Existing::fresh && is_unconfined(plan.out)),
        directory_(plan.out, describe(plan, catalogue), plan.existing),
        state_(prepare()),
        schedule_(state_.missing, order_of(plan), plan.costs),
        places_(state_.missing.size()) {
    outcome_.reused = state_.complete.size();
    for (const Cell* cell : state_.complete) schedule_.learn(*cell, recorded_seconds(directory_.cell(key(*cell))));
  }

  RunOutcome play() {
    announce();
    const bool asks = plan_.live && plan_.live->asks;
    outcome_.interrupted = (asks && !ask_for(state_.missing, plan_, catalogue_)) || !compute();
    if (asks) keep_replies_of(plan_, directory_);
    if (!outcome_.interrupted) confirm();
    return std::move(outcome_);
  }

 private:
  // Of the i-th cell that is computed.
  struct Place {
    const Cell* cell = nullptr;
    fs::path scratch, host;  // of what the worker writes, and of what the method's process does
  };

  // What run.json and the kept answers say of this part of the run.
  ShardState prepare() {
    directory_.amend([&](RunRecord& run) {
      if (was_unconfined_) run.confinement = unconfined_run;
      if (run.shard != shard_of(plan_)) run.shard.reset();  // the directory holds another part as well
    });
    keep_answers(plan_.answers, plan_.out);
    if (plan_.live && plan_.live->asks) expect_replies_of(plan_);
    ShardState state = shard_state(plan_, catalogue_, directory_);
    if (!plan_.confined && !state.missing.empty())
      directory_.amend([](RunRecord& run) { run.confinement = unconfined_run; });
    return state;
  }

  // How long it should take, and what the disks lack.
  void announce() const {
    if (state_.missing.empty()) return;
    constexpr double long_s = 600;
    const Forecast expected = forecast(state_.complete, state_.missing, schedule_.costs(), plan_.pool.jobs,
                                       [this](const Cell& cell) { return takes_unknown_time(cell, catalogue_); });
    const bool is_long = expected.wall_s > long_s;
    if (!plan_.quiet)
      put(stderr,
          painted(stderr, is_long ? Colour::yellow : Colour::bold, expected.text(plan_.pool.jobs, plan_.purpose)) +
              (is_long && plan_.purpose.empty() ? "; --dry-run shows it by row\n" : "\n"));
    if (plan_.purpose.empty()) warn_of_disks(plan_, expected.run_bytes);
  }

  // @returns false if a signal came.
  bool compute() {
    progress_.emplace(
        state_.missing.size(), plan_.pool.jobs, [this] { return schedule_.left_s(); }, plan_.quiet);
    PoolEvents events;
    events.started = [this](std::size_t i) {
      progress_->started(i, places_[i].cell->title(), schedule_.costs().expected_seconds(*places_[i].cell));
    };
    events.progress = [this](std::size_t i, const std::string& phase, long long n) { progress_->phase(i, phase, n); };
    events.tick = [this] { progress_->tick(); };
    events.ended = [this](std::size_t i, const WorkerEnd& end) { ended(i, end); };
    const auto start = std::chrono::steady_clock::now();
    const bool done = run_workers(
        state_.missing.size(), [this](std::size_t i) { return task(i); }, plan_.pool, events);
    outcome_.time.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return done;
  }

  WorkerTask task(std::size_t i) {
    Place& place = places_[i];
    place.cell = schedule_.next();
    place.host = hosts_.path / std::to_string(i);
    place.scratch = directory_.scratch(key(*place.cell));
    fs::create_directory(place.host);
    return {to_json(cell_job(plan_, catalogue_, *place.cell, place.scratch, plan_.out / "answers", place.host)),
            place.scratch / cell_file::log};
  }

  void ended(std::size_t i, const WorkerEnd& end) {
    const Place& place = places_[i];
    const Cell& cell = *place.cell;
    constexpr int refused = 4;  // the worker's exit status for a plugin that cannot be loaded
    const Json build = build_of(cell, catalogue_);
    std::string reason;
    // What a plugin did to the directory, or a full disk, ends this cell and no other.
    try {
      if (place.scratch.empty()) throw InputError(why_it_ended(end, plan_.pool.timeout_s).reason);
      reason = settle(cell, end, place.scratch, build, plan_.pool.timeout_s);
      directory_.keep(key(cell));
      directory_.sync();
      if (reason.empty()) add_phases(directory_.cell(key(cell)), outcome_.time);
    } catch (const InputError& e) {
      record_failure(directory_, cell, reason = e.what(), "host", build);
    } catch (const std::exception& e) {
      record_failure(directory_, cell, reason = e.what(), "plugin", build);
    }
    remove_tree(place.host);
    outcome_.time.workers_s += end.seconds;
    if (reason.empty()) {
      ++outcome_.computed;
      schedule_.learn(cell, end.seconds);
    } else {
      outcome_.failed.push_back({cell.title(), reason, directory_.cell(key(cell)) / cell_file::log});
      outcome_.plugin_refused |= end.exit_code == refused && end.complaint && end.complaint->refused;
      failed_.insert(key(cell));
    }
    progress_->ended(i, reason.empty() ? "" : "failed: " + reason);
  }

  // The last word is the disk's: a cell that was there, or was computed, and is not as it was kept has failed.
  void confirm() {
    for (const Cell* cell : state_.complete) expect_there(*cell, outcome_.reused);
    for (const Place& place : places_)
      if (failed_.count(key(*place.cell)) == 0) expect_there(*place.cell, outcome_.computed);
    std::set<std::string> ours;
    for (const Cell* cell : cells_of(plan_.cells, plan_.shard)) ours.insert(key(*cell));
    for (const Cell& cell : plan_.cells)
      outcome_.elsewhere += ours.count(key(cell)) == 0 && !has_status(directory_.cell(key(cell)));
  }

  void expect_there(const Cell& cell, std::size_t& count) {
    const CellState state = directory_.state(key(cell), build_of(cell, catalogue_));
    if (state.complete) return;
    --count;
    outcome_.failed.push_back({cell.title(), "was kept and is gone: " + (state.why.empty() ? "no files" : state.why),
                               directory_.cell(key(cell)) / cell_file::log});
  }

  const RunPlan& plan_;
  const Catalogue& catalogue_;
  const bool was_unconfined_;
  const RunDirectory directory_;
  const ShardState state_;
  Schedule schedule_;
  std::optional<Progress> progress_;  // once cells are computed
  std::vector<Place> places_;
  const Scratch hosts_{"hosts"};  // not below the run's directory: a method does not learn where that is
  std::set<std::string> failed_;  // keys
  RunOutcome outcome_;
};

}  // namespace

std::string run_hash(const std::vector<Cell>& cells, const Catalogue& catalogue) {
  std::string all;
  for (const Cell& cell : cells) all += key(cell) + canonical(build_of(cell, catalogue));
  return sha256(all).substr(0, 8);
}

// An id can be anybody's.
static bool has_shipped_bytes(const PluginInfo& plugin, const Catalogue& catalogue) {
  const fs::path shipped = fs::weakly_canonical(shipped_plugin_directory());
  return std::any_of(catalogue.plugins.begin(), catalogue.plugins.end(), [&](const PluginInfo& one) {
    return one.sha256 == plugin.sha256 && fs::weakly_canonical(one.file).parent_path() == shipped;
  });
}

// What is trained in the cell; null of a reference row.
static const PluginInfo* trained_plugin(const Cell& cell, const Catalogue& catalogue) {
  return cell.method.acts ? acting_plugin(cell, catalogue) : method_plugin(cell, catalogue);
}

bool is_strangers(const Cell& cell, const Catalogue& catalogue) {
  const PluginInfo* const method = trained_plugin(cell, catalogue);
  return method && !has_shipped_bytes(*method, catalogue);
}

// What plays, perturbs and perceives in a cell, its engine apart.
static std::vector<PluginInfo> plugins_around(const Cell& cell, const Catalogue& catalogue) {
  std::vector<PluginInfo> plugins = axis_plugins(cell, catalogue);
  for (const PluginInfo* one : {environment_plugin(cell, catalogue), perceiver_plugin(cell, catalogue)})
    if (one) plugins.push_back(*one);
  return plugins;
}

bool has_own_arithmetic(const Cell& cell, const Catalogue& catalogue) {
  std::vector<PluginInfo> plugins = plugins_around(cell, catalogue);
  if (const auto engine = engine_plugin(cell, catalogue)) plugins.push_back(*engine);
  if (const PluginInfo* method = trained_plugin(cell, catalogue)) plugins.push_back(*method);
  return std::all_of(plugins.begin(), plugins.end(), [&](const PluginInfo& plugin) {
    return has_shipped_bytes(plugin, catalogue) && plugin.fingerprint.find("LibTorch=none") != std::string::npos;
  });
}

bool takes_unknown_time(const Cell& cell, const Catalogue& catalogue) {
  const auto is_own = [&](const PluginInfo& plugin) { return !has_shipped_bytes(plugin, catalogue); };
  const std::vector<PluginInfo> around = plugins_around(cell, catalogue);
  if (std::any_of(around.begin(), around.end(), is_own)) return true;
  const PluginInfo* const method = method_plugin(cell, catalogue);
  return !measured_on(cell).empty() && (is_strangers(cell, catalogue) || (method && is_own(*method)));
}

std::string TimeSpent::text(int jobs) const {
  double all = 0;
  for (const auto& phase : phase_s) all += phase.second;
  std::string text;
  for (const std::string& phase : cell_phases) {
    const auto spent = phase_s.find(phase + "_s");
    const double share = spent == phase_s.end() || all <= 0 ? 0 : spent->second / all;
    text += fmt::format("{}{} {:.0f} %", text.empty() ? "" : ", ", phase, 100 * share);
  }
  return fmt::format("{}; {} worker{} busy {:.0f} % of {:.1f} s", text, jobs, jobs == 1 ? "" : "s",
                     wall_s > 0 ? 100 * workers_s / (jobs * wall_s) : 0, wall_s);
}

Forecast forecast(const RunPlan& plan, const Catalogue& catalogue) {
  std::vector<const Cell*> complete, missing;
  Costs costs;
  for (const Cell* cell : cells_of(plan.cells, plan.shard)) {
    const fs::path directory = plan.out / "cells" / key(*cell);
    const CellState state = cell_state(directory, key(*cell), build_of(*cell, catalogue));
    const bool there = state.complete && plan.existing != Existing::fresh;
    (there ? complete : missing).push_back(cell);
    if (there) costs.learn(*cell, recorded_seconds(directory));
  }
  Forecast expected = forecast(complete, missing, costs, plan.pool.jobs,
                               [&catalogue](const Cell& cell) { return takes_unknown_time(cell, catalogue); });
  if (plan.live && plan.live->asks)
    if (const std::vector<Json> scenarios = asked_about(missing, catalogue); !scenarios.empty())
      expected.questions = count_questions(*plan.live, asked_model_of(plan), scenarios);
  return expected;
}

CellJob cell_job(const RunPlan& plan, const Catalogue& catalogue, const Cell& cell, const fs::path& directory,
                 const fs::path& answers, const fs::path& scratch) {
  CellJob job{cell,          engine_plugin(cell, catalogue),
              std::nullopt,  directory,
              plan.cache,    answers,
              scratch,       build_of(cell, catalogue),
              plan.confined, worker_limits(plan.pool),
              plan.live};
  job.keeps_policy = plan.keeps_policies;
  if (const PluginInfo* environment = environment_plugin(cell, catalogue)) job.environment = *environment;
  job.axes = axis_plugins(cell, catalogue);
  if (const PluginInfo* perceiver = perceiver_plugin(cell, catalogue)) job.perceiver = *perceiver;
  if (const PluginInfo* method = method_plugin(cell, catalogue)) {
    job.method = *method;
    if (const PluginInfo* acts = acting_plugin(cell, catalogue)) job.acts = *acts;  // which alone is told the truth
    job.attributed = plan.strangers == Strangers::told_in_cells || !is_strangers(cell, catalogue);
  }
  return job;
}

RunOutcome run_suite(const RunPlan& plan, const Catalogue& catalogue) { return Run(plan, catalogue).play(); }

}  // namespace lgabench

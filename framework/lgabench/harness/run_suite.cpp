#include <lgabench/harness/run_suite.hpp>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <random>
#include <set>
#include <thread>

#include <lgabench/core/colour.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/scratch.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/core/version.hpp>
#include <lgabench/harness/progress.hpp>
#include <lgabench/host/confine.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench {
namespace {

const PluginInfo* method_plugin(const Cell& cell, const Catalogue& catalogue) {
  return cell.method.is_reference() ? nullptr : &catalogue.find("method", cell.method.id);
}

const PluginInfo* acting_plugin(const Cell& cell, const Catalogue& catalogue) {
  return cell.method.acts ? &catalogue.find("method", cell.method.acts->id) : nullptr;
}

std::vector<PluginInfo> axis_plugins(const Cell& cell, const Catalogue& catalogue) {
  std::vector<PluginInfo> plugins;
  for (const std::string& id : cell.plugin_axes()) plugins.push_back(catalogue.find("perturbation", id));
  return plugins;
}

Json build_of(const Cell& cell, const Catalogue& catalogue) {
  Json build = build_hashes(catalogue.find("engine", cell.engine), method_plugin(cell, catalogue), cell.needs_axes());
  if (const PluginInfo* acts = acting_plugin(cell, catalogue)) build["acts"] = acts->sha256;
  for (const PluginInfo& axis : axis_plugins(cell, catalogue)) add_axis(build, axis);
  return build;
}

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

Json answers_json(const std::vector<AnswerFile>& files) {
  Json answers = Json::array();
  for (const AnswerFile& file : files) {
    answers.push_back(file.about);
    answers.back().update({{"file", file.path.string()}, {"name", file.name}});
  }
  return answers;
}

// Cells that others will compute again are played in another order each time: who passes anything on acts otherwise.
std::optional<std::uint32_t> order_of(const RunPlan& plan) {
  if (plan.strangers != Strangers::told_nothing) return std::nullopt;
  return std::random_device()();
}

// A run that goes on must find what its cells were told: what was asked is not asked again.
void expect_replies_of(const RunPlan& plan) {
  const std::optional<AnswerFile> kept = kept_replies(plan.out);
  if (kept && (!fs::exists(plan.live->cassette) || !holds_lines(plan.live->cassette, kept->path)))
    throw InputError(fmt::format("{}: lacks replies that {} is based on; they are in {}: copy that file there",
                                 plan.live->cassette.string(), plan.out.string(), kept->path.string()));
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

// The part of the run that is computed now; none where that is all of it.
std::optional<RunRecord::Shard> shard_of(const RunPlan& plan) {
  if (plan.shard.count == 1) return std::nullopt;
  return RunRecord::Shard{plan.shard.index, plan.shard.count, cells_of(plan.cells, plan.shard).size()};
}

Json machine() {
  utsname system{};
  ::uname(&system);
  return {{"processor", processor()},
          {"cores", std::thread::hardware_concurrency()},
          {"memory_gib", std::round(machine_bytes() / (1 << 30) * 10) / 10},
          {"system", fmt::format("{} {}", system.sysname, system.release)}};
}

RunRecord record_of(const RunPlan& plan, const Catalogue& catalogue) {
  RunRecord run;
  std::set<std::string> named;
  const auto name = [&](const PluginInfo& info) {
    if (!named.insert(info.kind + info.id).second) return;
    run.plugins.push_back({info.kind, info.id, info.version, info.sha256, info.asks});
  };
  for (const Cell& cell : plan.cells) {
    run.cells.push_back(key(cell));
    name(catalogue.find("engine", cell.engine));
    for (const PluginInfo& axis : axis_plugins(cell, catalogue)) name(axis);
    if (const PluginInfo* method = method_plugin(cell, catalogue)) {
      name(*method);
      if (const PluginInfo* acts = acting_plugin(cell, catalogue)) name(*acts);
      for (const auto& [option, value] : cell.method.options.items()) {
        const auto known = method->options.find(option);  // none: of a plugin that had it when its run was recorded
        if (known == method->options.end() || value != known->at("default"))
          run.settings[cell.method.name][option] = value;
      }
    }
    run.build.update(build_of(cell, catalogue));
    for (const std::string& id : cell.plugin_axes()) run.build.erase(axis_in_build(id));
  }
  for (const char* plugin : {"engine", "method", "python", "acts"}) run.build.erase(plugin);
  run.suite = plan.request.at("suite");
  run.preset = plan.request.at("preset");
  run.smoke = plan.cells.front().smoke;
  run.request = plan.request;
  run.about = plan.about;
  run.claims = plan.claims;
  run.version = LGABENCH_VERSION;
  run.program = plan.program;
  run.command = plan.command;
  run.confinement = plan.confined ? confinement_text() : unconfined_run;
  run.answers = answers_json(plan.answers);
  run.started = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  run.machine = machine();
  run.shard = shard_of(plan);
  return run;
}

// Status of a cell whose worker left none.
CellStatus failure(const WorkerEnd& end, double timeout_s, const fs::path& log, const Json& build) {
  const auto [reason, fault] = why_it_ended(end, timeout_s);
  CellStatus status;
  status.failed = true;
  status.reason = reason;
  status.fault = fault;
  status.signal = end.signal ? end.signal : end.complaint ? end.complaint->signal : 0;
  status.log_tail = log_tail(log);
  status.build = build;
  return status;
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
    if (state.other_build)
      ++other_build, why = state.why;
    else if (!state.why.empty())
      to_stderr("{}: {}; computed again\n", cell->title(), state.why);
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

// What a plugin printed without end is not kept whole. Called where nobody writes any more.
void cut_log(const fs::path& log) {
  constexpr std::size_t most = std::size_t{1} << 20;  // of its begin, and of its end
  if (fs::symlink_status(log).type() != fs::file_type::regular) {
    fs::remove_all(log);
    write_file(log, "");
  }
  if (fs::file_size(log) <= 2 * most) return;
  const std::string all = read_file(log, Links::refused);
  write_file(log, fmt::format("{}\n[{} bytes left out]\n{}", all.substr(0, most), all.size() - 2 * most,
                              all.substr(all.size() - most)));
}

// Accepts the cell if its files match the worker's checksums; otherwise leaves only status.json and the log. Returns
// the reason of a failure, or "".
std::string settle(const Cell& cell, const WorkerEnd& end, const fs::path& scratch, const Json& build,
                   double timeout_s) {
  cut_log(scratch / cell_file::log);
  const bool ended_well = end.exit_code == 0 && end.signal == 0;
  const CellState state = ended_well && has_status(scratch) ? cell_state(scratch, key(cell), build) : CellState();
  if (state.complete) return "";
  CellStatus status = failure(end, timeout_s, scratch / cell_file::log, build);
  if (!state.why.empty()) status.reason = state.why;  // a plugin touched what was written
  for (const auto& entry : fs::directory_iterator(scratch))
    if (entry.path().filename() != cell_file::log) fs::remove_all(entry.path());  // parts of a result are none
  write_file(scratch / cell_file::configuration, canonical(to_json(cell)) + '\n');
  write_cell_status(scratch, status);
  return status.reason;
}

// A cell that could not be put in its place as it ended: without its files, or with none at all on a full disk.
void record_failure(const RunDirectory& directory, const Cell& cell, const std::string& reason,
                    const std::string& fault, const Json& build) {
  CellStatus status;
  status.failed = true;
  status.reason = reason;
  status.fault = fault;
  status.build = build;
  try {
    const fs::path scratch = directory.scratch(key(cell));
    write_file(scratch / cell_file::log, "");
    write_file(scratch / cell_file::configuration, canonical(to_json(cell)) + '\n');
    write_cell_status(scratch, status);
    directory.keep(key(cell));
  } catch (const std::exception& e) {
    to_stderr("{}: {}\n", cell.title(), one_line(e.what()));
  }
}

// What the disks lack, said before cells are computed for them.
void warn_of_disks(const RunPlan& plan, double run_bytes) {
  std::error_code error;
  const fs::space_info space = fs::space(plan.out, error);
  if (!error && static_cast<double>(space.available) < run_bytes)
    to_stderr("{}: the cells need about {} of disk, and {} are free\n", plan.out.string(), size_text(run_bytes),
              size_text(static_cast<double>(space.available)));
  fs::create_directories(plan.cache, error);
  if (!error && ::access(plan.cache.c_str(), W_OK) != 0) error = std::error_code(errno, std::generic_category());
  if (error)
    to_stderr("{}: cannot be written: {}; each cell makes its demonstrations again\n", plan.cache.string(),
              error.message());
}

}  // namespace

std::string run_hash(const std::vector<Cell>& cells, const Catalogue& catalogue) {
  std::string all;
  for (const Cell& cell : cells) all += key(cell) + canonical(build_of(cell, catalogue));
  return sha256(all).substr(0, 8);
}

bool is_strangers(const Cell& cell, const Catalogue& catalogue) {
  const PluginInfo* const method = cell.method.acts ? acting_plugin(cell, catalogue) : method_plugin(cell, catalogue);
  if (!method) return false;
  const fs::path shipped = fs::weakly_canonical(shipped_plugin_directory());
  return std::none_of(catalogue.plugins.begin(), catalogue.plugins.end(), [&](const PluginInfo& one) {
    return one.sha256 == method->sha256 && fs::weakly_canonical(one.file).parent_path() == shipped;
  });
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
  Forecast expected = forecast(complete, missing, costs, plan.pool.jobs);
  if (plan.live && plan.live->asks)
    if (const std::vector<Json> scenarios = asked_about(missing, catalogue); !scenarios.empty())
      expected.questions = count_questions(*plan.live, asked_model_of(plan), scenarios);
  return expected;
}

CellJob cell_job(const RunPlan& plan, const Catalogue& catalogue, const Cell& cell, const fs::path& directory,
                 const fs::path& answers, const fs::path& scratch) {
  CellJob job{cell,          catalogue.find("engine", cell.engine),
              std::nullopt,  directory,
              plan.cache,    answers,
              scratch,       build_of(cell, catalogue),
              plan.confined, worker_limits(plan.pool),
              plan.live};
  job.keeps_policy = plan.keeps_policies;
  job.axes = axis_plugins(cell, catalogue);
  if (const PluginInfo* method = method_plugin(cell, catalogue)) {
    job.method = *method;
    if (const PluginInfo* acts = acting_plugin(cell, catalogue)) job.acts = *acts;  // which alone is told the truth
    job.attributed = plan.strangers == Strangers::told_in_cells || !is_strangers(cell, catalogue);
  }
  return job;
}

RunOutcome run_suite(const RunPlan& plan, const Catalogue& catalogue) {
  const bool unconfined = plan.existing != Existing::fresh && is_unconfined(plan.out);
  const RunDirectory directory(plan.out, record_of(plan, catalogue), plan.existing);
  directory.amend([&](RunRecord& run) {
    if (unconfined) run.confinement = unconfined_run;
    if (run.shard != shard_of(plan)) run.shard.reset();  // the directory holds another part as well
  });
  keep_answers(plan.answers, plan.out);
  const bool asks = plan.live && plan.live->asks;
  if (asks) expect_replies_of(plan);
  const auto [complete, missing] = shard_state(plan, catalogue, directory);
  if (!plan.confined && !missing.empty()) directory.amend([](RunRecord& run) { run.confinement = unconfined_run; });
  RunOutcome outcome;
  outcome.reused = complete.size();
  Schedule schedule(missing, order_of(plan), plan.costs);
  for (const Cell* cell : complete) schedule.learn(*cell, recorded_seconds(directory.cell(key(*cell))));

  const Forecast expected = forecast(complete, missing, schedule.costs(), plan.pool.jobs);
  if (!missing.empty()) {
    constexpr double long_s = 600;
    const bool is_long = expected.wall_s > long_s;
    if (!plan.quiet)
      put(stderr,
          painted(stderr, is_long ? Colour::yellow : Colour::bold, expected.text(plan.pool.jobs, plan.purpose)) +
              (is_long && plan.purpose.empty() ? "; --dry-run shows of what\n" : "\n"));
    if (plan.purpose.empty()) warn_of_disks(plan, expected.run_bytes);
  }

  if (asks && !ask_for(missing, plan, catalogue)) {
    keep_replies_of(plan, directory);
    outcome.interrupted = true;
    return outcome;
  }

  Progress progress(
      missing.size(), plan.pool.jobs, [&schedule] { return schedule.left_s(); }, plan.quiet);
  std::vector<const Cell*> played(missing.size());
  std::vector<fs::path> scratch(missing.size());
  const Scratch hosts("hosts");  // not below the run's directory: a method does not learn where that is
  const auto make = [&](std::size_t i) {
    played[i] = schedule.next();
    const Cell& cell = *played[i];
    scratch[i] = directory.scratch(key(cell));
    const fs::path own = hosts.path / std::to_string(i);
    fs::create_directory(own);
    return WorkerTask{to_json(cell_job(plan, catalogue, cell, scratch[i], plan.out / "answers", own)),
                      scratch[i] / cell_file::log};
  };
  std::set<std::string> failed;
  PoolEvents events;
  events.started = [&](std::size_t i) {
    progress.started(i, played[i]->title(), schedule.costs().expected_seconds(*played[i]));
  };
  events.progress = [&](std::size_t i, const std::string& phase, long long n) { progress.phase(i, phase, n); };
  events.tick = [&] { progress.tick(); };
  events.ended = [&](std::size_t i, const WorkerEnd& end) {
    const Cell& cell = *played[i];
    constexpr int refused = 4;  // the worker's exit status for a plugin that cannot be loaded
    const Json build = build_of(cell, catalogue);
    std::string reason;
    // What a plugin did to the directory, or a full disk, ends this cell and no other.
    try {
      if (scratch[i].empty()) throw InputError(why_it_ended(end, plan.pool.timeout_s).reason);
      reason = settle(cell, end, scratch[i], build, plan.pool.timeout_s);
      directory.keep(key(cell));
      directory.sync();
      if (reason.empty()) add_phases(directory.cell(key(cell)), outcome.time);
    } catch (const InputError& e) {
      record_failure(directory, cell, reason = e.what(), "host", build);
    } catch (const std::exception& e) {
      record_failure(directory, cell, reason = e.what(), "plugin", build);
    }
    remove_tree(hosts.path / std::to_string(i));
    outcome.time.workers_s += end.seconds;
    const fs::path kept = directory.cell(key(cell));
    if (reason.empty()) {
      ++outcome.computed;
      schedule.learn(cell, end.seconds);
    } else {
      outcome.failed.push_back({cell.title(), reason, kept / cell_file::log});
      outcome.plugin_refused |= end.exit_code == refused && end.complaint && end.complaint->refused;
      failed.insert(key(cell));
    }
    progress.ended(i, reason.empty() ? "" : "failed: " + reason);
  };
  const auto start = std::chrono::steady_clock::now();
  outcome.interrupted = !run_workers(missing.size(), make, plan.pool, events);
  outcome.time.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (asks) keep_replies_of(plan, directory);
  if (outcome.interrupted) return outcome;
  // The last word is the disk's: a cell that was there, or was computed, and is not as it was kept has failed.
  const auto expect_there = [&](const Cell& cell, std::size_t& count) {
    const CellState state = directory.state(key(cell), build_of(cell, catalogue));
    if (state.complete) return;
    --count;
    outcome.failed.push_back({cell.title(), "was kept and is gone: " + (state.why.empty() ? "no files" : state.why),
                              directory.cell(key(cell)) / cell_file::log});
  };
  for (const Cell* cell : complete) expect_there(*cell, outcome.reused);
  for (const Cell* cell : played)
    if (failed.count(key(*cell)) == 0) expect_there(*cell, outcome.computed);
  std::set<std::string> ours;
  for (const Cell* cell : cells_of(plan.cells, plan.shard)) ours.insert(key(*cell));
  for (const Cell& cell : plan.cells)
    outcome.elsewhere += ours.count(key(cell)) == 0 && !has_status(directory.cell(key(cell)));
  return outcome;
}

}  // namespace lgabench

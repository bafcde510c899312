// lgabench cluster: scripts that play a run as an array of Slurm's. It submits nothing.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <regex>
#include <set>
#include <string_view>

#include <lgabench/cli/run_plan.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/directories.hpp>
#include <lgabench/core/shell.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/run_directory.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench::cli {
namespace {

struct ClusterArguments {
  RunArguments run;
  int elements = 0, cpus = 4;
  std::string time, partition;
  fs::path timings;
};

// Options that an element of the array gets from its script, or that only `cluster` has; each takes a value.
constexpr std::array<std::string_view, 9> own_options{"--elements", "--cpus", "--time",   "--partition", "--timings",
                                                      "--out",      "--jobs", "--memory", "--shard"};

// What was typed, without those.
Words run_words() {
  const Words typed = command_line();
  Words words{"run"};
  for (std::size_t i = 2; i < typed.size(); ++i) {
    const std::string option = typed[i].substr(0, typed[i].find('='));
    if (!contains(own_options, option))
      words.push_back(typed[i]);
    else
      i += option == typed[i];
  }
  return words;
}

constexpr double stops_before_s = 120, shortest_s = 300;

// Seconds of "HH:MM:SS" or "D-HH:MM:SS", as Slurm reads them.
double seconds_of(const std::string& time) {
  static const std::regex form("(?:(\\d{1,3})-)?(\\d{1,3}):([0-5]\\d):([0-5]\\d)");
  std::smatch parts;
  if (!std::regex_match(time, parts, form))
    throw InputError(fmt::format("--time {}: expected HH:MM:SS or D-HH:MM:SS", time));
  const auto part = [&parts](int i) { return parts[i].matched ? std::stod(parts[i]) : 0; };
  return ((part(1) * 24 + part(2)) * 60 + part(3)) * 60 + part(4);
}

// What cells took in a run that was played, say a smoke run on one of the cluster's machines.
Costs costs_of(const fs::path& run) {
  Costs costs;
  if (run.empty()) return costs;
  expect_run(run);
  for (const std::string& name : read_run_record(run).cells) {
    const fs::path cell = run / "cells" / name;
    if (fs::exists(cell / cell_file::timing)) costs.learn(recorded_cell(cell), recorded_seconds(cell));
  }
  return costs;
}

// Of the element that is expected to take longest; its wall_s is that on its cores.
Forecast longest_of(const PlannedRun& planned, const ClusterArguments& a) {
  const Costs costs = costs_of(a.timings);
  const auto is_unknown = [&planned](const Cell& cell) { return takes_unknown_time(cell, planned.catalogue); };
  Forecast longest;
  for (int i = 1; i <= a.elements; ++i) {
    Forecast one = forecast({}, cells_of(planned.plan.cells, {i, a.elements}), costs, a.cpus, is_unknown);
    one.wall_s = std::max(one.work_s / a.cpus, one.longest_s);
    one.unknown = one.unknown || longest.unknown;
    if (one.wall_s >= longest.wall_s) longest = std::move(one);
  }
  return longest;
}

// A value of an #SBATCH line, where Slurm reads quotes, and in a path of a log "%j" and the like.
std::string quoted(const std::string& value) {
  if (value.find_first_of("\"\\\n") != std::string::npos)
    throw InputError(fmt::format("{}: expected no quote, backslash or line break, which Slurm's options cannot have",
                                 one_line(value)));
  return '"' + value + '"';
}

std::string log_of(const fs::path& out, const char* name) {
  std::string path;
  for (const char c : (out / "logs").string()) path += c == '%' ? "%%" : std::string(1, c);
  return quoted(path + "/" + name);
}

std::string header(const ClusterArguments& a, const std::string& name, const std::string& time, const fs::path& out,
                   const char* log) {
  return fmt::format(
      "#!/bin/bash\n#SBATCH --job-name={}\n#SBATCH --ntasks=1\n#SBATCH --time={}\n#SBATCH --output={}\n{}",
      quoted(name), time, log_of(out, log),
      a.partition.empty() ? "" : fmt::format("#SBATCH --partition={}\n", quoted(a.partition)));
}

std::string array_script(const ClusterArguments& a, const std::string& program, const fs::path& out,
                         double memory_gib) {
  return header(a, "lgabench-" + a.run.suite, a.time, out, "%A_%a.txt") +
         fmt::format(
             R"(#SBATCH --array=1-{0}
#SBATCH --cpus-per-task={1}
#SBATCH --mem={2:.0f}M
#SBATCH --signal=B:TERM@{7:.0f}
#SBATCH --requeue
# Submitted again, an element computes what it lacks and nothing else. Two minutes before the limit it stops by itself.
cd {3} || exit 2
scratch=$(mktemp -d "${{TMPDIR:-/tmp}}/lgabench-XXXXXX") || exit 2
export TMPDIR=$scratch LGABENCH_CACHE=$scratch/cache
{4} --shard "$SLURM_ARRAY_TASK_ID/{0}" --out {5}/part-"$SLURM_ARRAY_TASK_ID" --jobs {1} --memory {6:.2f} &
run=$!
trap 'kill -TERM $run' TERM
wait $run
status=$?
while kill -0 $run 2>/dev/null; do wait $run; status=$?; done
rm -rf "$scratch"
exit $status
)",
             a.elements, a.cpus, memory_gib * 1024 * a.cpus + 512, shell_line({fs::current_path().string()}), program,
             shell_line({out.string()}), memory_gib, stops_before_s);
}

std::string merge_script(const ClusterArguments& a, const std::string& program, const fs::path& out) {
  const std::string where = shell_line({out.string()});
  return header(a, "lgabench-merge", "01:00:00", out, "merge_%j.txt") +
         fmt::format("{0} status {1}\nexec {0} merge {1}/whole {1}/part-*/\n", program, where);
}

std::string submit_script(const fs::path& out, int elements) {
  return fmt::format(
      "#!/bin/bash\n# Options go to the array: submit --array=3,7\nset -eu\nmkdir -p {0}/logs\n"
      "if ! command -v sbatch >/dev/null; then\n"
      "  echo \"sbatch was not found: call this script where Slurm is. Without Slurm, GNU parallel can play the "
      "elements,"
      " one after another here or with -S on other machines:\" >&2\n"
      "  printf '  seq {1} | parallel -j1 SLURM_ARRAY_TASK_ID={{}} bash %q\\n  bash %q\\n' {0}/array.sbatch "
      "{0}/merge.sbatch >&2\n"
      "  exit 127\nfi\n"
      "array=$(sbatch --parsable \"$@\" {0}/array.sbatch)\n"
      "sbatch --dependency=\"afterany:${{array%%;*}}\" {0}/merge.sbatch\n",
      shell_line({out.string()}), elements);
}

// Options of one call, which an element would obey each time it is submitted or requeued.
void expect_repeatable(const RunArguments& run) {
  for (const auto& [given, option] :
       {std::pair{run.fresh, "--fresh"}, {run.dry_run, "--dry-run"}, {!run.debug.empty(), "--debug"}})
    if (given) throw InputError(fmt::format("{}: an option of run only; an element resumes where it stopped", option));
}

int write_scripts(ClusterArguments a) {
  expect_repeatable(a.run);
  if (seconds_of(a.time) < shortest_s)
    throw InputError(fmt::format("--time {}: expected {} s at least: an element stops {} s before its limit", a.time,
                                 shortest_s, stops_before_s));
  const double usable_s = seconds_of(a.time) - stops_before_s;
  const fs::path out = fs::absolute(a.run.out.empty() ? "runs/" + a.run.suite + "-cluster" : a.run.out);
  a.run.out = out.string();
  const PlannedRun planned = plan_run(a.run);
  const RunPlan& plan = planned.plan;
  if (static_cast<std::size_t>(a.elements) > plan.cells.size())
    throw InputError(fmt::format("--elements {}: the run has {} cells", a.elements, plan.cells.size()));
  const double memory_gib = a.run.memory_gib > 0 ? a.run.memory_gib : 4;
  const std::string program = shell_line({(program_directory() / "lgabench").string()});
  write_file(out / array_script_name, array_script(a, program + " " + shell_line(run_words()), out, memory_gib));
  write_file(out / "merge.sbatch", merge_script(a, program, out));
  write_file(out / "submit", submit_script(out, a.elements));
  fs::permissions(out / "submit", fs::perms::owner_exec, fs::perm_options::add);
  make_directories(out / "logs");
  const Forecast longest = longest_of(planned, a);
  const double expected_s = longest.wall_s;
  to_stdout("{} cells in {} elements; the longest takes {} on {} cores, {}\n", plan.cells.size(), a.elements,
            longest.unknown ? "an unknown time, at least " + duration_text(expected_s) : longest.duration(), a.cpus,
            a.timings.empty() ? "by cells measured elsewhere (--timings: by your own)"
                              : "by the cells of " + a.timings.string());
  if (expected_s > .8 * usable_s)
    to_stdout("--time {} is too short for that: {} elements would fit, or submit the array again\n", a.time,
              static_cast<int>(a.elements * expected_s / (.6 * usable_s)) + 1);
  to_stdout("To submit: {}/submit\nThen: lgabench status {}\n", shell_line({out.string()}), shell_line({out.string()}));
  return ok;
}

}  // namespace

void add_cluster(CLI::App& app, int& exit) {
  auto a = std::make_shared<ClusterArguments>();
  Verb verb(app, "cluster", "Write scripts that compute a run as a Slurm job array");
  add_run_options(verb, a->run);
  std::set<std::string> of_run;
  for (const CLI::Option* option : verb->get_options())
    if (option->nonpositional() && option->get_name() != "--out" && option != verb->get_help_ptr() &&
        option != verb->get_help_all_ptr())
      of_run.insert(option->get_name());
  verb.leave_to_help_all(of_run);
  verb.below("The array");
  verb.option("--elements N", a->elements,
              "Number of elements of the job array, each a part of the run; a few long ones are best", required,
              CLI::Range(1, 100000));
  verb.option("--time TIME", a->time, "Time limit of an element, as HH:MM:SS", required);
  verb.option("--partition NAME", a->partition, "Slurm partition");
  verb.option("--cpus N", a->cpus, "Cores per element, each computing a cell", CLI::Range(1, 4096), with_default);
  verb.option("--timings RUN", a->timings,
              "A run, for instance of the preset smoke, whose times are used to predict the duration");
  verb->footer(
      "Example: lgabench cluster q1 --preset leaderboard --elements 40 --time 02:00:00 --out runs/q1\ncluster writes "
      "three scripts into --out: array.sbatch, merge.sbatch (which merges the parts and makes the report) and submit. "
      "It submits nothing itself.\ncluster takes the options of `lgabench run` too, except --fresh, --dry-run and "
      "--debug.");
  verb->callback([a, &exit] { exit = write_scripts(*a); });
}

}  // namespace lgabench::cli

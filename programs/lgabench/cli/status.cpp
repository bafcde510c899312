// lgabench status: how far the parts of a run are.
#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <set>
#include <utility>

#include <lgabench/cli/outcome.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/parallel.hpp>
#include <lgabench/core/shell.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/counted_progress.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/report/index.hpp>

namespace lgabench::cli {
namespace {

struct Part {
  std::string name;
  int shard = 1, shards = 1;
  std::size_t cells = 0, done = 0, failed = 0, playing = 0;
  std::vector<std::string> left_out{};  // why, of each failed cell that a report leaves out
  bool running = false;                 // somebody writes into it

  std::size_t missing() const { return cells - std::min(cells, done + failed + playing); }
  bool finished() const { return done >= cells; }
};

Part read_part(const fs::path& run) {
  const RunRecord record = read_run_record(run);
  Part part{run.string(), 1, 1, record.cells.size()};
  if (record.shard) part = {run.string(), record.shard->index, record.shard->count, record.shard->cells};
  part.running = report::is_being_written(run);
  expect_plain_run(run);
  std::mutex mutex;
  in_parallel(record.cells.size(), [&](std::size_t i) {  // as a report reads them, which leaves out what is damaged
    const fs::path cell = run / "cells" / record.cells[i];
    std::error_code not_there;
    if (!fs::exists(cell, not_there)) return;
    bool failed = true;
    std::string why;
    try {
      failed = statistics::read_cell(cell).failed;
    } catch (const InputError& e) {
      why = one_line(e.what());
    }
    const std::lock_guard lock(mutex);
    ++(failed ? part.failed : part.done);
    if (!why.empty()) part.left_out.push_back(std::move(why));
  });
  std::sort(part.left_out.begin(), part.left_out.end());
  std::error_code none_there;
  for (const auto& entry : fs::directory_iterator(run / "cells", none_there))
    part.playing += part.running && entry.path().filename().string()[0] == '.';
  return part;
}

// A run, or the runs in a directory of parts.
std::vector<fs::path> runs_in(const fs::path& directory) {
  if (is_run(directory)) return {directory};
  std::vector<fs::path> runs;
  std::error_code none_there;
  for (const auto& entry : fs::directory_iterator(directory, none_there))
    if (entry.path().filename() != "whole" && is_run(entry.path())) runs.push_back(entry.path());
  if (runs.empty() && array_elements(directory) == 0) expect_run(directory);
  std::sort(runs.begin(), runs.end());
  return runs;
}

// "1,4-6"
std::string ranges(const std::set<int>& numbers) {
  std::string text;
  for (auto at = numbers.begin(); at != numbers.end();) {
    const int first = *at;
    int last = first;
    while (++at != numbers.end() && *at == last + 1) last = *at;
    text += (text.empty() ? "" : ",") + (first == last ? std::to_string(first) : fmt::format("{}-{}", first, last));
  }
  return text;
}

// Before an element of an array has begun.
int print_none_begun(const std::vector<fs::path>& directories, bool json) {
  for (const fs::path& directory : directories) {
    const int elements = array_elements(directory);
    std::set<int> all;
    for (int i = 1; i <= elements; ++i) all.insert(all.end(), i);
    if (json)
      to_stdout(
          "{}\n",
          canonical({{"shards", elements}, {"parts", Json::array()}, {"array", ranges(all)}, {"absent", ranges(all)}}));
    else
      to_stdout("{}: {} of {} parts missing, none has begun\nto submit: {}\n", one_line(directory.string()), elements,
                elements, shell_line({(directory / "submit").string()}));
  }
  return cells_failed;
}

int print_status(const std::vector<fs::path>& directories, bool json) {
  std::vector<Part> parts;
  std::vector<fs::path> runs;
  for (const fs::path& directory : directories)
    for (fs::path& run : runs_in(directory)) runs.push_back(std::move(run));
  CountedProgress progress("runs read:", static_cast<int>(runs.size()));
  for (const fs::path& run : runs) {
    parts.push_back(read_part(run));
    progress.tell_next();
  }
  progress.end();
  std::sort(parts.begin(), parts.end(),
            [](const Part& a, const Part& b) { return std::pair(a.shard, a.name) < std::pair(b.shard, b.name); });
  if (parts.empty()) return print_none_begun(directories, json);
  const int shards = parts.front().shards;
  std::set<int> open;
  for (int i = 1; i <= shards; ++i) open.insert(i);
  std::set<int> there;
  for (const Part& part : parts) {
    if (part.shards != shards)
      throw InputError(fmt::format("{} is one of {} shards, {} one of {}: not parts of one run", parts.front().name,
                                   shards, part.name, part.shards));
    there.insert(part.shard);
    if (part.finished() || part.running) open.erase(part.shard);
  }
  std::set<int> absent;
  for (int i = 1; i <= shards; ++i)
    if (there.count(i) == 0) absent.insert(i);
  if (json) {
    Json list = Json::array();
    for (const Part& part : parts)
      list.push_back({{"run", part.name},
                      {"shard", part.shard},
                      {"cells", part.cells},
                      {"done", part.done},
                      {"running", part.playing},
                      {"failed", part.failed},
                      {"missing", part.missing()},
                      {"locked", part.running}});
    to_stdout("{}\n",
              canonical({{"shards", shards}, {"parts", list}, {"array", ranges(open)}, {"absent", ranges(absent)}}));
  } else {
    to_stdout("{:>7}  {:>7}  {:>7}  {:>7}  {:>7}  {:>7}  run\n", "shard", "cells", "done", "running", "failed",
              "missing");
    for (const Part& part : parts)
      to_stdout("{:>7}  {:>7}  {:>7}  {:>7}  {:>7}  {:>7}  {}{}\n", fmt::format("{}/{}", part.shard, part.shards),
                part.cells, part.done, part.playing, part.failed, part.missing(), one_line(part.name),
                part.running ? " (running)" : "");
    if (!absent.empty()) to_stdout("not begun: {}\n", ranges(absent));
    if (!open.empty()) to_stdout("to finish: --array={}\n", ranges(open));
  }
  for (const Part& part : parts)
    for (const std::string& why : part.left_out) to_stderr("left out: {}\n", why);
  return open.empty() ? ok : cells_failed;
}

}  // namespace

void add_status(CLI::App& app, int& exit) {
  struct Options {
    std::vector<fs::path> directories;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  Verb verb(app, "status", "Show the progress of a run's parts, and which of them to run again");
  verb.option("DIR", options->directories, "Runs, or directories whose subdirectories are runs", required);
  verb.option("--json", options->json, "Print JSON instead of a table");
  verb->footer(
      "Example: lgabench status runs/q1\nExit 0: all parts are complete or running. Exit 3: some must be run again; "
      "status lists them as --array.");
  verb->callback([options, &exit] { exit = print_status(options->directories, options->json); });
}

}  // namespace lgabench::cli

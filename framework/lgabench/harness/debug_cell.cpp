#include <lgabench/harness/debug_cell.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <sstream>
#include <vector>

#include <lgabench/core/files.hpp>
#include <lgabench/core/scratch.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench {
namespace {

// Where a shell would find it, or "".
std::string on_path(const std::string& program) {
  const char* const directories = std::getenv("PATH");
  std::istringstream all(directories ? directories : "");
  for (std::string directory; std::getline(all, directory, ':');) {
    const fs::path file = fs::path(directory) / program;
    if (file.is_absolute() && ::access(file.c_str(), X_OK) == 0 && !fs::is_directory(file)) return file.string();
  }
  return "";
}

// Words that a plugin's process is started with: its library is loaded later than a breakpoint is set.
std::vector<std::string> gdb() {
  const std::string program = on_path("gdb");
  if (program.empty())
    throw InputError(
        fmt::format("--debug: gdb is not installed (Debian: apt-get install gdb); with it this command starts the "
                    "method's process as\n"
                    "  gdb -q -ex 'set breakpoint pending on' --args {}",
                    (program_directory() / "lgabench-method").string()));
  return {program, "-q", "-ex", "set breakpoint pending on", "--args"};
}

const Cell& named(const std::vector<Cell>& cells, const std::string& key_begin) {
  const Cell* found = nullptr;
  std::string all;
  int count = 0;
  for (const Cell& cell : cells) {
    const std::string its_key = key(cell);
    if (its_key.rfind(key_begin, 0) == 0) found = &cell, ++count;
    all += fmt::format("\n  {}  {}", its_key, cell.title());
  }
  if (count != 1)
    throw InputError(
        fmt::format("--debug {}: {} of the run's cell keys begin so, expected one of{}", key_begin, count, all));
  return *found;
}

}  // namespace

int debug_cell(RunPlan plan, const Catalogue& catalogue, const std::string& key) {
  const Cell& cell = named(plan.cells, key);
  if (cell.method.is_reference())
    throw InputError(fmt::format("--debug {}: {} is a reference row, which has no method", key, cell.title()));
  const bool python = !catalogue.find("method", cell.method.id).python.is_null();
  const std::vector<std::string> debugger = python ? std::vector<std::string>() : gdb();
  const Scratch scratch("debug");
  for (const char* name : {"cell", "method"}) fs::create_directory(scratch.path / name);
  keep_answers(plan.answers, scratch.path);
  plan.confined = false;
  CellJob job =
      cell_job(plan, catalogue, cell, scratch.path / "cell", scratch.path / "answers", scratch.path / "method");
  job.limits = Limits();  // a person has time
  job.debugger = debugger;
  to_stderr("{}\nthe method runs unconfined, with your rights; {}; no result is kept\n", cell.title(),
            python ? "breakpoint() in the file stops there"
                   : "set breakpoints (break MyMethod::select), then run; quit ends the cell");
  return run_in_foreground(to_json(job));
}

}  // namespace lgabench

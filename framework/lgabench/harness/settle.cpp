#include <lgabench/harness/settle.hpp>

#include <fmt/format.h>

#include <lgabench/core/files.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/record/cell_status.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench {
namespace {

// Status of a cell whose worker left none.
CellStatus failed_status(const WorkerEnd& end, double timeout_s, const fs::path& log, const Json& build) {
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

}  // namespace

std::string settle(const Cell& cell, const WorkerEnd& end, const fs::path& scratch, const Json& build,
                   double timeout_s) {
  cut_log(scratch / cell_file::log);
  const bool ended_well = end.exit_code == 0 && end.signal == 0;
  const CellState state = ended_well && has_status(scratch) ? cell_state(scratch, key(cell), build) : CellState();
  if (state.complete) return "";
  CellStatus status = failed_status(end, timeout_s, scratch / cell_file::log, build);
  if (!state.why.empty()) status.reason = state.why;  // a plugin touched what was written
  for (const auto& entry : fs::directory_iterator(scratch))
    if (entry.path().filename() != cell_file::log) fs::remove_all(entry.path());  // parts of a result are none
  write_file(scratch / cell_file::configuration, canonical(to_json(cell)) + '\n');
  write_cell_status(scratch, status);
  return status.reason;
}

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

}  // namespace lgabench

// status.json of a cell, which is written last: whether its results are whole, and what computed them.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <lgabench/core/json.hpp>

namespace lgabench {

struct CellStatus {
  bool failed = false;
  std::string reason, fault;          // of a failed cell; fault: "plugin" or "host"
  int signal = 0;                     // that ended its worker or its method's process; 0: none did
  std::vector<std::string> log_tail;  // what its worker printed last
  std::string method_error;           // of a finished one: what the first act() that failed threw; "" where none did
  Json build = Json::object();        // what computed it: program or library -> SHA-256, as build_hashes()
  std::map<std::string, std::string> files{};  // its results' files -> SHA-256
};

/// Whether the cell in that directory finished or failed: what was never begun or was stopped has no status.
bool has_status(const std::filesystem::path& cell);
/// No link is followed. @throws InputError naming file and place
CellStatus read_cell_status(const std::filesystem::path& cell);
/// Writes the file, atomically.
void write_cell_status(const std::filesystem::path& cell, const CellStatus& status);

/// The first file of the cell whose bytes are not those that its status names; "" where there is none.
/// @throws InputError where one cannot be read.
std::filesystem::path changed_file(const std::filesystem::path& cell, const CellStatus& status);

/// Whether a cell is complete with a build, and if not, why: "" where it was never begun.
struct CellState {
  bool complete = false, failed = false, other_build = false;
  std::string why;
  Json build;  // what computed a complete cell
};
/// State of the cell `key` in `directory`, read from its files alone.
CellState cell_state(const std::filesystem::path& directory, const std::string& key, const Json& build);

}  // namespace lgabench

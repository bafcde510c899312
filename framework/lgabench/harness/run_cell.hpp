// One cell from its configuration to its files: the paper's figure 1 as a function.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/harness/answers.hpp>
#include <lgabench/harness/cell.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench {

struct CellJob {
  Cell cell;
  PluginInfo engine;
  std::optional<PluginInfo> method;                    // none for a reference row
  std::filesystem::path directory;                     // gets the cell's files
  std::filesystem::path cache;                         // of demonstrations
  std::filesystem::path answers;                       // files of answers that the cell names (see answers.hpp)
  std::filesystem::path scratch;                       // empty, of the method's process
  Json build;                                          // of build_hashes()
  bool confined = true;                                // the method's process, see host/confine.hpp
  long long memory_bytes = 0;                          // of it; 0: no limit
  std::optional<std::vector<std::string>> debugger{};  // of HostJob
  LiveModel live{};                                    // where the cell asks one
};

/// Says what the cell is doing: a phase (select, sample, demonstrate, learn, evaluate) and a count within it.
using PhaseReport = std::function<void(const std::string& phase, long long count)>;

/// Files of docs/formats/README.md, status.json last. The same cell gives the same bytes, but for timing.json and the
/// hash of it in status.json.
/// @throws MethodError, PluginError where the plugin is at fault; EngineError, InputError where the host is. Then there
/// is no status.json.
void run_cell(const CellJob& job, const PhaseReport& report);

}  // namespace lgabench

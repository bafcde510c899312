// One cell from its configuration to its files: the paper's figure 1 as a function.
#pragma once
#include <functional>
#include <string>

#include <lgabench/abstraction/chat_model.hpp>
#include <lgabench/job/job.hpp>

namespace lgabench {

/// Says what the cell is doing: a phase (of cell_phases, or in_line_phase) and a count within it.
using PhaseReport = std::function<void(const std::string& phase, long long count)>;

/// Files of docs/formats/README.md, status.json last. The same cell gives the same bytes, but for timing.json and the
/// hash of it in status.json. `server`, borrowed, is asked where the cell asks a model.
/// @throws MethodError, PluginError where the plugin is at fault; EngineError, InputError where the host is. Then there
/// is no status.json.
void run_cell(const CellJob& job, ChatClient* server, const PhaseReport& report);

}  // namespace lgabench

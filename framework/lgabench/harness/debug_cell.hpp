// One cell in the foreground, for whoever looks into a method.
#pragma once
#include <string>

#include <lgabench/harness/run_suite.hpp>

namespace lgabench {

/// Plays the cell of the plan whose key begins so, with the method's process unconfined on our terminal: a plugin's
/// under gdb, a Python method's as it is, so that breakpoint() works. The run directory is not touched, and results are
/// dropped. Returns the worker's exit status.
/// @throws InputError for a key that names none or several, for a reference row, and where gdb is missing: with the
/// command line that it would run.
int debug_cell(RunPlan plan, const Catalogue& catalogue, const std::string& key);

}  // namespace lgabench

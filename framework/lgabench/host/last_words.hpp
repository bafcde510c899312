// How a plugin's process ended, where it can still say so.
#pragma once
#include <string>

namespace lgabench {

/// Descriptor on which a plugin's process talks with the worker.
constexpr int plugin_socket = 3;

/// Exit status of a plugin's process whose connection is gone: somebody closed its descriptor, or put another there.
constexpr int connection_lost = 97;

/// Called in a plugin's process, before the plugin is loaded. From then on a crash prints its backtrace on stderr.
/// Where the first thread's call of exit(), quick_exit() or std::terminate(), or a stack that overflowed, ends the
/// process, the worker is told why (the frame "ends").
void tell_how_it_ends();

/// Tells the worker why this process ends now.
void tell_end(const std::string& reason);

}  // namespace lgabench

// How the verbs end that fill a run's directory: what they print, and the commands that go on from there.
#pragma once
#include <string>
#include <vector>

#include <lgabench/core/files.hpp>

namespace lgabench::cli {

using Words = std::vector<std::string>;

/// The words of this program's command line, as typed.
Words command_line();

/// One line that a shell splits into these words again.
std::string joined(const Words& words);

/// Writes the run's report; prints its table, or summary.json, on stdout.
void print_report(const fs::path& run, bool json);

}  // namespace lgabench::cli

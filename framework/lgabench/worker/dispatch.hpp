// lgabench-worker's own verbs: what a cell, a check and a question need. Programs give the worker more of them.
#pragma once
#include <string_view>

namespace lgabench::worker {

/// A verb without options, which another program starts: it reads JSON from the standard input, and throws what goes
/// wrong.
struct Verb {
  const char *name, *summary;
  void (*run)();
};
/// nullptr where there is none of that name.
const Verb* find_verb(std::string_view name);

/// Runs the verb that the first argument names, or says which there are. @returns the process's exit status
int worker_program(int argc, char** argv);

}  // namespace lgabench::worker

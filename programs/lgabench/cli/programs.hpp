// The programs, without their main(): a new commit compiles no command again.
#pragma once

namespace lgabench::cli {

/// lgabench: everything that needs no engine. Verbs that do are handed to lgabench-worker, whole. `version` is what
/// --version prints. @returns the process's exit status
int lgabench_program(int argc, char** argv, const char* version);

/// lgabench-worker, the process that loads plugins and engines, with the verbs that people start beside its own.
/// `lgabench` starts it; a person rarely does. @returns the process's exit status
int worker_with_programs(int argc, char** argv);

}  // namespace lgabench::cli

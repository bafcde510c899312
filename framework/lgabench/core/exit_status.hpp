// What a program says, and returns, where something went wrong.
#pragma once
#include <string>
#include <string_view>

namespace lgabench {

/// What a process returns (docs/troubleshooting.md). not_identical: verify's, where only the record's own word says why
/// it has other bytes.
namespace exit_status {
enum Exit {
  ok = 0,
  regression = 1,
  usage = 2,
  cells_failed = 3,
  plugin_refused = 4,
  not_identical = 5,
  interrupted = 130
};
}

/// One line on stderr, behind the program's name.
void complain(const std::string& program, std::string_view what);
/// Complains of the exception that is being handled. @returns the exit status that means it
int report_error(const std::string& program);

}  // namespace lgabench

// A page over several runs.
#pragma once
#include <string>
#include <vector>

#include <lgabench/report/report.hpp>

namespace lgabench::report {
using namespace document;
using namespace statistics;

/// Which runs there are, with a link to each one's report.html from a page in `place`; and the mean success of all
/// their methods, best first, beside those that it can be compared with: of the same suite, layout, engine, arm,
/// scenarios and demonstrations, the most of each run.
Document index_document(const std::vector<Report>& reports, const fs::path& place);

/// Whether some process writes into the run's directory, as the lock on it says.
bool is_being_written(const fs::path& run);

/// How far a run is, told without reading its results.
struct Progressed {
  std::string name;  // relative to where it was looked for
  RunRecord record;
  std::size_t done = 0, failed = 0;  // of its cells
  bool computing = false;            // some process writes into it
  bool has_report = false;
  std::string problem{};  // why it cannot be read; "" where it can
};

/// A run that cannot be read has a `problem`; nothing is thrown.
Progressed progress_of(const fs::path& run, const std::string& name);

/// A page over runs, whether they are finished or not; a run that has a report leads to NAME/report.html.
Document progress_document(const std::vector<Progressed>& runs, const std::string& where);

}  // namespace lgabench::report

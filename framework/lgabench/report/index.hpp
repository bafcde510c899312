// A page over several runs.
#pragma once
#include <vector>

#include <lgabench/report/report.hpp>

namespace lgabench::report {

/// Which runs there are, with a link to each one's report.html from a page in `place`; and the mean success of all
/// their methods, best first, beside those that it can be compared with: of the same suite, layout, engine, arm,
/// scenarios and demonstrations, the most of each run.
Document index_document(const std::vector<Report>& reports, const fs::path& place);

}  // namespace lgabench::report

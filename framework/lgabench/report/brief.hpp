// What a run ends with in a terminal, beside its headline.
#pragma once
#include <string>
#include <vector>

#include <lgabench/report/report_document.hpp>

namespace lgabench::report {

struct Brief {
  /// Success on the mean over scenarios, in at most 12 lines of 80 columns: two references, and eight methods, the
  /// headline's among them; the numbers of demonstrations where there is one arm, else the arms, else the main one and
  /// the mean over all. Empty where nothing was played.
  Grid means;
  std::vector<std::string> notes;  // its marks, what it leaves out, what the run lacks, errors of methods
};

/// Of the run's first table.
Brief brief(const Material& material);

}  // namespace lgabench::report

// Medians of a run of benchmarks, set against what is promised.
#pragma once
#include <benchmark/benchmark.h>

#include <map>
#include <string>

namespace lgabench {

/// Prints what the console reporter prints, and keeps each benchmark's median.
class Medians : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override;
  std::map<std::string, double> seconds;  // by the benchmark's name
};

/// A row for each promise whose two sides were measured: Markdown, as in docs/performance.md.
std::string summary(const std::map<std::string, double>& seconds);
/// Every promise that was measured reached its floor.
bool floors_hold(const std::map<std::string, double>& seconds);

}  // namespace lgabench

#include <lgabench/report/report.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <lgabench/core/rounding.hpp>
#include <lgabench/document/writers.hpp>
#include <lgabench/statistics/names.hpp>

namespace lgabench::report {
namespace {

// The row's name, with the one it has in A where that is another.
std::string row_name(const ComparedRow& row) {
  return display_name(row.method) +
         (row.method == row.method_a ? "" : fmt::format(" (in A {})", display_name(row.method_a)));
}

std::string word_for(const ComparedRow& row) {
  return row.worse() ? "worse" : row.better() ? "better" : row.total.same_actions ? "same actions" : "";
}

std::string seconds_interval(const ComparedTime& time) {
  const std::string difference = signed_text(time.change.difference, 3);
  return time.cells < 2 ? difference
                        : fmt::format("{} [{}, {}]", difference, signed_text(time.change.interval.low, 3),
                                      signed_text(time.change.interval.high, 3));
}

}  // namespace

std::string comparison_text(const RunComparison& comparison, bool each_phase) {
  std::string text = verdict(comparison) + "\n\n";
  if (!comparison.rows.empty()) {
    Grid rows;
    rows.caption = fmt::format("{}: success, B - A [95 % interval], Holm's p over all rows", comparison.suite);
    rows.heads = {"method", "layout", "engine", "n", "arm", "A", "B", "B - A", "p", "cells worse/better", ""};
    for (const ComparedRow& r : comparison.rows)
      rows.rows.push_back({{},
                           {row_name(r), r.layout, r.engine, std::to_string(r.demonstrations), r.arm,
                            fixed(r.success_a), fixed(r.success_b), change_text(r.change), p_text(r.p_holm),
                            fmt::format("{}/{} of {}", r.cells_worse, r.cells_better, r.cells), word_for(r)}});
    Grid pairs;
    pairs.caption = "Both commands of a pair right, B - A [95 % interval], p of this row alone";
    pairs.heads = {"method", "layout", "engine", "n", "arm", "A", "B", "B - A", "p"};
    for (const ComparedRow& r : comparison.rows)
      if (const auto& paired = r.paired)
        pairs.rows.push_back(
            {{},
             {row_name(r), r.layout, r.engine, std::to_string(r.demonstrations), r.arm, fixed(paired->a),
              fixed(paired->b), change_text(paired->change), p_text(paired->change.p)}});
    Grid times;
    times.caption = "Seconds of a cell's phases, B - A [95 % interval of Student's t], Holm's p of Wilcoxon's test";
    times.heads = {"method", "layout", "engine", "phase", "A", "B", "B - A", "p", "cells"};
    for (const ComparedTime& t : comparison.times) {
      if (!each_phase && t.phase != "total_s") continue;
      times.rows.push_back(
          {{},
           {display_name(t.method), t.layout, t.engine, t.phase.substr(0, t.phase.size() - 2), fixed(t.mean_a, 3),
            fixed(t.mean_b, 3), seconds_interval(t), p_text(t.p_holm), std::to_string(t.cells)}});
    }
    text += terminal(rows) + '\n';
    if (!pairs.rows.empty()) text += terminal(pairs) + '\n';
    text += terminal(times) + '\n';
  }
  for (const OtherScenes& o : comparison.other_scenes)
    text += fmt::format("{}, layout {}, engine {}, arm {}: other scenes ({}), not compared: {}\n", o.scenario, o.layout,
                        o.engine, o.arm, o.why, fmt::join(o.cells, "; "));
  for (const auto& [n, what] : {std::pair(comparison.only_a, "in A alone: not compared"),
                                {comparison.only_b, "in B alone: not compared"},
                                {comparison.failed_a, "failed in A and finished in B"},
                                {comparison.failed_b, "finished in A and failed in B"}})
    if (n > 0) text += fmt::format("{} {} {}\n", n, n == 1 ? "cell" : "cells", what);
  return text;
}

}  // namespace lgabench::report

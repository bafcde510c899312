#include <fmt/format.h>

#include <lgabench/core/rounding.hpp>
#include <lgabench/report/compare.hpp>
#include <lgabench/report/names.hpp>
#include <lgabench/report/writers.hpp>

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

Json interval_json(const Interval& interval) { return {interval.low, interval.high}; }

std::string seconds_interval(const ComparedTime& time) {
  const std::string difference = signed_text(time.change.difference, 3);
  return time.cells < 2 ? difference
                        : fmt::format("{} [{}, {}]", difference, signed_text(time.change.interval.low, 3),
                                      signed_text(time.change.interval.high, 3));
}

}  // namespace

Json to_json(const RunComparison& comparison) {
  Json rows = Json::array(), times = Json::array();
  for (const ComparedRow& r : comparison.rows)
    rows.push_back({{"layout", r.layout},
                    {"engine", r.engine},
                    {"method", r.method},
                    {"method_a", r.method_a},
                    {"method_kind", r.kind},
                    {"arm", r.arm},
                    {"demonstrations", r.demonstrations},
                    {"success_a", r.success_a},
                    {"success_b", r.success_b},
                    {"difference", r.change.difference},
                    {"interval", interval_json(r.change.interval)},
                    {"p", r.change.p},
                    {"p_holm", r.p_holm},
                    {"scenarios", r.scenarios},
                    {"cells", r.cells},
                    {"cells_worse", r.cells_worse},
                    {"cells_better", r.cells_better},
                    {"episodes", r.total.episodes},
                    {"only_a", r.total.only_first},
                    {"only_b", r.total.only_second},
                    {"same_actions", r.total.same_actions},
                    {"worse", r.worse()},
                    {"better", r.better()}});
  for (const ComparedTime& t : comparison.times)
    times.push_back({{"layout", t.layout},
                     {"engine", t.engine},
                     {"method", t.method},
                     {"phase", t.phase},
                     {"cells", t.cells},
                     {"mean_a", t.mean_a},
                     {"mean_b", t.mean_b},
                     {"difference", t.change.difference},
                     {"interval", t.cells < 2 ? Json(nullptr) : interval_json(t.change.interval)},
                     {"p", t.change.p},
                     {"p_holm", t.p_holm}});
  Json others = Json::array();
  for (const OtherScenes& o : comparison.other_scenes)
    others.push_back({{"layout", o.layout},
                      {"engine", o.engine},
                      {"scenario", o.scenario},
                      {"arm", o.arm},
                      {"why", o.why},
                      {"cells", o.cells}});
  return {{"suite", comparison.suite},
          {"verdict", verdict(comparison)},
          {"rows", rows},
          {"other_scenes", others},
          {"times", times},
          {"regressed", comparison.regressed()},
          {"only_a", comparison.only_a},
          {"only_b", comparison.only_b},
          {"failed_a", comparison.failed_a},
          {"failed_b", comparison.failed_b}};
}

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
    text += terminal(rows) + '\n' + terminal(times) + '\n';
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

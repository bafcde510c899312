#include <lgabench/report/tables.hpp>

#include <fmt/format.h>

#include <map>

#include <lgabench/report/names.hpp>

namespace lgabench::report {

std::string success_text(const Row* row) {
  if (!row) return "";
  const std::string marks =
      fmt::format("{}{}", row->marked("baseline_not_learned") ? "†" : "", row->marked("incomplete") ? "‡" : "");
  if (!row->success) return "–" + marks;
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]{}", *row->success, row->interval.low, row->interval.high, marks);
}

std::vector<std::string> notes(const RunResults& run, const Summary& summary) {
  bool not_learned = false, incomplete = false;
  std::map<std::string, std::string> no_people;  // method -> provenance, where that has to be said
  for (const Table& table : summary.tables)
    for (const Row& row : table.rows) {
      not_learned = not_learned || row.marked("baseline_not_learned");
      incomplete = incomplete || row.marked("incomplete");
      const std::string provenance = row.phi.is_null() ? "" : row.phi.at("provenance").get<std::string>();
      if (provenance == "truth" || provenance == "simulated_edit") no_people[row.method] = provenance;
    }
  std::vector<std::string> lines;
  if (run.smoke) lines.emplace_back("Smoke or limited run: not for the leaderboard.");
  if (run.not_run > 0)
    lines.push_back(fmt::format("{} of {} cells have not run yet: the tables are partial.", run.not_run,
                                run.json.at("cells").size()));
  if (run.foreign > 0)
    lines.push_back(fmt::format("{} cell directories that run.json does not list were left out.", run.foreign));
  if (not_learned)
    lines.emplace_back("† baseline not learned: below the best constant action with as many demonstrations.");
  if (incomplete) lines.emplace_back("‡ incomplete: a cell failed, or the mean lacks a scenario.");
  for (const auto& [method, provenance] : no_people)
    lines.push_back(fmt::format("{}: {}.", display_name(method), provenance_words(provenance)));
  return lines;
}

}  // namespace lgabench::report

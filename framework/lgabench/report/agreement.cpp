#include <lgabench/record/layout.hpp>
#include <lgabench/report/agreement.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include <lgabench/report/pairs.hpp>
#include <lgabench/report/results.hpp>

namespace lgabench::report {
namespace {

// "episodes.jsonl line 3"; empty for equal files.
std::string first_difference(const fs::path& a, const fs::path& b) {
  const std::string x = read_file(a), y = read_file(b);
  if (x == y) return "";
  const auto at = std::mismatch(x.begin(), x.end(), y.begin(), y.end()).first;
  return fmt::format("{} line {}", a.filename().string(), 1 + std::count(x.begin(), at, '\n'));
}

// Episodes of which one side says nothing of causes, and all else is the same: a stranger's method is told no truth
// where cells are computed again.
bool same_but_for_causes(const fs::path& recorded, const fs::path& recomputed) {
  const std::string file = (recorded / cell_file::episodes).string();
  std::vector<Json> x = parse_json_lines(read_file(recorded / cell_file::episodes, Links::refused), file),
                    y = parse_json_lines(read_file(recomputed / cell_file::episodes, Links::refused), file);
  const auto without_causes = [](std::vector<Json>& episodes) {
    bool had_some = false;
    for (Json& episode : episodes)
      if (episode.is_object() && episode.contains("attribution"))
        had_some |= !std::exchange(episode["attribution"], Json()).is_null();
    return !had_some;
  };
  const bool none_there = without_causes(x), none_here = without_causes(y);
  return none_there != none_here && x == y;
}

bool same_endings(const CellResult& a, const CellResult& b, const std::string& arm) {
  const auto &x = a.episodes.at(arm), &y = b.episodes.at(arm);
  return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                    [](const Episode& e, const Episode& f) { return e.failure == f.failure; });
}

// Compares two cells whose bytes differ for a reason.
CellAgreement compare_outcomes(const CellResult& recorded, const CellResult& recomputed) {
  if (recorded.arms != recomputed.arms) return {Agreement::differs, "other arms", 0, 0};
  CellAgreement both{Agreement::same_outcomes, "", 0, 0};
  bool same = true;
  std::vector<double> p;
  std::string changed;
  for (const std::string& arm : recorded.arms) {
    PolicyPair pair;
    try {
      pair = pair_policies(recorded, recomputed, arm);
    } catch (const InputError& e) {  // other scenes or commands
      return {Agreement::differs, e.what(), 0, 0};
    }
    same = same && same_endings(recorded, recomputed, arm);
    both.only_recorded += pair.only_first;
    both.only_recomputed += pair.only_second;
    p.push_back(mcnemar(pair.only_first, pair.only_second));
    if (pair.only_first + pair.only_second > 0)
      changed += fmt::format("{}arm {}: {} of {} succeeded there, {} here (McNemar {})", changed.empty() ? "" : "; ",
                             arm, pair.won_first, pair.episodes, pair.won_second, p_text(p.back()));
  }
  if (same) return both;
  both.detail = changed.empty() ? "episodes failed otherwise" : changed;
  const std::vector<double> adjusted = holm(p);
  const bool chance = std::all_of(adjusted.begin(), adjusted.end(), [](double value) { return value > 0.05; });
  both.agreement = chance ? Agreement::within_interval : Agreement::differs;
  return both;
}

}  // namespace

std::string to_string(Agreement agreement) {
  constexpr const char* words[] = {"bit-identical", "same outcomes", "within interval", "differs"};
  return words[static_cast<int>(agreement)];
}

CellAgreement compare_cells(const fs::path& recorded, const fs::path& recomputed, bool excused) {
  std::vector<std::string> differences;
  for (const char* name : result_files)
    if (std::string where = first_difference(recorded / name, recomputed / name); !where.empty())
      if (std::string_view(name) != cell_file::episodes || !same_but_for_causes(recorded, recomputed))
        differences.push_back(std::move(where));
  if (differences.empty()) return {Agreement::identical, "", 0, 0};
  const std::string where = fmt::format("from {}", fmt::join(differences, ", "));
  if (!excused) return {Agreement::differs, where + ", though build, processor and data are those of the record", 0, 0};
  if (differences.front().rfind(cell_file::selections, 0) == 0) return {Agreement::differs, where, 0, 0};
  CellAgreement outcomes = compare_outcomes(read_cell(recorded), read_cell(recomputed));
  outcomes.detail = outcomes.detail.empty() ? where : fmt::format("{}; {}", outcomes.detail, where);
  return outcomes;
}

std::vector<PooledAgreement> pooled(const std::vector<std::pair<std::string, CellAgreement>>& cells) {
  std::map<std::string, PooledAgreement> rows;
  for (const auto& [row, cell] : cells) {
    if (cell.only_recorded + cell.only_recomputed == 0) continue;
    PooledAgreement& one = rows.emplace(row, PooledAgreement{row}).first->second;
    ++one.cells;
    one.only_recorded += cell.only_recorded;
    one.only_recomputed += cell.only_recomputed;
  }
  std::vector<PooledAgreement> all;
  PooledAgreement total;
  for (const auto& [row, one] : rows) {
    all.push_back(one);
    total.cells += one.cells;
    total.only_recorded += one.only_recorded;
    total.only_recomputed += one.only_recomputed;
  }
  if (all.size() > 1) all.push_back(total);
  std::vector<double> p;
  for (const PooledAgreement& one : all) p.push_back(mcnemar(one.only_recorded, one.only_recomputed));
  const std::vector<double> adjusted = holm(p);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].p_holm = adjusted[i];
  return all;
}

}  // namespace lgabench::report

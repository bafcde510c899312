#include <lgabench/record/layout.hpp>
#include <lgabench/statistics/agreement.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include <lgabench/statistics/pairs.hpp>
#include <lgabench/statistics/results.hpp>

namespace lgabench::statistics {
namespace {

// "episodes.jsonl line 3"; empty for equal files.
std::string first_difference(const fs::path& a, const fs::path& b) {
  const std::string x = read_file(a), y = read_file(b);
  if (x == y) return "";
  const auto at = std::mismatch(x.begin(), x.end(), y.begin(), y.end()).first;
  return fmt::format("{} line {}", a.filename().string(), 1 + std::count(x.begin(), at, '\n'));
}

CellAgreement differing(std::string why) {
  CellAgreement one;
  one.detail = std::move(why);
  return one;
}

int episodes_of(const fs::path& cell) {
  const std::string lines = read_file(cell / cell_file::episodes);
  return static_cast<int>(std::count(lines.begin(), lines.end(), '\n'));
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
  if (recorded.arms != recomputed.arms) return differing("other arms");
  CellAgreement both{Agreement::same_outcomes, "", 0, 0, 0};
  bool same = true;
  std::string changed;
  for (const std::string& arm : recorded.arms) {
    PolicyPair pair;
    try {
      pair = pair_policies(recorded, recomputed, arm);
    } catch (const InputError& e) {  // other scenes or commands
      return differing(e.what());
    }
    same = same && same_endings(recorded, recomputed, arm);
    both.only_recorded += pair.only_first;
    both.only_recomputed += pair.only_second;
    both.episodes += pair.episodes;
    if (pair.only_first + pair.only_second > 0)
      changed += fmt::format("{}arm {}: {} of {} succeeded in the record, {} recomputed, {} episodes ended differently",
                             changed.empty() ? "" : "; ", arm, pair.won_first, pair.episodes, pair.won_second,
                             pair.only_first + pair.only_second);
  }
  if (same) return both;
  both.detail = changed.empty() ? "episodes failed otherwise" : changed;
  both.agreement = Agreement::other_outcomes;
  return both;
}

}  // namespace

std::string to_string(Agreement agreement) {
  constexpr const char* words[] = {"bit-identical", "same outcomes", "other outcomes", "differs"};
  return words[static_cast<int>(agreement)];
}

std::string to_string(Reproduction verdict) {
  constexpr const char* words[] = {"identical", "agrees", "differs"};
  return words[static_cast<int>(verdict)];
}

CellAgreement compare_cells(const fs::path& recorded, const fs::path& recomputed, bool excused) {
  std::vector<std::string> differences;
  std::vector<const char*> names{result_files.begin(), result_files.end()};
  if (fs::exists(recomputed / cell_file::perturbed)) names.push_back(cell_file::perturbed);
  for (const char* name : names)
    if (std::string where = first_difference(recorded / name, recomputed / name); !where.empty())
      if (std::string_view(name) != cell_file::episodes || !same_but_for_causes(recorded, recomputed))
        differences.push_back(std::move(where));
  if (differences.empty()) return {Agreement::identical, "", 0, 0, episodes_of(recorded)};
  const std::string where = fmt::format("from {}", fmt::join(differences, ", "));
  if (!excused) return differing(where + ", though the same bytes are owed");
  if (differences.front().rfind(cell_file::selections, 0) == 0) return differing(where);
  CellAgreement outcomes = compare_outcomes(read_cell(recorded), read_cell(recomputed));
  outcomes.detail = outcomes.detail.empty() ? where : fmt::format("{}; {}", outcomes.detail, where);
  return outcomes;
}

void PooledAgreement::add(const CellAgreement& cell) {
  ++cells;
  only_recorded += cell.only_recorded;
  only_recomputed += cell.only_recomputed;
  worse += cell.only_recorded > cell.only_recomputed;
  better += cell.only_recomputed > cell.only_recorded;
}

double most_flips(int episodes) { return std::max(.01 * episodes, std::min(.04 * episodes, 10.)); }

std::vector<PooledAgreement> pooled(const std::vector<std::pair<std::string, CellAgreement>>& cells) {
  std::map<std::string, PooledAgreement> rows;
  PooledAgreement total;
  for (const auto& [row, cell] : cells) {
    if (cell.only_recorded + cell.only_recomputed == 0) continue;
    rows[row].row = row;
    for (PooledAgreement* one : {&rows[row], &total}) one->add(cell);
  }
  std::vector<PooledAgreement> all;
  for (const auto& item : rows) all.push_back(item.second);
  if (all.size() > 1) all.push_back(total);
  std::vector<double> p;
  for (const PooledAgreement& one : all) p.push_back(mcnemar(one.worse, one.better));
  const std::vector<double> adjusted = holm(p);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].p_holm = adjusted[i];
  return all;
}

Reproduction verdict_of(const std::vector<std::pair<std::string, CellAgreement>>& cells) {
  bool identical = true;
  int flips = 0, episodes = 0;
  for (const auto& [row, cell] : cells) {
    if (cell.agreement == Agreement::differs) return Reproduction::differs;
    identical = identical && cell.agreement == Agreement::identical;
    flips += cell.only_recorded + cell.only_recomputed;
    episodes += cell.episodes;
  }
  return identical ? Reproduction::identical : verdict_of(flips, episodes, pooled(cells));
}

Reproduction verdict_of(int flips, int episodes, const std::vector<PooledAgreement>& rows) {
  if (flips > most_flips(episodes)) return Reproduction::differs;
  const bool chance = std::none_of(rows.begin(), rows.end(), [](const PooledAgreement& row) { return row.differs(); });
  return chance ? Reproduction::agrees : Reproduction::differs;
}

}  // namespace lgabench::statistics

#include <lgabench/statistics/compare.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include <lgabench/core/rounding.hpp>
#include <lgabench/core/suggest.hpp>
#include <lgabench/statistics/names.hpp>
#include <lgabench/statistics/paired.hpp>

namespace lgabench::statistics {
namespace {

struct CellPair {
  const CellResult *a, *b;
  std::vector<std::string> arms{};  // in which both played the same scenes
};

Json interval_json(const Interval& interval) { return {interval.low, interval.high}; }

// Whose methods differ is measured alike where two `rows` are compared.
auto measures(const CellResult& c, bool rows) {
  return std::tuple(c.layout, c.engine, c.scenario, rows ? "" : c.id, rows ? "" : canonical(c.options),
                    rows ? "" : c.configuration.selection_errors.suffix() + c.configuration.reading.suffix(),
                    c.demonstrations, c.training_seed, c.participant);
}

// The run without its other rows. @throws InputError where there is no such row
RunResults only_row(RunResults run, const std::string& name) {
  std::set<std::string> rows;
  for (const CellResult& cell : run.cells) rows.insert(cell.method);
  if (rows.count(name) == 0)
    throw InputError(run.directory.string() + ": " + none_named("row", name, {rows.begin(), rows.end()}));
  run.cells.erase(
      std::remove_if(run.cells.begin(), run.cells.end(), [&](const CellResult& cell) { return cell.method != name; }),
      run.cells.end());
  return run;
}

// Cells that finished in both runs; the others are counted.
std::vector<CellPair> pair_cells(const RunResults& a, const RunResults& b, bool rows, RunComparison& comparison) {
  std::map<decltype(measures(a.cells.front(), rows)), const CellResult*> unpaired;
  for (const CellResult& cell : b.cells) unpaired[measures(cell, rows)] = &cell;
  std::vector<CellPair> pairs;
  for (const CellResult& cell : a.cells) {
    const auto other = unpaired.find(measures(cell, rows));
    if (other == unpaired.end()) {
      comparison.only_a += cell.failed ? 0 : 1;
      continue;
    }
    const CellResult& there = *other->second;
    unpaired.erase(other);
    comparison.failed_a += cell.failed && !there.failed ? 1 : 0;
    comparison.failed_b += there.failed && !cell.failed ? 1 : 0;
    if (!cell.failed && !there.failed) pairs.push_back({&cell, &there});
  }
  for (const auto& item : unpaired) comparison.only_b += item.second->failed ? 0 : 1;
  return pairs;
}

// Finds the arms in which each pair played the same scenes; keeps pairs that have one, and says which cells have
// others.
std::vector<CellPair> pair_arms(const std::vector<CellPair>& cells, RunComparison& comparison) {
  std::vector<CellPair> pairs;
  std::map<std::tuple<std::string, std::string, std::string, std::string>, OtherScenes> others;
  for (CellPair pair : cells) {
    const CellResult &a = *pair.a, &b = *pair.b;
    if (a.episodes_per_arm != b.episodes_per_arm)
      throw InputError(fmt::format("the runs cannot be compared: {}, layout {}: {} episodes an arm in A, {} in B",
                                   a.scenario, a.layout, a.episodes_per_arm, b.episodes_per_arm));
    const auto differ = [&](const std::string& arm, const std::string& why) {
      OtherScenes& other = others[{b.layout, b.engine, b.scenario, arm}];
      if (other.cells.empty()) other = {b.layout, b.engine, b.scenario, arm, why, {}};
      other.cells.push_back(fmt::format("{} n={} seed={}{}", b.method, b.demonstrations, b.training_seed,
                                        b.participant.empty() ? "" : " participant=" + b.participant));
    };
    for (const std::string& arm : a.arms_in_means())
      if (b.episodes.count(arm) == 0)
        differ(arm, "an arm of A alone");
      else if (const std::string why = why_unpaired(a, b, arm); !why.empty())
        differ(arm, why);
      else
        pair.arms.push_back(arm);
    for (const std::string& arm : b.arms)
      if (a.episodes.count(arm) == 0) differ(arm, "an arm of B alone");
    if (!pair.arms.empty()) pairs.push_back(std::move(pair));
  }
  for (auto& item : others) comparison.other_scenes.push_back(std::move(item.second));
  return pairs;
}

using RowPlace = std::tuple<std::string, std::string, std::size_t, std::string, int, std::string, int>;

std::vector<ComparedRow> compare_rows(const std::vector<CellPair>& pairs) {
  struct Draft {
    ComparedRow row;
    PairedRow policies;
    BothRows cells;
    std::vector<double> p;       // McNemar's, of each pair of cells
    std::vector<int> direction;  // only_second - only_first
  };
  std::map<RowPlace, Draft> drafts;
  for (const CellPair& pair : pairs) {
    const CellResult &a = *pair.a, &b = *pair.b;
    for (const std::string& arm : pair.arms) {
      const auto place = static_cast<std::size_t>(std::find(a.arms.begin(), a.arms.end(), arm) - a.arms.begin());
      Draft& draft = drafts[{a.layout, a.engine, place, a.kind, display_rank(b.method), b.method, a.demonstrations}];
      ComparedRow& row = draft.row;
      row.layout = a.layout;
      row.engine = a.engine;
      row.method = b.method;
      row.method_a = a.method;
      row.kind = a.kind;
      row.arm = arm;
      row.demonstrations = a.demonstrations;
      const PolicyPair policies = pair_policies(a, b, arm);
      draft.policies.add(a.scenario, policies, a.participant);
      auto& [cells_a, cells_b] = draft.cells[{a.training_seed, a.participant}];
      cells_a.push_back(&a);
      cells_b.push_back(&b);
      draft.p.push_back(mcnemar(policies.only_first, policies.only_second));
      draft.direction.push_back(policies.only_second - policies.only_first);
    }
  }
  std::vector<ComparedRow> rows;
  std::vector<double> p;
  for (auto& [place, draft] : drafts) {
    ComparedRow& row = draft.row;
    row.success_a = draft.policies.first_success();
    row.success_b = draft.policies.second_success();
    const std::string name =
        fmt::format("compare/{}/{}/{}/{}/{}", row.layout, row.engine, row.method, row.demonstrations, row.arm);
    row.change = draft.policies.change(name);
    if (const PairedRow both = both_on_pairs(draft.cells, row.arm); both.policies() > 0)
      row.paired = {both.first_success(), both.second_success(), both.change(name + "/paired")};
    row.scenarios = draft.policies.scenarios();
    row.total = draft.policies.total();
    row.cells = draft.policies.policies();
    const std::vector<double> adjusted = holm(draft.p);
    for (std::size_t i = 0; i < adjusted.size(); ++i)
      if (adjusted[i] <= alpha) ++(draft.direction[i] < 0 ? row.cells_worse : row.cells_better);
    p.push_back(row.change.p);
    rows.push_back(std::move(row));
  }
  const std::vector<double> adjusted = holm(p);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].p_holm = adjusted[i];
  return rows;
}

std::vector<ComparedTime> compare_times(const std::vector<CellPair>& pairs) {
  std::map<std::tuple<std::string, std::string, int, std::string>, std::vector<CellPair>> methods;
  for (const CellPair& pair : pairs)
    methods[{pair.b->layout, pair.b->engine, display_rank(pair.b->method), pair.b->method}].push_back(pair);
  std::vector<ComparedTime> times;
  std::vector<double> p;
  for (const auto& [place, cells] : methods)
    for (const std::string& phase : phases()) {
      ComparedTime time;
      std::tie(time.layout, time.engine, std::ignore, time.method) = place;
      time.phase = phase;
      time.cells = static_cast<int>(cells.size());
      std::vector<double> differences;
      for (const CellPair& pair : cells) {
        const double a = pair.a->timing.at(phase), b = pair.b->timing.at(phase);
        time.mean_a += a / time.cells;
        time.mean_b += b / time.cells;
        differences.push_back(b - a);
      }
      if (differences.size() > 1) {
        time.change = paired_t(differences);
        time.change.p = wilcoxon(differences);
      } else {
        time.change = {differences.front(), {}, 1};  // one pair says nothing about chance
      }
      p.push_back(time.change.p);
      times.push_back(std::move(time));
    }
  const std::vector<double> adjusted = holm(p);
  for (std::size_t i = 0; i < times.size(); ++i) times[i].p_holm = adjusted[i];
  return times;
}

}  // namespace

bool ComparedRow::worse() const { return p_holm <= alpha && change.interval.high < 0; }
bool ComparedRow::better() const { return p_holm <= alpha && change.interval.low > 0; }

std::string verdict(const RunComparison& comparison) {
  std::vector<std::string> worse, better;
  std::size_t same = 0;
  for (const ComparedRow& row : comparison.rows) {
    const std::string place = fmt::format("{}{} ({}, {} demonstrations, {})", display_name(row.method),
                                          row.method == row.method_a ? "" : " against " + display_name(row.method_a),
                                          row.layout, row.demonstrations, row.arm);
    if (row.worse()) worse.push_back(place + " " + signed_text(row.change.difference));
    if (row.better()) better.push_back(place + " " + signed_text(row.change.difference));
    same += row.total.same_actions && row.total.only_first + row.total.only_second == 0 ? 1 : 0;
  }
  const std::size_t rows = comparison.rows.size(), other = rows - worse.size() - better.size();
  std::string text;
  if (comparison.failed_b > 0)
    text += fmt::format("{} of A's cells {} in B. ", comparison.failed_b, comparison.failed_b == 1 ? "fails" : "fail");
  if (comparison.missing > 0)
    text +=
        fmt::format("{} of A's cells {} missing in B. ", comparison.missing, comparison.missing == 1 ? "is" : "are");
  if (rows > 0 && same == rows)
    return text + fmt::format("B acts as A does in every scene ({} row{}).", rows, rows == 1 ? "" : "s");
  if (!worse.empty()) text += fmt::format("B is worse: {}. ", fmt::join(worse, "; "));
  if (!better.empty()) text += fmt::format("B is better: {}. ", fmt::join(better, "; "));
  if (other > 0)
    text += fmt::format("{}{} of {} {} beyond chance.", worse.empty() && better.empty() ? "No difference: " : "", other,
                        rows, other == 1 ? "row does not differ" : "rows do not differ");
  if (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

Json to_json(const RunComparison& comparison) {
  Json rows = Json::array(), times = Json::array();
  for (const ComparedRow& r : comparison.rows) {
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
    if (const auto& paired = r.paired)
      rows.back()["paired"] = {{"success_a", paired->a},
                               {"success_b", paired->b},
                               {"difference", paired->change.difference},
                               {"interval", interval_json(paired->change.interval)},
                               {"p", paired->change.p}};
  }
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

bool RunComparison::regressed() const {
  return failed_b + missing > 0 ||
         std::any_of(rows.begin(), rows.end(), [](const ComparedRow& row) { return row.worse(); });
}

RunComparison compare_runs(const RunResults& all_a, const RunResults& all_b, const std::optional<RowPair>& rows) {
  const RunResults a = rows ? only_row(all_a, rows->a) : all_a, b = rows ? only_row(all_b, rows->b) : all_b;
  if (a.suite != b.suite)
    throw InputError(fmt::format("the runs cannot be compared: suite {} in A, {} in B", a.suite, b.suite));
  RunComparison comparison;
  comparison.suite = a.suite;
  const std::vector<CellPair> pairs = pair_arms(pair_cells(a, b, rows.has_value(), comparison), comparison);
  comparison.missing = rows ? 0 : comparison.only_a;
  if (pairs.empty() && !comparison.other_scenes.empty()) {
    const OtherScenes& first = comparison.other_scenes.front();
    throw InputError(
        fmt::format("the runs cannot be compared: no cell played the same scenes in both; {}, layout {}, "
                    "arm {}: {}",
                    first.scenario, first.layout, first.arm, first.why));
  }
  if (pairs.empty() && comparison.failed_b == 0)
    throw InputError(
        "the runs cannot be compared: no cell finished in both (scenario, layout, engine, method and its options, "
        "demonstrations, training seed)");
  comparison.rows = compare_rows(pairs);
  comparison.times = compare_times(pairs);
  return comparison;
}

}  // namespace lgabench::statistics

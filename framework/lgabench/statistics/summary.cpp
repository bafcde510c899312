#include <lgabench/statistics/summary.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/parallel.hpp>
#include <lgabench/record/reference_rows.hpp>
#include <lgabench/statistics/bootstrap.hpp>
#include <lgabench/statistics/names.hpp>
#include <lgabench/statistics/pairs.hpp>

namespace lgabench::statistics {
namespace {

// What one cell, a training seed (of one participant), adds to a row: its episodes on one arm.
struct SeedResult {
  std::string participant;
  std::vector<std::string> scenes;   // of each episode
  std::vector<double> won;           // 1 or 0
  std::optional<PolicyPair> paired;  // with the first arm's; none where the arms give commands of other meanings
  std::optional<double> selected_otherwise;  // as in Shift
};

using Episodes = std::vector<Episode>;

// A row in the making: what each scenario's seeds add to it.
struct Draft {
  Row row;
  Cells cells;
  std::vector<std::vector<SeedResult>> scenarios;
  std::set<std::string> participants;
};

// What a Selection keeps.
Json kept(Json selection) {
  for (const char* other : {"provenance", "source", "asked_as", "cost"}) selection.erase(other);
  return selection;
}

// See Shift. @pre the episodes are paired
std::optional<double> selected_otherwise(const CellResult& cell, const Episodes& first, const Episodes& second) {
  std::vector<double> others;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const CommandResult &one = cell.commands[first[i].command], &other = cell.commands[second[i].command];
    if (first[i].command != second[i].command && !one.quality.empty() && !other.quality.empty())
      others.push_back(kept(one.selection) == kept(other.selection) ? 0 : 1);
  }
  return others.empty() ? std::nullopt : std::optional(mean(others));
}

std::string stream_name(const char* what, const Row& row) {
  return fmt::format("{}/{}/{}/{}/{}/{}/{}", what, row.scenario, row.layout, row.engine, row.method, row.demonstrations,
                     row.arm);
}

// Where two commands share a scene, or episodes have several steps.
void estimate_pairs(Draft& draft) {
  Row& row = draft.row;
  row.paired = paired_success(draft.cells, row.arm, stream_name("report/paired", row));
  row.course = course_of(draft.cells, row.arm, stream_name("report/course", row));
}

// Success, its change against the first arm, and their intervals, from the seeds.
void estimate(Draft& draft, const std::string& first_arm) {
  Samples rates, differences;
  EpisodePairs pairs;
  bool all_paired = true, same_actions = true;
  for (const auto& seeds : draft.scenarios)
    for (const SeedResult& seed : seeds) {
      all_paired = all_paired && seed.paired;
      same_actions = same_actions && seed.paired && seed.paired->same_actions;
      if (seed.paired) pairs.add(*seed.paired);
    }
  Row& row = draft.row;
  const bool shifts = row.arm != first_arm && all_paired;
  for (const auto& seeds : draft.scenarios) {
    if (seeds.empty()) continue;
    Outcomes won, difference;
    for (const SeedResult& seed : seeds) {
      won.add(seed.participant, seed.scenes, seed.won);
      if (shifts) difference.add(seed.participant, seed.scenes, seed.paired->differences());
    }
    rates.push_back(won.sample());
    if (shifts) differences.push_back(difference.sample());
  }
  if (rates.empty()) return;
  row.scenes = distinct_scenes(rates);
  row.success = mean_outcome(rates);
  row.interval = success_interval(rates, stream_name("report", row));
  if (!shifts) return;
  // Of a perturbed arm p counts as well, corrected for as many tests as there are levels.
  const int resamples = row.is_mean() && row.perturbation ? 10000 : 2000;
  const Change change = paired_change(differences, stream_name("report/shift", row), resamples);
  std::vector<std::optional<double>> otherwise;
  for (const auto& seeds : draft.scenarios) {
    std::vector<std::optional<double>> of_seeds;
    for (const SeedResult& seed : seeds) of_seeds.push_back(seed.selected_otherwise);
    otherwise.push_back(mean_of(of_seeds));
  }
  row.shift = Shift{first_arm, change.difference, change.interval,   same_actions,
                    change.p,  pairs.only_first,  pairs.only_second, mean_of(otherwise)};
}

// The row of `cells`: all seeds and participants of one (scenario, method, demonstrations).
Draft scenario_draft(const Cells& cells, const std::string& arm, const std::string& first_arm) {
  const CellResult& first = *cells.front();
  Draft draft;
  draft.cells = cells;
  Row& row = draft.row;
  row.scenario = first.scenario;
  row.layout = first.layout;
  row.engine = first.engine;
  row.arm = arm;
  if (const auto of = first.perturbations.find(arm); of != first.perturbations.end()) row.perturbation = of->second;
  row.method = first.method;
  row.errors = first.configuration.selection_errors;
  row.kind = first.kind;
  row.demonstrations = first.demonstrations;
  row.phi = phi_of(cells, arm);
  auto& results = draft.scenarios.emplace_back();
  std::set<long long> seeds;
  for (const CellResult* cell : cells) {
    if (cell->failed) {
      if (cell->fault == "host") row.n_error += cell->episodes_per_arm;
      continue;
    }
    const Episodes& episodes = cell->episodes.at(arm);
    SeedResult result{cell->participant, {}, {}, {}, {}};
    if (!cell->participant.empty()) draft.participants.insert(cell->participant);
    seeds.insert(cell->training_seed);
    if (const auto control = cell->episodes.find(first_arm); control != cell->episodes.end()) {
      result.paired = pair_episodes(control->second, episodes, cell->commands);
      if (result.paired) result.selected_otherwise = selected_otherwise(*cell, control->second, episodes);
    }
    for (const Episode& e : episodes) {
      result.scenes.push_back(e.scene);
      result.won.push_back(e.success() ? 1 : 0);
      row.successes += e.success() ? 1 : 0;
      if (!e.success()) ++row.failures[e.failure];
      if (!e.attribution.empty()) ++row.attribution[e.attribution];
      row.inputs_told += e.input_seen ? 1 : 0;
      row.inputs_seen += e.input_seen.value_or(false) ? 1 : 0;
    }
    row.episodes += static_cast<int>(episodes.size());
    results.push_back(std::move(result));
  }
  row.seeds = static_cast<int>(seeds.size());
  row.participants = static_cast<int>(draft.participants.size());
  if (results.size() < cells.size()) row.marks.emplace_back("incomplete");
  if (first.asks == "network") row.marks.emplace_back("network");
  if (first.ambiguous.count(arm) != 0) row.marks.emplace_back("ambiguous");
  estimate(draft, first_arm);
  estimate_pairs(draft);
  return draft;
}

// The row over the scenarios that have the arm, so many, from their rows of the same method and number of
// demonstrations.
Row mean_row(const std::vector<const Draft*>& drafts, std::size_t scenarios, const std::string& first_arm) {
  Draft mean;
  Row& row = mean.row = drafts.front()->row;
  row.scenario = mean_scenario;
  row.phi.clear();
  row.seeds = row.scenes = row.episodes = row.successes = row.inputs_told = row.inputs_seen = row.n_error = 0;
  row.failures.clear();
  row.attribution = Row().attribution;
  row.marks.clear();
  row.success.reset();
  row.interval = {};
  row.shift.reset();
  bool complete = drafts.size() == scenarios;
  for (const Draft* draft : drafts) {
    row.seeds = std::max(row.seeds, draft->row.seeds);
    row.episodes += draft->row.episodes;
    row.successes += draft->row.successes;
    row.inputs_told += draft->row.inputs_told;
    row.inputs_seen += draft->row.inputs_seen;
    row.n_error += draft->row.n_error;
    for (const auto& [failure, n] : draft->row.failures) row.failures[failure] += n;
    for (const auto& [to, n] : draft->row.attribution) row.attribution[to] += n;
    complete = complete && !draft->row.marked("incomplete");
    mean.scenarios.push_back(draft->scenarios.front());
    mean.cells.insert(mean.cells.end(), draft->cells.begin(), draft->cells.end());
    mean.participants.insert(draft->participants.begin(), draft->participants.end());
  }
  row.participants = static_cast<int>(mean.participants.size());
  if (!complete) row.marks.emplace_back("incomplete");
  if (drafts.front()->row.marked("network")) row.marks.emplace_back("network");
  estimate(mean, first_arm);
  estimate_pairs(mean);
  return row;
}

Json shift_json(const std::optional<Shift>& shift) {
  if (!shift) return nullptr;
  Json json{{"against", shift->against},
            {"difference", shift->difference},
            {"low", shift->interval.low},
            {"high", shift->interval.high},
            {"same_actions", shift->same_actions}};
  if (shift->selected_otherwise) json["selected_otherwise"] = *shift->selected_otherwise;
  return json;
}

// The row as summary.json has it.
Json row_json(const Row& row) {
  Json json{{"scenario", row.scenario},
            {"layout", row.layout},
            {"engine", row.engine},
            {"method", row.method},
            {"method_kind", row.kind},
            {"demonstrations", row.demonstrations},
            {"arm", row.arm},
            {"seeds", row.seeds},
            {"participants", row.participants},
            {"scenes", row.scenes},
            {"episodes", row.episodes},
            {"successes", row.successes},
            {"success", row.success ? Json(*row.success) : Json()},
            {"low", row.success ? Json(row.interval.low) : Json()},
            {"high", row.success ? Json(row.interval.high) : Json()},
            {"shift", shift_json(row.shift)},
            {"failures", row.failures},
            {"attribution", row.attribution},
            {"inputs_seen", row.seen_share() ? Json(*row.seen_share()) : Json()},
            {"n_error", row.n_error},
            {"marks", row.marks},
            {"phi", to_json(row.phi)}};
  if (row.paired) json["paired"] = to_json(*row.paired);
  if (row.course) json["course"] = to_json(*row.course);
  return json;
}

// What is below a reference row: a method that learned less than what always does the same thing has learned nothing,
// and one that grips any object it sees needs no demonstration.
void mark_low_rows(Table& table) {
  for (Row& row : table.rows) {
    if (row.is_reference() || !row.success) continue;
    std::vector<std::string> marks;
    for (const ReferenceRow& reference : reference_rows()) {
      const Row* low =
          reference.below_it ? table.find(row.arm, row.scenario, reference.id, row.demonstrations) : nullptr;
      if (low && low->success && *row.success < *low->success) marks.emplace_back(reference.below_it->word);
    }
    row.marks.insert(row.marks.begin(), marks.begin(), marks.end());
  }
}

// What counts as a failure of the policy was one of its code.
void mark_errors(Table& table) {
  for (Row& row : table.rows)
    if (!row.is_reference() && row.failures.count("method_error") != 0) row.marks.emplace_back("method_error");
}

std::optional<Nearness> nearness(const Table& table, const PaperValues& paper) {
  constexpr double error_bars = 1.5;
  Nearness near;
  near.methods = paper.near;
  for (const std::string& method : paper.near)
    for (const int n : table.demonstrations()) {
      const std::string name = display_name(method);
      const auto rate = paper.find(mean_scenario, name, n), error = paper.error(mean_scenario, name, n);
      if (!rate || !error) continue;
      const Row* row = table.find(table.arms.front(), mean_scenario, method, n);
      if (!row || !row->success) return std::nullopt;
      const double distance = std::abs(*row->success - *rate);
      ++near.points;
      near.near += distance <= error_bars * *error ? 1 : 0;
      near.mean_distance += distance;
    }
  if (near.points == 0) return std::nullopt;
  near.mean_distance /= near.points;
  return near;
}

Table make_table(const Cells& cells) {
  Table table;
  table.layout = cells.front()->layout;
  table.engine = cells.front()->engine;
  std::vector<std::string> scenarios;                            // as the cells are ordered
  using Place = std::tuple<std::string, int, std::string, int>;  // kind, rank, method, demonstrations
  std::map<std::string, std::map<Place, Cells>> grouped;
  table.demonstrated_commands = cells.front()->demonstrated_commands;
  for (const CellResult* cell : cells) {
    if (cell->demonstrated_commands != table.demonstrated_commands) table.demonstrated_commands = 0;
    append_unique(scenarios, cell->scenario);
    for (const std::string& arm : cell->arms) append_unique(table.arms, arm);
    grouped[cell->scenario][{cell->kind, display_rank(cell->method), cell->method, cell->demonstrations}].push_back(
        cell);
  }
  for (const std::string& arm : table.arms) {
    std::vector<std::pair<const Place*, const Cells*>> groups;
    for (const std::string& scenario : scenarios)
      for (const auto& [place, seeds] : grouped[scenario]) {
        const std::vector<std::string>& played = seeds.front()->arms;
        if (contains(played, arm)) groups.emplace_back(&place, &seeds);
      }
    std::vector<Draft> drafts(groups.size());
    in_parallel(groups.size(),
                [&](std::size_t i) { drafts[i] = scenario_draft(*groups[i].second, arm, table.arms.front()); });

    std::map<Place, std::vector<const Draft*>> by_place;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      if (!drafts[i].row.marked("ambiguous")) by_place[*groups[i].first].push_back(&drafts[i]);
      table.rows.push_back(drafts[i].row);
    }
    std::vector<std::vector<const Draft*>> over_scenarios;
    for (auto& item : by_place) over_scenarios.push_back(std::move(item.second));
    const std::size_t scenarios_with_arm = table.scenarios_with(arm).size(), first_mean = table.rows.size();
    table.rows.resize(first_mean + over_scenarios.size());
    in_parallel(over_scenarios.size(), [&](std::size_t i) {
      table.rows[first_mean + i] = mean_row(over_scenarios[i], scenarios_with_arm, table.arms.front());
    });
  }
  mark_low_rows(table);
  mark_errors(table);
  return table;
}

}  // namespace

Summary summarize(const RunResults& run) {
  Summary summary;
  summary.suite = run.suite;
  std::map<std::pair<std::string, std::string>, Cells> tables;
  for (const CellResult& cell : run.cells) {
    tables[{cell.layout, cell.engine}].push_back(&cell);
    if (cell.failed) summary.failed.push_back(cell);
  }
  const PaperValues paper = paper_values(run.suite);
  for (const auto& item : tables) {
    summary.tables.push_back(make_table(item.second));
    summary.tables.back().nearness = nearness(summary.tables.back(), paper);
  }
  const AboutSuite about = about_suite(run.suite, run.record.about);
  std::size_t index = 0;
  for (Table& table : summary.tables) {
    for (const std::string& arm : table.arms) table.arm_titles[arm] = about.arm_title(arm);
    for (Row& row : table.rows) {
      row.index = index++;
      if (row.shift) row.shift->against_title = table.arm_title(row.shift->against);
    }
  }
  summary.error_curves = error_curves(run, summary.tables);
  summary.perturbations = perturbation_curves(run, summary.tables);
  summary.steps = all_steps(run, summary.tables, about);
  summary.regrets = regrets(run);
  return summary;
}

Json to_json(const Summary& summary) {
  Json rows = Json::array(), failed = Json::array();
  for (const Table& table : summary.tables)
    for (const Row& row : table.rows) rows.push_back(row_json(row));
  for (const CellResult& cell : summary.failed)
    failed.push_back({{"cell", cell.key}, {"fault", cell.fault}, {"reason", cell.reason}});
  Json nearness = Json::array();
  for (const Table& table : summary.tables)
    if (const auto& near = table.nearness)
      nearness.push_back({{"layout", table.layout},
                          {"engine", table.engine},
                          {"points", near->points},
                          {"near", near->near},
                          {"mean_distance", near->mean_distance}});
  Json json{{"suite", summary.suite}, {"rows", rows}, {"failed_cells", failed}, {"near_paper", nearness}};
  for (const ErrorCurve& curve : summary.error_curves) json["error_curves"].push_back(to_json(curve));
  for (const PerturbationCurve& curve : summary.perturbations) json["perturbations"].push_back(to_json(curve));
  for (const Steps& steps : summary.steps) json["steps"].push_back(to_json(steps));
  for (const Regret& regret : summary.regrets) json["regret"].push_back(to_json(regret));
  return json;
}

}  // namespace lgabench::statistics

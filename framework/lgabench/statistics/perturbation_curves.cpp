#include <lgabench/statistics/curves.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <tuple>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/parallel.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/record/reference_rows.hpp>
#include <lgabench/statistics/bootstrap.hpp>
#include <lgabench/statistics/names.hpp>
#include <lgabench/statistics/pairs.hpp>
#include <lgabench/statistics/summary.hpp>

namespace lgabench::statistics {
namespace {

// None for `all`, and where it is neither installed nor a plugin's, which the cells' scenarios declare.
std::optional<PerturbationAxis> axis_of(const RunResults& run, const std::string& id) try {
  for (const PerturbationAxis& axis : perturbation_axes())
    if (axis.id == id) return axis;
  for (const CellResult& cell : run.cells)
    if (const JsonReader scenario(*cell.configuration.scenario, cell.key);
        scenario.has("axes") && scenario.at("axes").has(id))
      return read_axis(id, scenario.at("axes").at(id));
  return std::nullopt;
} catch (const InputError&) {
  return std::nullopt;
}

bool has_curve(const Row& row) {
  if (!row.is_mean() || !row.perturbation || !row.success || !row.shift) return false;
  const ReferenceRow* reference = row.is_reference() ? find_reference_row(row.method) : nullptr;
  return !row.is_reference() || (reference && reference->is_bound);
}

bool is_cell_of(const CellResult& cell, const PerturbationCurve& curve) {
  return !cell.failed && cell.layout == curve.layout && cell.engine == curve.engine && cell.method == curve.method &&
         cell.demonstrations == curve.demonstrations;
}

std::string arm_of(const CellResult& cell, const std::string& axis, int level) {
  for (const auto& [arm, perturbation] : cell.perturbations)
    if (perturbation.axis == axis && perturbation.level == level && cell.ambiguous.count(arm) == 0) return arm;
  return "";
}

void count(const std::vector<Episode>& episodes, std::map<std::string, int>& took) {
  for (const Episode& e : episodes)
    if (!e.took.empty()) ++took[e.took];
}

// Counts what was taken, and compares scene by scene how often it was what the other command means.
Change use_of_language(const RunResults& run, const PerturbationCurve& curve, PerturbationCurve::Level& level,
                       std::map<std::string, int>& in_control) {
  std::map<std::string, Outcomes> differences;  // by scenario
  for (const CellResult& cell : run.cells) {
    const auto there = cell.episodes.find(arm_of(cell, curve.axis, level.level));
    if (!is_cell_of(cell, curve) || there == cell.episodes.end()) continue;
    const std::vector<Episode>&control = cell.episodes.at(cell.arms.front()), &all = there->second;
    count(control, in_control);
    count(all, level.took);
    std::vector<std::string> scenes;
    std::vector<double> values;
    for (std::size_t i = 0; i < std::min(all.size(), control.size()); ++i) {
      scenes.push_back(control[i].scene);
      values.push_back((all[i].took == "other") - (control[i].took == "other"));
    }
    differences[cell.scenario].add(cell.participant, std::move(scenes), std::move(values));
  }
  Samples samples;
  for (const auto& [scenario, outcomes] : differences) samples.push_back(outcomes.sample());
  return samples.empty()
             ? Change()
             : paired_change(samples, fmt::format("report/use_of_language/{}/{}/{}/{}/{}", curve.layout, curve.engine,
                                                  curve.method, curve.demonstrations, level.level));
}

PerturbationCurve::Level level_of(const RunResults& run, PerturbationCurve& curve, const Row& row) {
  PerturbationCurve::Level level;
  level.level = row.perturbation->level;
  if (const auto axis = axis_of(run, curve.axis); axis && level.level <= axis->most()) {
    level.name = one_line(axis->levels[static_cast<std::size_t>(level.level) - 1]);
    if (axis->other) {
      std::map<std::string, int> in_control;
      const Change use = use_of_language(run, curve, level, in_control);
      if (axis->words(level.level).empty()) level.use_of_language = use;
      curve.took = in_control;
    }
  }
  level.success = *row.success;
  level.interval = row.interval;
  level.change = {row.shift->difference, row.shift->interval, row.shift->p};
  level.lost = row.shift->lost;
  level.gained = row.shift->gained;
  level.p_mcnemar = mcnemar(level.lost, level.gained);
  level.row = row.index;
  for (const CellResult& cell : run.cells) {
    if (!is_cell_of(cell, curve)) continue;
    const auto inputs = cell.inputs.find(arm_of(cell, curve.axis, level.level));
    if (inputs == cell.inputs.end()) continue;
    level.inputs.unchanged += inputs->second.unchanged;
    level.inputs.of += inputs->second.of;
  }
  return level;
}

// Adds the cell's control and area, scene by scene; false where a level is not paired with the control.
bool add_area(const CellResult& cell, const PerturbationCurve& curve, Outcomes& control, Outcomes& area) {
  const std::vector<Episode>& first = cell.episodes.at(cell.arms.front());
  std::vector<int> levels;
  for (const PerturbationCurve::Level& level : curve.levels) levels.push_back(level.level);
  const std::vector<double> counts = trapezoids(levels);
  std::vector<std::string> scenes;
  std::vector<double> won, areas;
  for (const Episode& episode : first) {
    scenes.push_back(episode.scene);
    won.push_back(episode.success() ? 1 : 0);
    areas.push_back(counts.front() * won.back());
  }
  for (std::size_t i = 0; i < curve.levels.size(); ++i) {
    const auto second = cell.episodes.find(arm_of(cell, curve.axis, curve.levels[i].level));
    const auto pair =
        second == cell.episodes.end() ? std::nullopt : pair_episodes(first, second->second, cell.commands);
    if (!pair) return false;
    for (std::size_t k = 0; k < areas.size(); ++k) areas[k] += counts[i + 1] * pair->second[k];
  }
  control.add(cell.participant, scenes, std::move(won));
  area.add(cell.participant, std::move(scenes), std::move(areas));
  return true;
}

std::optional<PerturbationCurve::Area> area_of(const RunResults& run, const PerturbationCurve& curve) {
  std::map<std::string, std::pair<Outcomes, Outcomes>> scenarios;
  for (const CellResult& cell : run.cells) {
    const bool has_axis = std::any_of(cell.perturbations.begin(), cell.perturbations.end(),
                                      [&](const auto& arm) { return arm.second.axis == curve.axis; });
    if (!has_axis || !is_cell_of(cell, curve)) continue;
    auto& [control, area] = scenarios[cell.scenario];
    if (!add_area(cell, curve, control, area)) return std::nullopt;
  }
  Samples controls, areas;
  std::vector<std::vector<std::vector<std::vector<double>>>> rows(2);
  bool shared = true;
  for (const auto& [scenario, outcomes] : scenarios) {
    controls.push_back(outcomes.first.sample());
    areas.push_back(outcomes.second.sample());
    rows[0].push_back(controls.back().units);
    rows[1].push_back(areas.back().units);
    shared = shared && controls.back().shared;
  }
  const double control = controls.empty() ? 0 : mean_outcome(controls);
  if (control == 0) return std::nullopt;
  const auto interval = SharedResamples(rows, shared,
                                        fmt::format("report/area/{}/{}/{}/{}/{}", curve.layout, curve.engine,
                                                    curve.method, curve.demonstrations, curve.axis))
                            .ratio(1, 0);
  if (!interval) return std::nullopt;
  return PerturbationCurve::Area{mean_outcome(areas) / control, *interval};
}

// Holm's correction over all levels of all axes of each row.
void correct(std::vector<PerturbationCurve>& curves) {
  const auto row_of = [](const PerturbationCurve& c) {
    return std::tie(c.layout, c.engine, c.method, c.demonstrations);
  };
  for (std::size_t begin = 0, end = 0; begin < curves.size(); begin = end) {
    std::vector<double> p;
    for (; end < curves.size() && row_of(curves[end]) == row_of(curves[begin]); ++end)
      for (const PerturbationCurve::Level& level : curves[end].levels) p.push_back(level.change.p);
    if (curves[begin].kind == "reference") continue;
    const std::vector<double> adjusted = holm(p);
    std::size_t test = 0;
    for (std::size_t i = begin; i < end; ++i) {
      curves[i].tests = static_cast<int>(p.size());
      for (PerturbationCurve::Level& level : curves[i].levels) level.p_holm = adjusted[test++];
    }
  }
}

Json change_json(const Change& change) {
  return {
      {"difference", change.difference}, {"low", change.interval.low}, {"high", change.interval.high}, {"p", change.p}};
}

// Those of one table: the rows come arm by arm.
std::vector<PerturbationCurve> curves_of(const RunResults& run, const Table& table) {
  std::vector<PerturbationCurve> curves;
  for (const Row& row : table.rows) {
    if (!has_curve(row)) continue;
    const auto same = [&row](const PerturbationCurve& c) {
      return std::tie(c.method, c.demonstrations, c.axis) ==
             std::tie(row.method, row.demonstrations, row.perturbation->axis);
    };
    auto curve = std::find_if(curves.begin(), curves.end(), same);
    if (curve == curves.end()) {
      PerturbationCurve one;
      one.layout = row.layout;
      one.engine = row.engine;
      one.method = row.method;
      one.kind = row.kind;
      one.axis = row.perturbation->axis;
      one.demonstrations = row.demonstrations;
      const auto axis = axis_of(run, one.axis);
      one.named = axis && axis->named;
      one.control = *row.success - row.shift->difference;
      if (table.scenarios_with(row.arm) == table.scenarios_with(row.shift->against))
        if (const Row* control = table.find(row.shift->against, mean_scenario, row.method, row.demonstrations))
          one.control_row = control->index;
      curve = curves.insert(curves.end(), std::move(one));
    }
    curve->levels.push_back(level_of(run, *curve, row));
  }
  for (PerturbationCurve& curve : curves)
    std::sort(curve.levels.begin(), curve.levels.end(), [](const auto& a, const auto& b) { return a.level < b.level; });
  std::stable_sort(curves.begin(), curves.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.kind, display_rank(a.method), a.method, a.demonstrations) <
           std::tuple(b.kind, display_rank(b.method), b.method, b.demonstrations);
  });
  correct(curves);
  in_parallel(curves.size(), [&](std::size_t i) {
    if (!curves[i].named && curves[i].kind != "reference") curves[i].area = area_of(run, curves[i]);
  });
  return curves;
}

}  // namespace

const PerturbationCurve::Level* PerturbationCurve::first_loss() const {
  const auto found = std::find_if(levels.begin(), levels.end(), [](const Level& level) { return level.is_loss(); });
  return found == levels.end() ? nullptr : &*found;
}

const PerturbationCurve::Level* PerturbationCurve::find(int level) const {
  const auto found = std::find_if(levels.begin(), levels.end(), [=](const Level& l) { return l.level == level; });
  return found == levels.end() ? nullptr : &*found;
}

std::vector<double> trapezoids(const std::vector<int>& levels) {
  std::vector<int> at{0};
  at.insert(at.end(), levels.begin(), levels.end());
  std::vector<double> all;
  for (std::size_t i = 0; i < at.size(); ++i)
    all.push_back((at[std::min(i + 1, at.size() - 1)] - at[i == 0 ? 0 : i - 1]) / (2. * at.back()));
  return all;
}

std::vector<PerturbationCurve> perturbation_curves(const RunResults& run, const std::vector<Table>& tables) {
  std::vector<PerturbationCurve> all;
  for (const Table& table : tables)
    for (PerturbationCurve& curve : curves_of(run, table)) all.push_back(std::move(curve));
  return all;
}

Json to_json(const PerturbationCurve& curve) {
  Json levels = Json::array();
  for (const PerturbationCurve::Level& level : curve.levels) {
    levels.push_back({{"level", level.level},
                      {"name", level.name},
                      {"success", level.success},
                      {"change", change_json(level.change)},
                      {"p_holm", level.p_holm ? Json(*level.p_holm) : Json()},
                      {"lost", level.lost},
                      {"gained", level.gained},
                      {"p_mcnemar", level.p_mcnemar},
                      {"unchanged_inputs", level.inputs.unchanged},
                      {"inputs", level.inputs.of},
                      {"row", level.row}});
    if (!level.took.empty()) levels.back()["took"] = level.took;
    if (level.use_of_language) levels.back()["use_of_language"] = change_json(*level.use_of_language);
  }
  Json control{{"success", curve.control}, {"row", curve.control_row ? Json(*curve.control_row) : Json()}};
  if (!curve.took.empty()) control["took"] = curve.took;
  Json area;
  if (curve.area)
    area = {{"relative", curve.area->relative}, {"low", curve.area->interval.low}, {"high", curve.area->interval.high}};
  const PerturbationCurve::Level* first = curve.named ? nullptr : curve.first_loss();
  return {{"layout", curve.layout},
          {"engine", curve.engine},
          {"method", curve.method},
          {"method_kind", curve.kind},
          {"demonstrations", curve.demonstrations},
          {"axis", curve.axis},
          {"named", curve.named},
          {"control", control},
          {"levels", levels},
          {"tests", curve.tests},
          {"area", area},
          {"first_loss", first ? Json(first->level) : Json()}};
}

}  // namespace lgabench::statistics

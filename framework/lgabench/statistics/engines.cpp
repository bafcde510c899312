#include <lgabench/statistics/engines.hpp>

#include <fmt/format.h>

#include <map>
#include <set>
#include <tuple>

#include <lgabench/core/contains.hpp>
#include <lgabench/statistics/names.hpp>

namespace lgabench::statistics {
namespace {

auto place(const CellResult& c) {
  return std::tuple(c.scenario, c.kind, c.method, c.participant, c.demonstrations, c.training_seed);
}

bool has_several_steps(const CellResult& cell) {
  for (const auto& [arm, episodes] : cell.episodes)
    for (const Episode& one : episodes)
      if (!one.then.empty() || one.done) return true;
  return false;
}

// Scenes that both played.
int same_scenes(const CellResult& a, const CellResult& b) {
  int count = 0;
  for (const auto& [arm, first] : a.episodes) {
    const auto found = b.episodes.find(arm);
    if (found == b.episodes.end()) continue;
    for (std::size_t i = 0; i < std::min(first.size(), found->second.size()); ++i)
      count += first[i].scene == found->second[i].scene;
  }
  return count;
}

// Scenes and actions that were counted already: methods that select alike act alike.
using Seen = std::set<std::pair<std::string, std::vector<double>>>;

void pair_cells(const CellResult& a, const CellResult& b, EngineAgreement& out, AgreementRow& row, AgreementRow& all,
                Seen& seen) {
  for (const std::string& arm : a.arms) {
    const auto found = b.episodes.find(arm);
    if (found == b.episodes.end()) continue;
    const std::vector<Episode>&first = a.episodes.at(arm), &second = found->second;
    for (std::size_t i = 0; i < std::min(first.size(), second.size()); ++i) {
      if (first[i].scene != second[i].scene || (first[i].action.empty() && second[i].action.empty())) continue;
      if (!same_action(first[i], second[i])) {
        ++row.other_actions;
        continue;
      }
      row.same.add(first[i], second[i]);
      if (!seen.emplace(first[i].scene, first[i].action).second) continue;
      all.same.add(first[i], second[i]);
      if (first[i].success() != second[i].success()) out.disagreements.push_back({&a, arm, i, second[i].failure});
    }
  }
}

EngineAgreement compare(const RunResults& run, const std::string& layout, const std::string& first,
                        const std::string& second) {
  EngineAgreement out{layout, first, second, {}, {}, 0};
  std::map<decltype(place(run.cells.front())), const CellResult*> others;
  for (const CellResult& cell : run.cells)
    if (!cell.failed && cell.layout == layout && cell.engine == second) others[place(cell)] = &cell;

  std::map<std::tuple<bool, int, std::string>, AgreementRow> rows;  // methods, then reference rows
  AgreementRow all;
  Seen seen;
  for (const CellResult& cell : run.cells) {
    if (cell.failed || cell.layout != layout || cell.engine != first) continue;
    const auto other = others.find(place(cell));
    if (other == others.end()) continue;
    if (has_several_steps(cell) || has_several_steps(*other->second)) {
      out.several_steps += same_scenes(cell, *other->second);
      continue;
    }
    AgreementRow& row = rows[{cell.is_reference(), display_rank(cell.method), cell.method}];
    row.method = cell.method;
    pair_cells(cell, *other->second, out, row, all, seen);
  }
  for (auto& [key, row] : rows) out.rows.push_back(row);
  if (!rows.empty()) out.rows.push_back(all);
  for (AgreementRow& row : out.rows)
    if (row.same.episodes > 0) row.interval = wilson(row.same.agreed(), row.same.episodes);
  return out;
}

}  // namespace

std::vector<EngineAgreement> engine_agreement(const RunResults& run) {
  std::map<std::string, std::vector<std::string>> engines;  // of each layout, in their order
  for (const CellResult& cell : run.cells) {
    std::vector<std::string>& of = engines[cell.layout];
    if (!contains(of, cell.engine)) of.push_back(cell.engine);
  }
  std::vector<EngineAgreement> all;
  for (const auto& [layout, names] : engines)
    for (std::size_t i = 0; i < names.size(); ++i)
      for (std::size_t k = i + 1; k < names.size(); ++k) {
        EngineAgreement one = compare(run, layout, names[i], names[k]);
        if (!one.rows.empty() || one.several_steps > 0) all.push_back(std::move(one));
      }
  return all;
}

Json to_json(const std::vector<EngineAgreement>& agreements) {
  Json all = Json::array();
  for (const EngineAgreement& a : agreements) {
    Json rows = Json::array(), differing = Json::array();
    for (const AgreementRow& r : a.rows)
      rows.push_back({{"method", r.method.empty() ? Json() : Json(r.method)},
                      {"episodes", r.same.episodes},
                      {"other_actions", r.other_actions},
                      {"won_first", r.same.won_first},
                      {"won_second", r.same.won_second},
                      {"agreed", r.same.agreed()},
                      {"low", r.same.episodes > 0 ? Json(r.interval.low) : Json()},
                      {"high", r.same.episodes > 0 ? Json(r.interval.high) : Json()}});
    for (const Disagreement& d : a.disagreements)
      differing.push_back({{"cell", d.cell->key},
                           {"scenario", d.cell->scenario},
                           {"method", d.cell->method},
                           {"demonstrations", d.cell->demonstrations},
                           {"training_seed", d.cell->training_seed},
                           {"arm", d.arm},
                           {"index", d.index},
                           {"scene", d.episode().scene},
                           {"failure_first", d.episode().failure},
                           {"failure_second", d.failure_second}});
    all.push_back(
        {{"layout", a.layout}, {"first", a.first}, {"second", a.second}, {"rows", rows}, {"disagreements", differing}});
    if (a.several_steps > 0) all.back()["several_steps"] = a.several_steps;
  }
  return all;
}

}  // namespace lgabench::statistics

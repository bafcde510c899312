#include <lgabench/leaderboard/replay.hpp>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <random>

#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/scratch.hpp>
#include <lgabench/leaderboard/played_cell.hpp>

namespace lgabench::leaderboard {
namespace {

constexpr double most_flips = .01;  // share of other outcomes that another processor may show

void expect_same(const std::string& what, const std::string& here, const std::string& there) {
  if (here != there) throw InputError(fmt::format("{}: {} here, {} in the entry", what, here, there));
}

// What this installation would play as the entry.
Installed installed_as(const Entry& entry, const Catalogue& catalogue) {
  Installed installed = installed_setting(entry.setting.suite, entry.setting.preset);
  expect_same("preset " + entry.setting.name(), hash(installed.setting).substr(0, 8),
              entry.identity.preset_sha256.substr(0, 8));
  expect_same("scene seed", std::to_string(installed.setting.scene_seed), std::to_string(entry.setting.scene_seed));
  const Competitor& row = entry.identity.row;
  if (!row.is_reference()) expect_same("version of " + row.id, catalogue.find("method", row.id).version, row.version);
  expect_same("version of " + entry.identity.engine, catalogue.find("engine", entry.identity.engine).version,
              entry.identity.engine_version);
  return installed;
}

RunPlan plan_of(const fs::path& board, const Entry& entry, std::vector<Cell> cells, const fs::path& scratch,
                const ReplayOptions& options) {
  RunPlan plan;
  plan.cells = std::move(cells);
  plan.request = {{"suite", entry.setting.suite}, {"preset", entry.setting.preset}};
  plan.command = "lgabench leaderboard verify";
  plan.program = options.program;
  plan.out = scratch / "run";
  plan.cache = scratch / "cache";
  plan.pool = options.pool;
  plan.attributes_others = false;
  const fs::path cassette = board / "answers" / (entry.identity.answers_sha256 + ".jsonl");
  if (is_live(entry.identity.answers))
    plan.live.emplace(LiveModel{cassette, false, -1});
  else if (!cassette_of(entry.identity.answers).empty())
    plan.answers.push_back({cassette.filename(), cassette, Json::object()});
  return plan;
}

// The played cells, in order. @throws InputError for one that the host failed.
std::vector<PlayedCell> lines_of(const RunPlan& plan, const Entry& entry) {
  Entry scratch = entry;  // whose Selections grow
  std::vector<PlayedCell> lines;
  for (const Cell& cell : plan.cells) {
    const std::string name = key(cell);
    const fs::path directory = plan.out / "cells" / name;
    const report::CellResult result = report::read_cell(directory);
    if (result.failed && result.fault != "plugin")
      throw InputError(
          fmt::format("{}: failed by the {}: {}: not recorded", cell.title(), result.fault, result.reason));
    lines.push_back(played_cell(result, directory, name, scratch));
  }
  return lines;
}

int other_outcomes(const PlayedCell& there, const PlayedCell& here) {
  int flips = 0;
  for (const auto& [arm, letters] : there.outcomes)
    for (std::size_t i = 0; i < letters.size(); ++i)
      flips += (letters[i] == success_letter) != (here.outcomes.at(arm).at(i) == success_letter);
  return flips;
}

// What a cell's line says of its results: a digest of the files alone would vouch for outcomes that are not theirs.
Json results_of(const PlayedCell& cell) {
  Json json = to_json(cell);
  for (const char* other : {"key", "learn_s", "total_s"}) json.erase(other);
  if (!cell.failed.empty()) json["failed"] = true;  // its words may name a process
  return json;
}

// Recorded cells beside the same ones now: how many agree to the bit, and how many episodes ended otherwise.
Json compared(const Entry& entry, const std::vector<std::size_t>& chosen, const std::vector<PlayedCell>& now,
              const std::string& processor) {
  int identical = 0, flips = 0, episodes = 0;
  Json keys = Json::array();
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const PlayedCell& before = entry.cells[chosen[i]];
    keys.push_back(before.key);
    identical += results_of(before) == results_of(now[i]);
    flips += other_outcomes(before, now[i]);
    episodes += before.episodes();
  }
  const bool same_processor = std::any_of(entry.evidence.begin(), entry.evidence.end(), [&](const Json& one) {
    return one.at("machine").at("processor") == processor;
  });
  const bool passed = identical == static_cast<int>(chosen.size()) ||
                      (!same_processor && flips <= most_flips * static_cast<double>(episodes));
  return {{"kind", "replay"}, {"cells", keys},        {"bit_identical", identical},
          {"flips", flips},   {"episodes", episodes}, {"passed", passed}};
}

// Successes of the first arm, over the cells of one scenario and layout: the same policy on the board's scenes and on
// others. A success and a failure are added to each cell's (Agresti and Caffo 2000).
Json compared_fresh(const Entry& entry, const std::vector<std::size_t>& chosen, const std::vector<PlayedCell>& now) {
  double difference = 0, variance = 0;
  int episodes = 0;
  Json keys = Json::array();
  const auto cells = static_cast<double>(chosen.size());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const PlayedCell& before = entry.cells[chosen[i]];
    const std::string& arm = entry.setting.scenario(before.place.scenario).arms.front();
    keys.push_back(before.key);
    for (const auto& [cell, sign] : {std::pair(&before, -1.), {&now[i], 1.}}) {
      const std::string& letters = cell->outcomes.at(arm);
      const auto n = static_cast<double>(letters.size());
      const double rate =
          (static_cast<double>(std::count(letters.begin(), letters.end(), success_letter)) + 1) / (n + 2);
      difference += sign * rate / cells;
      variance += rate * (1 - rate) / (n + 2) / cells / cells;
      episodes += static_cast<int>(letters.size());
    }
  }
  const double margin = 1.959964 * std::sqrt(variance), low = difference - margin, high = difference + margin;
  return {{"kind", "fresh"},
          {"cells", keys},
          {"bit_identical", 0},
          {"flips", 0},
          {"episodes", episodes},
          {"passed", low <= 0 && high >= 0},
          {"difference", difference},
          {"low", low},
          {"high", high}};
}

// One number of demonstrations and one training seed of a row, in every scenario and layout.
std::vector<std::size_t> one_of_each(const Entry& entry, const std::string& nonce) {
  const Setting& setting = entry.setting;
  const bool learning = learns(entry.identity.row);
  const auto pick = [&](const char* what, std::size_t count) {
    return static_cast<std::size_t>(std::stoull(sha256(nonce + what).substr(0, 8), nullptr, 16)) % count;
  };
  const int n = learning ? setting.demonstrations[pick("demonstrations", setting.demonstrations.size())] : 0;
  const bool seeds = learning || setting.test_scenes == "per_seed";
  const std::uint64_t seed = seeds ? setting.seeds[pick("seed", setting.seeds.size())] : 0;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < entry.cells.size(); ++i)
    if (entry.cells[i].place.demonstrations == n && entry.cells[i].place.seed == seed) chosen.push_back(i);
  return chosen;
}

}  // namespace

std::string new_nonce() {
  std::random_device random;
  std::string nonce;
  for (int i = 0; i < 4; ++i) nonce += fmt::format("{:08x}", static_cast<std::uint32_t>(random()));
  return nonce;
}

std::optional<Json> replay(const fs::path& board, const Entry& entry, const std::string& nonce,
                           const Catalogue& catalogue, const ReplayOptions& options) {
  Installed installed = installed_as(entry, catalogue);
  const std::vector<std::size_t> chosen =
      options.fresh ? one_of_each(entry, nonce) : chosen_cells(entry, nonce, options.cells);
  if (options.fresh) installed.grid.scene_seed = std::stoull(sha256(nonce).substr(0, 15), nullptr, 16);
  const std::vector<Cell> all =
      cells_of_row(installed, entry.identity.row, entry.identity.engine, entry.identity.answers);
  std::vector<Cell> cells;
  for (const std::size_t i : chosen) cells.push_back(all[i]);
  const Scratch scratch("verify");
  const RunPlan plan = plan_of(board, entry, std::move(cells), scratch.path, options);
  if (run_suite(plan, catalogue).interrupted) return std::nullopt;
  const RunRecord run = read_run_record(plan.out);
  const std::vector<PlayedCell> now = lines_of(plan, entry);
  Json line = options.fresh ? compared_fresh(entry, chosen, now) : compared(entry, chosen, now, run.processor());
  line.update({{"nonce", nonce},
               {"by", options.by},
               {"when", fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)))},
               {"program", options.program},
               {"build", run.build},
               {"machine", run.machine},
               {"confinement", run.confinement}});
  if (options.fresh)
    line.update({{"scene_seed", installed.grid.scene_seed},
                 {"demonstrations", entry.cells[chosen.front()].place.demonstrations},
                 {"training_seed", entry.cells[chosen.front()].place.seed}});
  return line;
}

}  // namespace lgabench::leaderboard

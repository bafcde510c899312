#include <lgabench/leaderboard/recompute.hpp>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <random>

#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/drawn/draw.hpp>
#include <lgabench/harness/recompute.hpp>
#include <lgabench/leaderboard/answer_score.hpp>
#include <lgabench/leaderboard/fresh_commands.hpp>
#include <lgabench/leaderboard/played_cell.hpp>
#include <lgabench/leaderboard/units.hpp>
#include <lgabench/leaderboard/verification.hpp>

namespace lgabench::leaderboard {
namespace {

void expect_same(const std::string& what, const std::string& here, const std::string& there) {
  if (here != there) throw InputError(fmt::format("{}: {} here, {} in the entry", what, here, there));
}

// What an entry says of its method is what the installed one says of itself: whom it asks, and all of its options.
void expect_method(const Competitor& row, const Catalogue& catalogue) {
  if (row.is_reference()) {
    expect_same("options of " + row.id, "{}", canonical(row.options));
    return;
  }
  const PluginInfo& installed = catalogue.find("method", row.id);
  const auto named = [](const std::string& asks) { return asks.empty() ? "nobody" : asks; };
  expect_same("version of " + row.id, installed.version, row.version);
  expect_same("whom " + row.id + " asks", named(installed.asks), named(row.asks));
  if (row.acts) {
    const PluginInfo& acts = catalogue.find("method", row.acts->id);
    expect_same("version of " + acts.id, acts.version, row.acts->version);
    expect_same("options of " + acts.id, canonical(resolve_options(acts, row.acts->options)),
                canonical(row.acts->options));
  }
  expect_same("options of " + row.id, canonical(resolve_options(installed, row.options)), canonical(row.options));
}

// The entry's cells here. @throws InputError where they would be played under others than the entry's.
std::vector<Cell> cells_of(const Entry& entry, const Installed& installed) {
  const Identity& identity = entry.identity;
  std::vector<Cell> cells =
      cells_of_row(installed, identity.row, identity.engine, identity.answers, identity.conditions);
  for (const Cell& cell : cells) identity.conditions.expect_same(cell);
  return cells;
}

// The score of an entry's answers follows from them alone.
void expect_own_score(const fs::path& board, const Entry& entry, const Installed& installed) {
  if (entry.score.is_null()) return;
  const fs::path kept = answers_file(entry.identity);
  Json here =
      score_of_answers(installed, entry.identity.row, entry.identity.answers, kept.empty() ? kept : board / kept);
  if (here.is_null()) throw InputError("score of the answers: none here, one in the entry");
  if (entry.score.contains("model")) here = as_before_the_list(std::move(here));
  if (here == entry.score) return;
  expect_same("score of the answers, scenes exact", fmt::format("{:.6f}", scenes_exact(here)),
              fmt::format("{:.6f}", scenes_exact(entry.score)));
  throw InputError("score of the answers: other groups, errors or price here than in the entry");
}

RunPlan plan_of(const fs::path& board, const Entry& entry, std::vector<Cell> cells, const VerifyOptions& options) {
  RunPlan plan;
  plan.cells = std::move(cells);
  plan.request = {{"suite", entry.setting.suite}, {"preset", entry.setting.preset}};
  plan.command = "lgabench leaderboard verify";
  plan.program = options.program;
  plan.pool = options.pool;
  const fs::path kept = answers_file(entry.identity);
  if (std::holds_alternative<LiveAnswers>(entry.identity.answers))
    plan.live.emplace(LiveModel{board / kept, false, -1});
  else if (!kept.empty())
    plan.answers.push_back({kept.filename(), board / kept, Json::object()});
  return plan;
}

// The recomputed cells, in order, as lines of `now`, whose Selections grow. @throws InputError for one that the host
// failed.
std::vector<PlayedCell> lines_of(const RunPlan& plan, const Recomputed& recomputed, Entry& now) {
  std::vector<PlayedCell> lines;
  for (std::size_t i = 0; i < plan.cells.size(); ++i) {
    const statistics::CellResult result = statistics::read_cell(recomputed.cells[i]);
    if (result.failed && result.fault != "plugin")
      throw InputError(
          fmt::format("{}: failed by the {}: {}: not recorded", plan.cells[i].title(), result.fault, result.reason));
    lines.push_back(played_cell(result, recomputed.cells[i], key(plan.cells[i]), now));
  }
  return lines;
}

// What a cell's line says of its results: a digest of the files alone would vouch for outcomes that are not theirs.
Json results_of(const PlayedCell& cell) {
  Json json = to_json(cell);
  for (const char* other : {"key", "learn_s", "total_s"}) json.erase(other);
  if (!cell.failed.empty()) json["failed"] = true;  // its words may name a process
  return json;
}

// A recorded line beside that of the same cell now. `excused`: the processors owe no equal bits.
statistics::CellAgreement compared(const PlayedCell& before, const PlayedCell& now, bool excused) {
  statistics::CellAgreement cell;
  cell.episodes = before.episodes();
  for (const auto& [arm, letters] : before.outcomes)
    for (std::size_t i = 0; i < letters.size(); ++i) {
      const bool there = is_success(letters[i]), here = is_success(now.outcomes.at(arm).at(i));
      cell.only_recorded += there && !here;
      cell.only_recomputed += here && !there;
    }
  const bool comparable =
      before.phi == now.phi && before.scenes == now.scenes && before.failed.empty() == now.failed.empty();
  if (results_of(before) == results_of(now))
    cell.agreement = statistics::Agreement::identical;
  else if (excused && comparable)
    cell.agreement =
        before.outcomes == now.outcomes ? statistics::Agreement::same_outcomes : statistics::Agreement::other_outcomes;
  return cell;
}

// A replay's line, without who made it. `played`: the plan's cells, which became the lines of `now`.
Json replayed(const Entry& entry, const std::vector<std::size_t>& chosen, const std::vector<PlayedCell>& now,
              const std::vector<Cell>& played, const Catalogue& catalogue, const Processor& here) {
  std::vector<std::pair<std::string, statistics::CellAgreement>> cells;
  int identical = 0, episodes = 0;
  statistics::PooledAgreement all;
  Json keys = Json::array();
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const PlayedCell& before = entry.cells[chosen[i]];
    keys.push_back(before.key);
    const bool owed = owe_same_bits(entry.processor(), here, has_own_arithmetic(played[i], catalogue));
    const statistics::CellAgreement& cell = cells.emplace_back("", compared(before, now[i], !owed)).second;
    identical += cell.agreement == statistics::Agreement::identical;
    all.add(cell);
    episodes += cell.episodes;
  }
  return {{"kind", "replay"},
          {"cells", keys},
          {"bit_identical", identical},
          {"flips", all.only_recorded + all.only_recomputed},
          {"only_recorded", all.only_recorded},
          {"worse", all.worse},
          {"better", all.better},
          {"episodes", episodes},
          {"passed", statistics::verdict_of(cells) != statistics::Reproduction::differs}};
}

// How many persons a cell's commands are of, who are now others; 0 where they are nobody's. The cells are all scenarios
// of one place each, in order.
int draw_other_persons(std::vector<Cell>& cells, std::uint64_t seed) {
  int before = 0, of_cell = 0;
  for (Cell& cell : cells) {
    if (!cell.scenario->value("persons", false)) return 0;
    const FeatureSpace space = load_feature_space(cell.scenario->at("feature_space"));
    cell.scenario = std::make_shared<const Json>(drawn::with_other_persons(*cell.scenario, space, seed, before));
    of_cell = static_cast<int>(cell.scenario->at("commands").size());
    before += of_cell;
  }
  return of_cell;
}

// A line of fresh scenes, without who made it.
Json played_fresh(const Entry& entry, const std::vector<std::size_t>& chosen, const std::vector<PlayedCell>& now,
                  int persons) {
  Json keys = Json::array(), successes = Json::array();
  int episodes = 0;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    keys.push_back(entry.cells[chosen[i]].key);
    episodes += now[i].episodes();
  }
  for (const PlayedCell& one : Units(entry.setting, now)) {
    Json& cell = successes.emplace_back(Json::object());
    for (const auto& [arm, letters] : one.outcomes) cell[arm] = lgabench::successes(letters);
  }
  Json line{{"kind", "fresh"}, {"cells", keys},        {"bit_identical", 0},
            {"flips", 0},      {"episodes", episodes}, {"successes", successes}};
  if (persons > 0) line["persons"] = persons;
  const std::vector<FreshEstimate> estimates = fresh_estimates(entry, {&line});
  const FreshEstimate& mean = estimates.back();
  line.update({{"passed", std::none_of(estimates.begin(), estimates.end(), [](const auto& e) { return e.differs(); })},
               {"difference", mean.difference},
               {"low", mean.low},
               {"high", mean.high}});
  return line;
}

// Who made a line, of what run.
void sign(Json& line, const std::string& nonce, const RunRecord& run, const VerifyOptions& options) {
  line.update({{"nonce", nonce},
               {"by", options.by},
               {"when", fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)))},
               {"program", options.program},
               {"build", run.build},
               {"machine", run.machine},
               {"confinement", run.confinement}});
}

}  // namespace

Installed installed_as(const Entry& entry, const Catalogue& catalogue) {
  Installed installed = installed_setting(entry.setting.suite, entry.setting.preset);
  expect_same("preset " + entry.setting.name(), hash(installed.setting).substr(0, 8),
              entry.identity.preset_sha256.substr(0, 8));
  expect_same("scene seed", std::to_string(installed.setting.scene_seed), std::to_string(entry.setting.scene_seed));
  const auto& [kind, id] = player_of(entry.identity.engine, installed.suite);
  expect_same("version of " + id, catalogue.find(kind, id).version, entry.identity.engine_version);
  return installed;
}

std::optional<Recomputed> played_again(const fs::path& board, const Entry& entry,
                                       const std::vector<std::size_t>& places, int episodes, const Catalogue& catalogue,
                                       const VerifyOptions& options) {
  expect_method(entry.identity.row, catalogue);
  const std::vector<Cell> all = cells_of(entry, installed_as(entry, catalogue));
  std::vector<Cell> cells;
  for (const std::size_t i : places) cells.push_back(all[i]);
  for (Cell& cell : cells) cell.episodes = std::min(cell.episodes, episodes);
  return recompute(plan_of(board, entry, std::move(cells), options), catalogue);
}

std::string new_nonce() {
  std::random_device random;
  std::string nonce;
  for (int i = 0; i < 4; ++i) nonce += fmt::format("{:08x}", static_cast<std::uint32_t>(random()));
  return nonce;
}

std::optional<Json> verification(const fs::path& board, const Entry& entry, const std::string& nonce,
                                 const Catalogue& catalogue, const VerifyOptions& options) {
  Installed installed = installed_as(entry, catalogue);
  expect_method(entry.identity.row, catalogue);
  if (options.on_commands) {
    std::optional<OnFreshCommands> scored = on_fresh_commands(entry, installed, nonce, catalogue, options);
    if (!scored) return std::nullopt;
    sign(scored->line, nonce, scored->run, options);
    return std::move(scored->line);
  }
  expect_own_score(board, entry, installed);
  const std::vector<std::size_t> chosen =
      options.fresh ? fresh_cells(entry, nonce) : chosen_cells(entry, entry.hash(), nonce, options.cells);
  if (options.fresh) installed.design.scene_seed = std::stoull(sha256(nonce).substr(0, 15), nullptr, 16);
  const std::vector<Cell> all = cells_of(entry, installed);
  std::vector<Cell> cells;
  for (const std::size_t i : chosen) cells.push_back(all[i]);
  const int persons = options.fresh ? draw_other_persons(cells, installed.design.scene_seed) : 0;
  const RunPlan plan = plan_of(board, entry, std::move(cells), options);
  const std::optional<Recomputed> recomputed = recompute(plan, catalogue);
  if (!recomputed) return std::nullopt;
  const RunRecord& run = recomputed->record;
  Entry scratch = entry;  // whose Selections grow
  const std::vector<PlayedCell> now = lines_of(plan, *recomputed, scratch);
  Json line = options.fresh ? played_fresh(entry, chosen, now, persons)
                            : replayed(entry, chosen, now, plan.cells, catalogue, run.processor());
  sign(line, nonce, run, options);
  if (options.fresh)
    line.update({{"scene_seed", installed.design.scene_seed},
                 {"demonstrations", entry.cells[chosen.front()].place.demonstrations},
                 {"training_seed", entry.cells[chosen.front()].place.seed}});
  return line;
}

}  // namespace lgabench::leaderboard

#include <lgabench/leaderboard/setting.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/leaderboard/fields.hpp>

namespace lgabench::leaderboard {
namespace {

constexpr long long most_cells = 10'000, most_episodes = 10'000, most_of_all = 5'000'000;  // of a cell's arm; of a row

// A name that may stand in a path.
void expect_name(const JsonReader& reader) {
  const std::string name = reader.string();
  const bool plain =
      !name.empty() && name.size() <= 100 &&
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") == std::string::npos;
  if (!plain) reader.fail("letters, digits and _");
}

// A scenario's pair is mutual, and whole.
void expect_pair(const JsonReader& scenario, const Setting& setting) {
  if (!scenario.has("pair")) {
    if (setting.paired()) scenario.fail("a \"pair\", as other scenarios have one");
    return;
  }
  const std::string id = scenario.at("id").string(), other = scenario.at("pair").string();
  const auto is_other = [&](const Setting::Scenario& one) {
    return one.id == other && one.pair == id && one.arms == setting.scenario(id).arms;
  };
  if (!setting.paired() || std::none_of(setting.scenarios.begin(), setting.scenarios.end(), is_other))
    scenario.at("pair").fail("a scenario with the same arms, whose \"pair\" is this one");
  if (other == id && setting.episodes < 2) scenario.at("pair").fail("at least 2 episodes");
}

// Finds whose scenes come in pairs; leaves it where some scenario's do not.
void add_pairs(const std::vector<Scenario>& scenarios, Setting& setting) {
  std::map<std::uint64_t, std::size_t> firsts;  // by their first scene, without its command
  std::vector<std::string> pairs(scenarios.size());
  for (std::size_t i = 0; i < scenarios.size(); ++i) {
    if (!scenarios[i].may_stop || setting.scenarios[i].arms.empty())
      return;  // a pair's commands differ in how objects are used, until nothing is left to do
    const auto scene = [&](int index) {
      return test_scene(scenarios[i], setting.layouts.front(), setting.scenarios[i].arms.front(), setting.scene_seed,
                        index);
    };
    const Scene first = scene(0);
    if (!first.pair) return;
    const std::uint64_t hash = first.shared_hash();
    const auto [found, is_new] = firsts.emplace(hash, i);
    if (setting.episodes > 1 && scene(1).shared_hash() == hash) {
      pairs[i] = setting.scenarios[i].id;
    } else if (!is_new && pairs[found->second].empty()) {
      pairs[i] = setting.scenarios[found->second].id;
      pairs[found->second] = setting.scenarios[i].id;
    }
  }
  if (contains(pairs, "")) return;
  for (std::size_t i = 0; i < pairs.size(); ++i) setting.scenarios[i].pair = pairs[i];
}

}  // namespace

std::string Place::text() const { return fmt::format("{} {} n={} seed={}", scenario, layout, demonstrations, seed); }

const Setting::Scenario& Setting::scenario(const std::string& id) const {
  const auto found = std::find_if(scenarios.begin(), scenarios.end(), [&](const Scenario& s) { return s.id == id; });
  if (found == scenarios.end()) throw InputError(fmt::format("{}: no scenario \"{}\"", name(), id));
  return *found;
}

std::vector<Place> Setting::places(bool learns) const {
  std::vector<Place> all;
  const std::vector<std::uint64_t> sets = scene_sets(test_scenes, seeds);
  for (const Scenario& scenario : scenarios)
    for (const std::string& layout : layouts) {
      for (const int n : learns ? demonstrations : std::vector<int>{0})
        for (const std::uint64_t seed : learns ? seeds : sets) all.push_back({scenario.id, layout, n, seed});
    }
  return all;
}

static void fields(Setting::Scenario& scenario, Fields& field) {
  field("id", scenario.id);
  field("sha256", scenario.sha256);
  field("arms", scenario.arms);
  field("pair", scenario.pair, when(!scenario.pair.empty()));
}

void fields(Setting& setting, Fields& field) {
  field("suite", setting.suite);
  field("preset", setting.preset);
  field("scenarios", setting.scenarios);
  field("layouts", setting.layouts);
  field("demonstrations", setting.demonstrations, at_least(1));
  field("seeds", setting.seeds);
  field("episodes", setting.episodes, within(1, most_episodes));
  field("test_scenes", setting.test_scenes);
  field("scene_seed", setting.scene_seed);
}

Json to_json(const Setting& setting) { return json_of(setting); }

Setting read_setting(const JsonReader& reader) {
  Setting setting = value_of<Setting>(reader);
  for (const char* name : {"suite", "preset"}) expect_name(reader.at(name));
  for (const JsonReader& scenario : reader.at("scenarios").elements()) {
    expect_name(scenario.at("id"));
    for (const JsonReader& arm : scenario.at("arms").elements()) expect_name(arm);
    if (scenario.at("arms").json().empty()) scenario.at("arms").fail("at least one arm");
    expect_pair(scenario, setting);
  }
  for (const JsonReader& layout : reader.at("layouts").elements()) expect_name(layout);
  for (const char* list : {"scenarios", "layouts", "demonstrations", "seeds"})
    if (reader.at(list).json().empty()) reader.at(list).fail("at least one value");
  const auto size = [](const auto& list) {
    return static_cast<long long>(std::min<std::size_t>(list.size(), most_cells));
  };
  const long long learners = size(setting.layouts) * size(setting.demonstrations) * size(setting.seeds);
  long long arms = 0;
  for (const Setting::Scenario& scenario : setting.scenarios) arms += size(scenario.arms);
  if (learners > most_cells || size(setting.scenarios) * learners > most_cells)
    reader.fail(fmt::format("at most {} cells", most_cells));
  if (arms * learners * setting.episodes > most_of_all) reader.fail(fmt::format("at most {} episodes", most_of_all));
  return setting;
}

std::string hash(const Setting& setting) {
  Json json = to_json(setting);
  json.erase("scene_seed");
  return sha256(canonical(json));
}

Installed installed_setting(const std::string& suite, const std::string& preset) {
  if (fs::path(suite).has_extension())
    throw InputError(fmt::format("suite \"{}\": expected one that is installed, not a file", suite));
  Installed installed{load_suite(suite), {}, {}};
  installed.design = preset_design(installed.suite, preset);
  if (preset.empty() || !installed.suite.presets.at(preset).contains("scene_seed")) {
    std::vector<std::string> boards;
    for (const auto& [name, members] : installed.suite.presets.items())
      if (members.contains("scene_seed")) boards.push_back(name);
    throw InputError(fmt::format(
        "{}: preset \"{}\" is not one of the leaderboard's, which have a scene_seed of their own{}",
        installed.suite.file, preset,
        boards.empty() ? "; the suite has none"
                       : fmt::format(": play lgabench run {} --preset {}", suite, fmt::join(boards, " or "))));
  }
  const Design& design = installed.design;
  Setting& setting = installed.setting;
  setting = {
      installed.suite.id, preset,           {}, design.layouts, design.demonstrations, design.seeds, design.episodes,
      design.test_scenes, design.scene_seed};
  std::vector<Scenario> scenarios;
  for (const std::string& id : suite_scenario_ids(installed.suite, design)) {
    const Scenario& scenario = scenarios.emplace_back(suite_scenario(installed.suite, id, Truth::released, &design));
    Setting::Scenario& one = setting.scenarios.emplace_back();
    one.id = id;
    one.sha256 = sha256(canonical(scenario.json));
    for (const Arm& arm : scenario.tests)
      if (!scenario.is_ambiguous(arm.id)) one.arms.push_back(arm.id);
  }
  add_pairs(scenarios, setting);
  return installed;
}

std::pair<std::string, std::string> player_of(const std::string& engine, const Suite& suite) {
  if (engine == own_engine) return {"environment", suite.environment};
  return {"engine", engine};
}

std::vector<Cell> cells_of_row(const Installed& installed, const Competitor& row, const std::string& engine,
                               const AnswerSource& answers, const Conditions& conditions) {
  std::vector<Cell> cells;
  Cell cell;
  for (const Place& place : installed.setting.places(learns(row))) {
    if (cells.empty() || !(place.scenario == cells.back().scenario_id())) {
      const Scenario scenario = suite_scenario(installed.suite, place.scenario, Truth::released, &installed.design);
      cell = unplayed_cell(installed.suite, installed.design, scenario, answers);
      conditions.set(cell, scenario);
    }
    cell.layout = place.layout;
    cell.engine = engine;
    cell.method = row;
    cell.method.name = row.own_name() + conditions.suffix();
    cell.demonstrations = place.demonstrations;
    cell.training_seed = place.seed;
    cells.push_back(cell);
  }
  return cells;
}

}  // namespace lgabench::leaderboard

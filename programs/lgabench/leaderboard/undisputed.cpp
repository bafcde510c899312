#include <lgabench/leaderboard/undisputed.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include <lgabench/abstraction/disputed.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/leaderboard/units.hpp>
#include <lgabench/statistics/about_suite.hpp>
#include <lgabench/statistics/statistics.hpp>

namespace lgabench::leaderboard {
namespace {

// As it was played.
std::optional<Installed> installed_as_played(const Setting& setting) {
  try {
    Installed installed = installed_setting(setting.suite, setting.preset);
    if (to_json(installed.setting) == to_json(setting)) return installed;
  } catch (const InputError&) {  // another installation's
  }
  return {};
}

}  // namespace

MainColumn main_column(const Setting& setting) {
  const statistics::AboutSuite about = statistics::about_suite(setting.suite);
  const bool has_main = about.main_demonstrations && contains(setting.demonstrations, *about.main_demonstrations);
  return {about.main_arm, has_main ? *about.main_demonstrations : setting.demonstrations.back()};
}

std::optional<Undisputed> undisputed_of(const Setting& setting) {
  const std::optional<Installed> installed = installed_as_played(setting);
  if (!installed) return {};
  Undisputed all{main_column(setting), {}, {}};
  const std::string& arm = all.main.arm;
  std::map<std::string, DisputedPairs> spaces;
  for (const Setting::Scenario& played : setting.scenarios) {
    if (!contains(played.arms, arm)) continue;
    const Scenario scenario = suite_scenario(installed->suite, played.id, Truth::released, &installed->design);
    if (spaces.count(scenario.space.id) == 0) spaces.emplace(scenario.space.id, disputed_pairs(scenario.space));
    const DisputedPairs& pairs = spaces.at(scenario.space.id);
    const std::vector<int> commands = scenario.commands_of(arm);
    const auto is_listed = [&](int i) { return pairs.count(scenario.command(i).utterance) > 0; };
    if (std::none_of(commands.begin(), commands.end(), is_listed)) continue;  // sampling is what takes time
    for (const std::string& layout : setting.layouts)
      for (const std::uint64_t set : scene_sets(setting.test_scenes, setting.seeds)) {
        const std::optional<std::uint64_t> training_seed =
            setting.test_scenes == TestScenes::per_seed ? std::optional(set) : std::nullopt;
        std::vector<bool>& scenes = all.disputed[{played.id, layout, set}];
        for (int i = 0; i < setting.episodes; ++i) {
          const Scene scene = test_scene(scenario, layout, arm, setting.scene_seed, i, training_seed);
          scenes.push_back(is_disputed(pairs, scenario, scene));
          Undisputed::Scenes& of_command = all.commands[scenario.command(scene.command).utterance];
          ++of_command.all;
          of_command.disputed += scenes.back();
        }
      }
  }
  for (auto one = all.commands.begin(); one != all.commands.end();)
    one = one->second.disputed == 0 ? all.commands.erase(one) : std::next(one);
  return all.commands.empty() ? std::nullopt : std::optional(std::move(all));
}

std::optional<double> success(const Undisputed& undisputed, const Entry& entry) {
  struct Count {
    double won = 0, played = 0;
  };
  std::vector<PlayedCell> cells = entry.cells;
  for (PlayedCell& cell : cells) {
    const auto letters = cell.outcomes.find(undisputed.main.arm);
    const auto found = undisputed.disputed.find(
        {cell.place.scenario, cell.place.layout, scene_set(entry.setting.test_scenes, cell.place.seed)});
    if (letters == cell.outcomes.end() || found == undisputed.disputed.end()) continue;
    for (std::size_t i = 0; i < letters->second.size(); ++i)
      if (found->second[i]) letters->second[i] = left_out_letter;
  }
  std::map<std::string, Count> by_scenario;
  for (const PlayedCell& cell : Units(entry.setting, cells)) {
    const auto letters = cell.outcomes.find(undisputed.main.arm);
    const int n = cell.place.demonstrations;  // 0 of a row that learns nothing
    if (letters == cell.outcomes.end() || (n != 0 && n != undisputed.main.demonstrations)) continue;
    for (const char letter : letters->second) {
      if (letter == left_out_letter) continue;
      Count& count = by_scenario[cell.place.scenario];
      ++count.played;
      count.won += is_success(letter);
    }
  }
  std::vector<double> rates;
  for (const auto& one : by_scenario) rates.push_back(one.second.won / one.second.played);
  return rates.empty() ? std::nullopt : std::optional(statistics::mean(rates));
}

std::string words_of(const Undisputed& undisputed) {
  std::vector<std::string> commands;
  for (const auto& [words, scenes] : undisputed.commands)
    commands.push_back(scenes.disputed == scenes.all
                           ? fmt::format("“{}” all {}, so that the command is left out", words, scenes.all)
                           : fmt::format("“{}” {} of {}", words, scenes.disputed, scenes.all));
  return fmt::format(
      "Undisputed: without the scenes that show an object of which it is disputed whether the command means it: {}.",
      fmt::join(commands, ", "));
}

}  // namespace lgabench::leaderboard

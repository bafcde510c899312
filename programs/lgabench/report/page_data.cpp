// What a click on a number shows: kept short, as a large run has hundreds of thousands of episodes.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <tuple>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/shown.hpp>
#include <lgabench/record/outcome.hpp>
#include <lgabench/report/report_document.hpp>
#include <lgabench/statistics/names.hpp>
#include <lgabench/statistics/phi_words.hpp>

namespace lgabench::report {
namespace {

// Columns and rows of the picture where the action's places lie, to a tenth of a pixel; none for another environment's.
Json places_of(const std::string& id, const Action& action) {
  static const std::vector<std::string> installed = environment_ids();
  Json all = Json::array();
  if (!contains(installed, id)) return all;
  const EnvironmentType& environment = find_environment(id);
  const ActionSpace& space = environment.action_space();
  if (action.size() != space.size()) return all;
  const double step = page_step(environment.picture_size());
  const auto tenths = [step](double value) { return std::round(value / step * 10) / 10; };
  for (const PicturePlace& place : space.places) {
    const Vec2 at = in_picture(space, place, action, environment.picture_size());
    all.push_back({tenths(at.x), tenths(at.y)});
  }
  return all;
}

std::string title_of(const MethodStyles& styles, const Table& table, const Row& row) {
  return readable(fmt::format("{}, {}, {}, arm {}, {}", styles.name(row.method), table.title(row.scenario),
                              row.demonstrations ? table.demonstrations_text(row.demonstrations) : "no demonstrations",
                              table.arm_title(row.arm), table.title()));
}

Json to_json(const Pictures::Input& input) {
  return {{"pictures", input.pictures}, {"texts", input.texts}, {"unread", input.unread}};
}

// The rows that each (cell, arm) counts in: its scenario's and the mean's.
using Place = std::tuple<std::string, std::string, std::string, std::string, std::string, int>;
Place place(const std::string& layout, const std::string& engine, const std::string& arm, const std::string& scenario,
            const std::string& method, int n) {
  return {layout, engine, arm, scenario, method, n};
}

}  // namespace

Json page_data(const Material& material) {
  const Pictures& pictures = material.pictures;
  std::map<Place, std::size_t> rows;
  Json titles = Json::array();
  for (const Table& table : material.summary.tables)
    for (const Row& row : table.rows) {
      rows[place(row.layout, row.engine, row.arm, row.scenario, row.method, row.demonstrations)] = row.index;
      titles.push_back(title_of(material.styles, table, row));
    }

  const std::vector<std::string> words = failure_words();
  std::map<std::vector<std::string>, std::size_t> scenes;  // of an arm, shared by the cells that play it
  std::map<Json, std::size_t> phis;                        // what was selected, shared likewise
  std::map<Json, std::size_t> inputs;                      // what policies read, shared likewise
  Json cells = Json::array();
  for (const CellResult& cell : material.run.cells) {
    if (cell.failed) continue;
    Json commands = Json::array(), masks = Json::array(), selected = Json::array();
    for (const CommandResult& command : cell.commands) {
      commands.push_back(command.utterance);
      Json chips = Json::array();  // [what, whether right, missed or wrong, the names]
      for (const PhiWords& of : phi_words(cell, command))
        for (const auto& [kind, names] : {std::pair{"better", &of.right}, {"missed", &of.missed}, {"worse", &of.wrong}})
          if (!names->empty()) chips.push_back({of.about + " " + of.feature, kind, listed(*names, of.known)});
      selected.push_back(phis.emplace(chips, phis.size()).first->second);
      // What follows the scene's hash in the names of pictures.masks.
      masks.push_back(command.quality.empty() ? Json() : Json(mask_key("", cell, command.selection)));
    }
    Json played = Json::array();
    for (const std::string& arm : cell.arms) {
      std::string outcomes, blamed;  // a character an episode
      std::vector<std::string> hashes;
      Json given = Json::array(), actions = Json::object(), ends = Json::object(), read = Json::object();
      const std::vector<Episode>& all = cell.episodes.at(arm);
      for (std::size_t i = 0; i < all.size(); ++i) {
        const Episode& e = all[i];
        outcomes += outcome_letter(e, words);
        blamed += attribution_letter(e);
        hashes.push_back(e.scene);
        given.push_back(e.given());
        if (!e.action.empty() && pictures.scenes.count(e.scene) != 0)
          actions[std::to_string(i)] = places_of(cell.environment, e.action);
        if (const auto end = pictures.ends.find(end_key(cell, arm, i, cell.engine)); end != pictures.ends.end())
          ends[std::to_string(i)] = end->second;
        if (const auto input = pictures.inputs.find(episode_key(cell, arm, i)); input != pictures.inputs.end())
          read[std::to_string(i)] = inputs.emplace(to_json(input->second), inputs.size()).first->second;
      }
      const std::size_t shared = scenes.emplace(hashes, scenes.size()).first->second;
      const auto row = [&](const std::string& scenario) {
        return rows.at(place(cell.layout, cell.engine, arm, scenario, cell.method, cell.demonstrations));
      };
      played.push_back({{"arm", arm},
                        {"rows", {row(cell.scenario), row(mean_scenario)}},
                        {"scenes", shared},
                        {"commands", given},
                        {"outcomes", outcomes},
                        {"attribution", blamed},
                        {"actions", actions},
                        {"ends", ends},
                        {"read", read}});
    }
    cells.push_back({{"cell", cell.key},
                     {"scenario", cell.scenario},
                     {"seed", cell.training_seed},
                     {"participant", cell.participant},
                     {"commands", commands},
                     {"masks", masks},
                     {"phi", selected},
                     {"arms", played}});
  }
  Json arms = Json::object();
  for (const Table& table : material.summary.tables)
    for (const auto& [arm, title] : table.arm_titles) arms[arm] = readable(title);
  std::vector<Json> lists(scenes.size());
  for (const auto& [hashes, number] : scenes) lists[number] = hashes;
  std::vector<Json> selections(phis.size());
  for (const auto& [words_of, number] : phis) selections[number] = words_of;
  std::vector<Json> all_read(inputs.size());
  for (const auto& [input, number] : inputs) all_read[number] = input;
  Json oracle = Json::object();
  for (const auto& [scene, expert] : pictures.oracle) oracle[scene] = places_of(expert.first, expert.second);
  return {{"arms", arms},
          {"failures", words},
          {"phi", selections},
          {"titles", titles},
          {"cells", cells},
          {"scenes", lists},
          {"pictures", pictures.scenes},
          {"masks", pictures.masks},
          {"targets", pictures.targets},
          {"oracle", oracle},
          {"inputs", all_read},
          {"seen", pictures.seen}};
}

}  // namespace lgabench::report

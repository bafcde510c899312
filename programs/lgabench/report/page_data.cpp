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
  Json all = Json::array();
  const EnvironmentType* const there = environment_if_there(id);
  if (!there) return all;
  const EnvironmentType& environment = *there;
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

std::set<std::string> failures_of(const RunResults& run) {
  std::set<std::string> found;
  for (const CellResult& cell : run.cells)
    for (const auto& item : cell.episodes)
      for (const Episode& episode : item.second)
        if (!episode.success()) found.insert(episode.failure);
  return found;
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

// Values that cells share: each is said once, and a cell names its number.
template <class Value>
class Numbered {
 public:
  std::size_t number_of(const Value& value) { return numbers_.emplace(value, numbers_.size()).first->second; }

  Json list() const {
    std::vector<Json> all(numbers_.size());
    for (const auto& [value, number] : numbers_) all[number] = value;
    return all;
  }

 private:
  std::map<Value, std::size_t> numbers_;
};

class PageData {
 public:
  explicit PageData(const Material& material) : material_(material), pictures_(material.pictures) {
    for (const Table& table : material.summary.tables)
      for (const Row& row : table.rows)
        rows_[place(row.layout, row.engine, row.arm, row.scenario, row.method, row.demonstrations)] = row.index;
  }

  Json json() {
    Json cells = Json::array(), titles = Json::array(), arms = Json::object(), oracle = Json::object();
    for (const CellResult& cell : material_.run.cells)
      if (!cell.failed) cells.push_back(of_cell(cell));
    for (const Table& table : material_.summary.tables) {
      for (const Row& row : table.rows) titles.push_back(title_of(material_.styles, table, row));
      for (const auto& [arm, title] : table.arm_titles) arms[arm] = readable(title);
    }
    for (const auto& [scene, expert] : pictures_.oracle)
      if (Json places = places_of(expert.first, expert.second); !places.empty()) oracle[scene] = std::move(places);
    return {{"arms", arms},
            {"failures", words_},
            {"phi", phis_.list()},
            {"titles", titles},
            {"cells", cells},
            {"scenes", scenes_.list()},
            {"pictures", pictures_.scenes},
            {"masks", pictures_.masks},
            {"targets", pictures_.targets},
            {"oracle", oracle},
            {"inputs", inputs_.list()},
            {"seen", pictures_.seen}};
  }

 private:
  Json of_cell(const CellResult& cell) {
    Json commands = Json::array(), masks = Json::array(), selected = Json::array(), played = Json::array();
    for (const CommandResult& command : cell.commands) {
      commands.push_back(command.utterance);
      selected.push_back(phis_.number_of(chips(cell, command)));
      // What follows the scene's hash in the names of pictures.masks.
      masks.push_back(command.quality.empty() ? Json() : Json(mask_key("", cell, command.selection)));
    }
    for (const std::string& arm : cell.arms) played.push_back(of_arm(cell, arm));
    return {{"cell", cell.key},
            {"scenario", cell.scenario},
            {"seed", cell.training_seed},
            {"participant", cell.participant},
            {"commands", commands},
            {"masks", masks},
            {"phi", selected},
            {"arms", played}};
  }

  // What was selected, a chip each: what, whether right, missed or wrong, the names.
  static Json chips(const CellResult& cell, const CommandResult& command) {
    Json all = Json::array();
    for (const PhiWords& of : phi_words(cell, command))
      for (const auto& [kind, names] : {std::pair{"better", &of.right}, {"missed", &of.missed}, {"worse", &of.wrong}})
        if (!names->empty()) all.push_back({of.about + " " + of.feature, kind, listed(*names, of.known)});
    return all;
  }

  Json of_arm(const CellResult& cell, const std::string& arm) {
    std::string outcomes, blamed;  // a character an episode
    std::vector<std::string> hashes;
    Json given = Json::array(), actions = Json::object(), then = Json::object(), ends = Json::object(),
         read = Json::object();
    const std::vector<Episode>& all = cell.episodes.at(arm);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Episode& e = all[i];
      outcomes += outcome_letter(e, words_);
      blamed += attribution_letter(e);
      hashes.push_back(e.scene);
      given.push_back(e.given());
      if (!e.action.empty() && pictures_.scenes.count(e.scene) != 0)
        if (Json places = places_of(cell.environment, e.action); !places.empty()) {
          actions[std::to_string(i)] = std::move(places);
          for (const Action& next : e.then) then[std::to_string(i)].push_back(places_of(cell.environment, next));
        }
      if (const auto end = pictures_.ends.find(end_key(cell, arm, i, cell.engine)); end != pictures_.ends.end())
        ends[std::to_string(i)] = end->second;
      if (const auto input = pictures_.inputs.find(episode_key(cell, arm, i)); input != pictures_.inputs.end())
        read[std::to_string(i)] = inputs_.number_of(to_json(input->second));
    }
    const auto row = [&](const std::string& scenario) {
      return rows_.at(place(cell.layout, cell.engine, arm, scenario, cell.method, cell.demonstrations));
    };
    Json played{{"arm", arm},
                {"rows", {row(cell.scenario), row(mean_scenario)}},
                {"scenes", scenes_.number_of(hashes)},
                {"commands", given},
                {"outcomes", outcomes},
                {"attribution", blamed},
                {"actions", actions},
                {"ends", ends},
                {"read", read}};
    if (!then.empty()) played["then"] = std::move(then);
    return played;
  }

  const Material& material_;
  const Pictures& pictures_;
  const std::vector<std::string> words_ = failure_words(failures_of(material_.run));
  std::map<Place, std::size_t> rows_;
  Numbered<std::vector<std::string>> scenes_;  // of an arm
  Numbered<Json> phis_;                        // what was selected
  Numbered<Json> inputs_;                      // what policies read
};

}  // namespace

Json page_data(const Material& material) { return PageData(material).json(); }

}  // namespace lgabench::report

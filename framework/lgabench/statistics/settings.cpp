#include <lgabench/statistics/settings.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include <lgabench/core/terminal.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/statistics/about_suite.hpp>
#include <lgabench/statistics/names.hpp>

namespace lgabench::statistics {
namespace {

// The row's name, of `human` that of what stands in for people where none took part.
std::string with_stand_in(const RunResults& run, const std::string& row) {
  const std::string people = "human";
  const bool took_part = std::any_of(run.cells.begin(), run.cells.end(), [&row](const CellResult& cell) {
    return cell.method == row && !cell.participant.empty();
  });
  std::string name = row;
  return row_id(row) != people || took_part ? row : name.replace(name.find(people), people.size(), true_mask_row);
}

// Names of the run's rows that a description of methods.json fits, in the order of tables.
std::vector<std::string> rows_like(const RunResults& run, const JsonReader& description) {
  std::set<std::string, ByRank> rows;
  for (const CellResult& cell : run.cells)
    if (fits(cell, description)) rows.insert(cell.method);
  std::vector<std::string> names;
  for (const std::string& row : rows) names.push_back(display_name(with_stand_in(run, row)));
  return names;
}

// What methods.json says of rows that are no reading of the paper, or are one method under two names.
std::vector<std::string> remarks(const RunResults& run) {
  const fs::path file = data_directory() / "paper" / "methods.json";
  const Json json = read_json(file);
  std::vector<std::string> lines;
  for (const JsonReader& remark : JsonReader(json, file.string()).at("remarks").elements()) {
    std::vector<std::string> all;
    bool applies = true;
    for (const JsonReader& description : remark.at("rows").elements()) {
      const std::vector<std::string> names = rows_like(run, description);
      applies = applies && !names.empty();
      all.insert(all.end(), names.begin(), names.end());
    }
    if (applies) lines.push_back(fmt::format("{}: {}", remark.at("text").string(), fmt::join(all, ", ")));
  }
  return lines;
}

// "loss=squared: LGA, Human": rows with the same options together, in the order of tables.
std::vector<std::string> options_beside_defaults(const RunResults& run) {
  std::map<std::string, std::string, ByRank> rows;  // their options
  for (const auto& [row, options] : run.record.settings.items()) {
    std::vector<std::string> texts;
    for (const auto& [option, value] : options.items()) texts.push_back(option + "=" + option_text(value));
    rows[row] = fmt::format("{}", fmt::join(texts, ", "));
  }
  std::vector<std::pair<std::string, std::vector<std::string>>> groups;  // options, rows
  for (const auto& [row, options] : rows) {
    std::size_t at = 0;
    while (at < groups.size() && groups[at].first != options) ++at;
    if (at == groups.size()) groups.push_back({options, {}});
    groups[at].second.push_back(display_name(with_stand_in(run, row)));
  }
  std::vector<std::string> lines;
  for (const auto& [options, names] : groups) lines.push_back(fmt::format("{}: {}", options, fmt::join(names, ", ")));
  return lines;
}

struct Rows {
  std::map<std::string, const CellResult*> cells;       // one of each method's row
  std::map<std::string, std::set<std::string>> values;  // of an option, over all rows
  std::map<std::string, std::size_t> with;              // rows that have the option

  explicit Rows(const RunResults& run) {
    for (const CellResult& cell : run.cells)
      if (!cell.is_reference()) cells.emplace(cell.method, &cell);
    for (const auto& row : cells)
      for (const auto& [option, value] : row.second->options.items()) {
        values[option].insert(option_text(value));
        ++with[option];
      }
  }

  bool differ(const std::string& option) const { return values.at(option).size() > 1; }
  bool all_have(const std::string& option) const { return with.at(option) == cells.size(); }
};

// Those that a row's name says.
std::set<std::string> told_options(const std::string& name) {
  std::set<std::string> named;
  const std::vector<std::string> words = row_words(name);
  for (std::size_t i = 1; i < words.size(); ++i) named.insert(words[i].substr(0, words[i].find('=')));
  return named;
}

bool is_set(const RunResults& run, const std::string& row, const std::string& option) {
  return run.record.settings.value(row, Json::object()).contains(option);
}

bool suite_sets(const Json& options, const CellResult& cell, const std::string& option) {
  for (const std::string& whose : {cell.id, std::string("*")})
    if (const auto values = options.value(whose, Json::object()); values.contains(option))
      return values.at(option) == cell.options.at(option);
  return false;
}

}  // namespace

bool fits(const CellResult& cell, const JsonReader& description) {
  bool all = !description.has("id") || cell.id == description.at("id").string();
  if (description.has("options"))
    for (const auto& [option, value] : description.at("options").json().items())
      all = all && cell.options.value(option, Json()) == value;
  return all;
}

std::string seen_through(const RunResults& run) {
  for (const CellResult& cell : run.cells)
    if (const std::optional<TrainOn>& train_on = cell.configuration.train_on)
      return fmt::format("{}, {}", one_line(train_on->axis),
                         train_on->level ? fmt::format("level {}", *train_on->level) : "at a level drawn for each");
  return "";
}

std::vector<std::string> settings(const RunResults& run) {
  std::vector<std::string> lines;
  if (!run.record.preset.empty()) lines.push_back("preset " + run.record.preset);
  for (const std::string& line : options_beside_defaults(run)) lines.push_back("beside the plugins' defaults, " + line);
  if (run.record.request.value("test_scenes", Json()) == TestScenes::per_seed)
    lines.emplace_back("each training seed plays test scenes of its own");
  if (const std::string through = seen_through(run); !through.empty())
    lines.push_back("methods saw their demonstrations through " + through);
  if (const Json played = run.record.request.value("played", Json()); played.is_object()) {
    std::vector<std::string> some;
    for (const Json& axis : played.value("axes", Json::array())) {
      some.push_back(axis.value("axis", ""));
      if (const auto levels = axis.value("levels", std::vector<int>()); !levels.empty())
        some.back() += fmt::format(" {}", fmt::join(levels, ", "));
    }
    for (const Json& arm : played.value("arms", Json::array())) some.push_back(arm.get<std::string>());
    lines.push_back("beside first arms, only these were played: " + one_line(fmt::format("{}", fmt::join(some, "; "))));
  }
  for (const std::string& line : remarks(run)) lines.push_back(line);
  return lines;
}

std::map<std::string, std::string> told_names(const RunResults& run) {
  const Rows rows(run);
  const Json suite = about_suite(run.suite).options;
  std::map<std::string, std::string> names;
  for (const auto& [row, cell] : rows.cells) {
    std::string& name = names[row] = with_stand_in(run, row);
    const std::set<std::string> named = told_options(row);
    for (const auto& [option, value] : cell->options.items()) {
      if (named.count(option) > 0) continue;
      const bool is_chosen = is_set(run, row, option) && !rows.all_have(option) && !suite_sets(suite, *cell, option);
      if (rows.differ(option) || is_chosen) name += "+" + option + "=" + option_text(value);
    }
  }
  return names;
}

std::vector<std::map<std::string, std::string>> told_names(const std::vector<const RunResults*>& runs) {
  std::map<std::pair<std::string, std::string>, std::set<std::string>> values;  // by method and option
  std::vector<Rows> all;
  for (const RunResults* run : runs)
    for (const auto& row : all.emplace_back(*run).cells)
      for (const auto& [option, value] : row.second->options.items())
        values[{row.second->id, option}].insert(option_text(value));
  std::vector<std::map<std::string, std::string>> names;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    names.push_back(told_names(*runs[i]));
    for (auto& [row, name] : names.back()) {
      const CellResult& cell = *all[i].cells.at(row);
      const std::set<std::string> named = told_options(name);
      for (const auto& [option, value] : cell.options.items())
        if (named.count(option) == 0 && values.at({cell.id, option}).size() > 1)
          name += "+" + option + "=" + option_text(value);
    }
  }
  return names;
}

std::vector<std::pair<std::string, std::string>> shared_options(const RunResults& run) {
  const Rows rows(run);
  std::vector<std::pair<std::string, std::string>> all;
  for (const auto& [option, values] : rows.values)
    if (values.size() == 1 && rows.all_have(option) &&
        std::all_of(rows.cells.begin(), rows.cells.end(),
                    [&, name = option](const auto& row) { return is_set(run, row.first, name); }))
      all.emplace_back(option, *values.begin());
  return all;
}

}  // namespace lgabench::statistics

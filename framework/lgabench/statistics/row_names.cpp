#include <lgabench/statistics/row_names.hpp>

#include <algorithm>
#include <set>

#include <lgabench/plugin/loader.hpp>
#include <lgabench/statistics/about_suite.hpp>

namespace lgabench::report {
namespace {

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
  std::set<std::string> told;
  const std::vector<std::string> words = row_words(name);
  for (std::size_t i = 1; i < words.size(); ++i) told.insert(words[i].substr(0, words[i].find('=')));
  return told;
}

bool is_set(const RunResults& run, const std::string& row, const std::string& option) {
  return run.record.settings.value(row, Json::object()).contains(option);
}

bool suite_sets(const Json& options, const CellResult& cell, const std::string& option) {
  for (const std::string& whose : {cell.id, std::string("*")})
    if (const auto own = options.value(whose, Json::object()); own.contains(option))
      return own.at(option) == cell.options.at(option);
  return false;
}

}  // namespace

std::map<std::string, std::string> told_names(const RunResults& run) {
  const Rows rows(run);
  const Json suite = about_suite(run.suite).options;
  std::map<std::string, std::string> names;
  for (const auto& [row, cell] : rows.cells) {
    std::string& name = names[row] = row;
    const std::set<std::string> told = told_options(row);
    for (const auto& [option, value] : cell->options.items()) {
      if (told.count(option) > 0) continue;
      const bool own = is_set(run, row, option) && !rows.all_have(option) && !suite_sets(suite, *cell, option);
      if (rows.differ(option) || own) name += "+" + option + "=" + option_text(value);
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
      const std::set<std::string> told = told_options(name);
      for (const auto& [option, value] : cell.options.items())
        if (told.count(option) == 0 && values.at({cell.id, option}).size() > 1)
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

}  // namespace lgabench::report

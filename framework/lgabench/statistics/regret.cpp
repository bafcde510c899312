#include <lgabench/statistics/regret.hpp>

#include <fmt/format.h>

#include <map>
#include <tuple>

#include <lgabench/statistics/bootstrap.hpp>

namespace lgabench::statistics {
namespace {

using Persons = std::map<std::pair<std::string, int>, std::vector<double>>;  // scenario and command: success by scene
using Place = std::tuple<std::string, std::string, int, int>;  // layout, engine, demonstrations, questions

int questions_of(const CellResult& cell) {
  const Json asked = cell.options.is_object() ? cell.options.value("questions", Json()) : Json();
  return asked.is_number_integer() ? asked.get<int>() : 0;
}

struct RowOfPersons {
  Persons persons;
  bool failed = false, bayes = false;
};

// As SharedResamples wants it: a policy a person.
std::vector<std::vector<std::vector<double>>> outcomes(const Persons& persons) {
  std::vector<std::vector<std::vector<double>>> all;
  for (const auto& one : persons) all.push_back({one.second});
  return all;
}

double mean_success(const Persons& persons) {
  double sum = 0;
  for (const auto& one : persons) sum += mean(one.second);
  return sum / static_cast<double>(persons.size());
}

bool paired(const Persons& a, const Persons& b) {
  if (a.size() != b.size()) return false;
  for (auto one = a.begin(), other = b.begin(); one != a.end(); ++one, ++other)
    if (one->first != other->first || one->second.size() != other->second.size()) return false;
  return true;
}

}  // namespace

bool is_bayes(const CellResult& cell) {
  const auto is = [&cell](const char* option, const char* value) {
    return cell.options.value(option, Json()) == value;
  };
  return cell.id == "person_rule" && is("learns", "bayes") && is("choice", "selection") && is("asks", "best");
}

std::vector<Regret> regrets(const RunResults& run) {
  std::map<Place, std::map<std::string, RowOfPersons>> places;
  for (const CellResult& cell : run.cells) {
    if (!cell.configuration.scenario || !cell.configuration.scenario->contains("questions") || cell.is_reference())
      continue;
    RowOfPersons& row = places[{cell.layout, cell.engine, cell.demonstrations, questions_of(cell)}][cell.method];
    row.failed = row.failed || cell.failed;
    row.bayes = is_bayes(cell);
    for (const auto& arm : cell.episodes)
      for (const Episode& episode : arm.second)
        row.persons[{cell.scenario, episode.command}].push_back(episode.success() ? 1 : 0);
  }
  std::vector<Regret> all;
  for (const auto& [place, rows] : places) {
    const auto& [layout, engine, demonstrations, questions] = place;
    const RowOfPersons* bayes = nullptr;
    for (const auto& row : rows)
      if (row.second.bayes && !row.second.failed) bayes = &row.second;
    if (!bayes || bayes->persons.empty()) continue;
    for (const auto& [method, row] : rows) {
      if (row.failed || !paired(row.persons, bayes->persons)) continue;
      const SharedResamples resamples(
          {outcomes(row.persons), outcomes(bayes->persons)}, true,
          fmt::format("report/regret/{}/{}/{}/{}/{}", layout, engine, demonstrations, questions, method), {},
          SharedResamples::Draws::scenarios_too);
      all.push_back({layout, engine, method, demonstrations, questions, static_cast<int>(row.persons.size()),
                     mean_success(row.persons), mean_success(bayes->persons) - mean_success(row.persons),
                     resamples.interval(0), resamples.difference(0, 1)});
    }
  }
  return all;
}

Json to_json(const Regret& regret) {
  const auto ends = [](const Interval& interval) { return Json{{"low", interval.low}, {"high", interval.high}}; };
  return {{"layout", regret.layout},       {"engine", regret.engine},
          {"method", regret.method},       {"demonstrations", regret.demonstrations},
          {"questions", regret.questions}, {"persons", regret.persons},
          {"success", regret.success},     {"success_interval", ends(regret.success_interval)},
          {"regret", regret.regret},       {"regret_interval", ends(regret.interval)}};
}

}  // namespace lgabench::statistics

#include <lgabench/statistics/regret.hpp>

#include <fmt/format.h>

#include <map>
#include <tuple>
#include <utility>

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
  bool failed = false, bayes = false, ceiling = false, selects_once = true;
};

// As SharedResamples wants it: a policy a person.
std::vector<std::vector<std::vector<double>>> outcomes(const Persons& persons) {
  std::vector<std::vector<std::vector<double>>> all;
  for (const auto& one : persons) all.push_back({one.second});
  return all;
}

std::vector<double> success_by_person(const Persons& persons) {
  std::vector<double> all;
  for (const auto& one : persons) all.push_back(mean(one.second));
  return all;
}

std::optional<Interval> over_persons(const std::vector<double>& by_person, const Interval& of_scenes) {
  return over_clusters(by_person, std::vector<double>(by_person.size(), 1), of_scenes);
}

bool paired(const Persons& a, const Persons& b) {
  if (a.size() != b.size()) return false;
  for (auto one = a.begin(), other = b.begin(); one != a.end(); ++one, ++other)
    if (one->first != other->first || one->second.size() != other->second.size()) return false;
  return true;
}

// What `row` loses to `other`; none where there is no such row, or it played other scenes.
std::optional<Loss> loss(const RowOfPersons& row, const RowOfPersons* other, const std::string& name) {
  if (!other || !paired(row.persons, other->persons)) return {};
  const SharedResamples scenes({outcomes(row.persons), outcomes(other->persons)}, true, name);
  std::vector<double> by_person = success_by_person(other->persons);
  const std::vector<double> own = success_by_person(row.persons);
  for (std::size_t i = 0; i < own.size(); ++i) by_person[i] -= own[i];
  return Loss{mean(by_person), over_persons(by_person, scenes.difference(0, 1))};
}

bool is_exact(const CellResult& cell, const char* choice) {
  const auto is = [&cell](const char* option, const char* value) {
    return cell.options.value(option, Json()) == value;
  };
  return cell.id == "person_rule" && is("learns", "bayes") && is("choice", choice) && is("asks", "best");
}

}  // namespace

bool is_bayes(const CellResult& cell) { return is_exact(cell, "selection"); }
bool is_ceiling(const CellResult& cell) { return is_exact(cell, "scene"); }

std::vector<Regret> regrets(const RunResults& run) {
  std::map<Place, std::map<std::string, RowOfPersons>> places;
  for (const CellResult& cell : run.cells) {
    if (!cell.configuration.scenario || !cell.configuration.scenario->contains("questions") || cell.is_reference())
      continue;
    RowOfPersons& row = places[{cell.layout, cell.engine, cell.demonstrations, questions_of(cell)}][cell.method];
    row.failed = row.failed || cell.failed;
    row.bayes = is_bayes(cell);
    row.ceiling = is_ceiling(cell);
    row.selects_once = !cell.options.is_object() || cell.options.value("choice", Json()) != "scene";
    for (const auto& arm : cell.episodes)
      for (const Episode& episode : arm.second)
        row.persons[{cell.scenario, episode.command}].push_back(episode.success() ? 1 : 0);
  }
  std::vector<Regret> all;
  for (const auto& [place, rows] : places) {
    const auto& [layout, engine, demonstrations, questions] = place;
    const RowOfPersons *bayes = nullptr, *ceiling = nullptr;
    for (const auto& row : rows) {
      if (row.second.failed || row.second.persons.empty()) continue;
      if (row.second.bayes) bayes = &row.second;
      if (row.second.ceiling) ceiling = &row.second;
    }
    for (const auto& [method, row] : rows) {
      if (row.failed || row.persons.empty()) continue;
      const std::string name =
          fmt::format("report/regret/{}/{}/{}/{}/{}", layout, engine, demonstrations, questions, method);
      const std::vector<double> by_person = success_by_person(row.persons);
      const SharedResamples scenes({outcomes(row.persons)}, true, name);
      Regret one{layout,
                 engine,
                 method,
                 demonstrations,
                 questions,
                 static_cast<int>(by_person.size()),
                 mean(by_person),
                 over_persons(by_person, scenes.interval(0)),
                 loss(row, ceiling, name),
                 {}};
      if (row.selects_once) one.to_bayes = loss(row, bayes, name);
      if (one.regret || one.to_bayes) all.push_back(std::move(one));
    }
  }
  return all;
}

Json to_json(const Regret& regret) {
  const auto ends = [](const Interval& interval) { return Json{{"low", interval.low}, {"high", interval.high}}; };
  Json json{{"layout", regret.layout},       {"engine", regret.engine},   {"method", regret.method},
            {"questions", regret.questions}, {"persons", regret.persons}, {"demonstrations", regret.demonstrations},
            {"success", regret.success}};
  if (regret.success_interval) json["success_interval"] = ends(*regret.success_interval);
  for (const auto& [member, loss] : {std::pair("regret", &regret.regret), std::pair("to_bayes", &regret.to_bayes)}) {
    if (!*loss) continue;
    json[member] = (*loss)->difference;
    if ((*loss)->interval) json[std::string(member) + "_interval"] = ends(*(*loss)->interval);
  }
  return json;
}

}  // namespace lgabench::statistics

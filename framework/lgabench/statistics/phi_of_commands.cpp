// What cells selected for each command, as summary.json has it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include <lgabench/statistics/summary.hpp>

namespace lgabench::statistics {
namespace {

std::optional<double> mean_cost(const std::vector<Json>& selections, const char* member) {
  std::vector<std::optional<double>> all;
  for (const Json& one : selections) all.emplace_back(one.at("cost").at(member).get<double>());
  return mean_of(all);
}

// The different texts of that member, joined.
std::string words_of(const std::vector<Json>& selections, const char* member) {
  std::set<std::string> words;
  for (const Json& one : selections) words.insert(one.at(member).get<std::string>());
  return fmt::format("{}", fmt::join(words, "; "));
}

// Who selected: "gpt-4, edited by 3 participants". People are counted, not listed.
std::string source_of(const std::vector<Json>& selections) {
  std::map<std::string, std::set<std::string>> people;  // by what stands before "participant ID"
  for (const Json& one : selections)
    if (one.value("provenance", "") == "human") {
      const std::string source = one.value("source", "");
      people[source.substr(0, source.rfind("participant "))].insert(source);
    }
  if (people.empty()) return words_of(selections, "source");
  std::vector<std::string> words;
  for (const auto& [before, sources] : people)
    words.push_back(sources.size() == 1 ? *sources.begin() : fmt::format("{}{} participants", before, sources.size()));
  return fmt::format("{}", fmt::join(words, "; "));
}

// A row's Selections for one command; none if none of its cells selects.
std::optional<PhiOfCommand> phi_of(const std::vector<const CellResult*>& cells, std::size_t command) {
  std::vector<Json> selections;
  std::vector<Quality> qualities;
  for (const CellResult* cell : cells)
    if (!cell->failed && !cell->commands[command].quality.empty()) {
      selections.push_back(cell->commands[command].selection);
      qualities.push_back(cell->commands[command].quality);
    }
  if (selections.empty()) return {};
  const CommandResult& first = cells.front()->commands[command];
  return PhiOfCommand{first.utterance,
                      first.seen,
                      words_of(selections, "provenance"),
                      source_of(selections),
                      words_of(selections, "asked_as"),
                      mean_cost(selections, "lm_queries"),
                      mean_cost(selections, "human_seconds"),
                      mean_quality(qualities),
                      !cells.front()->configuration.selection_errors.none()};
}

}  // namespace

std::vector<PhiOfCommand> phi_of(const std::vector<const CellResult*>& cells, const std::string& arm) {
  std::set<std::size_t> given;
  for (const CellResult* cell : cells)
    if (!cell->failed)
      for (const Episode& e : cell->episodes.at(arm)) given.insert(e.command);
  std::vector<PhiOfCommand> all;
  for (const std::size_t command : given)
    if (auto phi = phi_of(cells, command)) all.push_back(std::move(*phi));
  return all;
}

Json to_json(const PhiOfCommand& phi) {
  return {{"utterance", phi.utterance},
          {"seen", phi.seen},
          {"provenance", phi.provenance},
          {"source", phi.source},
          {"asked_as", phi.asked_as},
          {"lm_queries", phi.lm_queries ? count_json(*phi.lm_queries) : Json()},
          {"human_seconds", phi.human_seconds ? Json(*phi.human_seconds) : Json()},
          {"quality", to_json(phi.quality)}};
}

Json to_json(const std::vector<PhiOfCommand>& phi) {
  Json all;  // null where nothing was selected
  for (const PhiOfCommand& one : phi) all.push_back(to_json(one));
  return all;
}

}  // namespace lgabench::statistics

#include <lgabench/leaderboard/suite_page.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include <lgabench/core/rounding.hpp>
#include <lgabench/leaderboard/answer_score.hpp>
#include <lgabench/leaderboard/titles.hpp>
#include <lgabench/statistics/statistics.hpp>

namespace lgabench::leaderboard {
namespace {

using document::Grid;
using document::Paragraph;
using document::reading;
using document::Section;
using document::Span;

std::vector<const NamedStanding*> scored_of(const NamedTable& table) {
  std::vector<const NamedStanding*> all;
  for (const auto* standings : {&table.standings, &table.waiting})
    for (const NamedStanding& s : *standings)
      if (!s.entry->score.is_null()) all.push_back(&s);
  std::stable_sort(all.begin(), all.end(), [](const auto* a, const auto* b) {
    return scenes_exact(a->entry->score) > scenes_exact(b->entry->score);
  });
  return all;
}

Span name_of(const NamedStanding& s) { return Span(s.label + ", " + s.policy); }

std::string share(const Json& of, const char* part, const char* whole) {
  return fixed(of.at(part).get<double>() / of.at(whole).get<double>());
}

Grid models_grid(const NamedTable& table, const std::vector<const NamedStanding*>& all) {
  std::set<std::string> groups;
  for (const NamedStanding* one : all)
    for (const auto& item : one->entry->score.at("groups").items())
      if (item.key() != "all") groups.insert(item.key());
  Grid grid =
      grid_of(table, "_answers", title_of(table) + ", share of the scenes in which exactly what is meant is kept");
  grid.heads = {"entry", "model", "asked"};
  for (const std::string& group : groups) grid.heads.emplace_back(group);
  for (const char* head : {"all", "sets exact", "questions", "tokens", "played on", "known"})
    grid.heads.emplace_back(head);
  grid.align = "lll" + std::string(groups.size() + 4, 'r') + "ll";
  for (const NamedStanding* one : all) {
    const Json& score = one->entry->score;
    const Json& sum = score.at("groups").at("all");
    Grid::Row row{{}, {name_of(*one), Span(models_of(score)), Span(score.at("asked").get<std::string>())}};
    for (const std::string& group : groups)
      row.cells.emplace_back(Span::number(
          score.at("groups").contains(group) ? share(score.at("groups").at(group), "exact_scenes", "scenes") : "–"));
    const statistics::Interval interval = statistics::wilson(sum.at("exact_scenes"), sum.at("scenes"));
    row.cells.emplace_back(Span::number(
        fmt::format("{} [{}, {}]", share(sum, "exact_scenes", "scenes"), fixed(interval.low), fixed(interval.high))));
    row.cells.emplace_back(Span::number(share(sum, "exact_sets", "commands")));
    for (const char* price : {"questions", "tokens"})
      row.cells.emplace_back(Span::number(std::to_string(score.at(price).get<long long>())));
    row.cells.emplace_back(Span(computed_on(*one->entry)));
    row.cells.emplace_back(Span(one->entry->was_replayed() ? to_string(one->entry->tier()) : "not yet replayed"));
    grid.rows.push_back(std::move(row));
  }
  return grid;
}

// "kept: tomato; missed: pear"
std::string in_words(const Json& wrong) {
  std::vector<std::string> words;
  for (const char* what : {"kept", "missed"})
    if (!wrong.at(what).empty())
      words.push_back(fmt::format("{}: {}", what, fmt::join(wrong.at(what).get<std::vector<std::string>>(), ", ")));
  return fmt::format("{}", fmt::join(words, "; "));
}

std::optional<Grid> wrong_grid(const NamedTable& table, const std::vector<const NamedStanding*>& all) {
  Grid grid = grid_of(table, "_wrong", "What was wrong");
  const Titles titles(table.setting.suite);
  grid.heads = {"entry", "asked", "scenario", "scenes exact", "wrong in the others"};
  grid.align = "lllrl";
  for (const NamedStanding* one : all) {
    const Json& score = one->entry->score;
    if (score.at("asked") == "named") continue;  // nobody's mistakes
    for (const auto& [id, wrong] : score.at("wrong").items())
      grid.rows.push_back(
          {{},
           {name_of(*one), Span(score.at("asked").get<std::string>()), Span(titles.scenario(id)),
            Span::number(fmt::format("{} of {}", wrong.at("exact_scenes").get<int>(), wrong.at("scenes").get<int>())),
            Span(in_words(wrong))},
           false});
  }
  if (grid.rows.empty()) return {};
  return grid;
}

}  // namespace

std::optional<Section> answers_section(const NamedTable& table, const std::string& id) {
  const std::vector<const NamedStanding*> all = scored_of(table);
  if (all.empty()) return {};
  Section section{id, "What the answers keep, without a policy"};
  section.add<Paragraph>(
      reading,
      {{"Of each command what was answered, in test scenes of the table's scene seed: exact where the mask keeps the "
        "meant object and nothing else. flat: asked yes or no of each object type and texture; structured: asked what "
        "the command means; named: nobody was asked, the names in the command alone. verify scores the answers again "
        "from their file. Truths of shipped commands are public, so answers to them prove nothing."}});
  section.add<Grid>(reading, models_grid(table, all));
  if (auto wrong = wrong_grid(table, all)) section.add<Grid>(reading, std::move(*wrong));
  return section;
}

}  // namespace lgabench::leaderboard

#include <lgabench/leaderboard/answers_page.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include <lgabench/core/rounding.hpp>
#include <lgabench/leaderboard/answer_score.hpp>
#include <lgabench/leaderboard/titles.hpp>
#include <lgabench/report/statistics.hpp>

namespace lgabench::leaderboard {
namespace {

using report::Grid;
using report::Paragraph;
using report::reading;
using report::Section;
using report::Span;

struct Scored {
  const Entry* entry;
  std::string label;
};

std::vector<Scored> scored_of(const NamedTable& table) {
  std::vector<Scored> all;
  const auto add = [&all](const std::vector<Standing>& standings, const std::vector<std::string>& labels,
                          const std::vector<std::string>& policies) {
    for (std::size_t i = 0; i < standings.size(); ++i)
      if (!standings[i].entry->score.is_null()) all.push_back({standings[i].entry, labels[i] + ", " + policies[i]});
  };
  add(table.standings, table.labels, table.policies);
  add(table.waiting, table.waiting_labels, table.waiting_policies);
  std::stable_sort(all.begin(), all.end(), [](const Scored& a, const Scored& b) {
    return scenes_exact(a.entry->score) > scenes_exact(b.entry->score);
  });
  return all;
}

std::string share(const Json& of, const char* part, const char* whole) {
  return fixed(of.at(part).get<double>() / of.at(whole).get<double>());
}

Grid models_grid(const NamedTable& table, const std::vector<Scored>& all) {
  std::set<std::string> groups;
  for (const Scored& one : all)
    for (const auto& item : one.entry->score.at("groups").items())
      if (item.key() != "all") groups.insert(item.key());
  Grid grid;
  grid.name = table.setting.name() + "_answers";
  grid.caption = title_of(table) + ", share of the scenes in which exactly what is meant is kept";
  grid.heads = {"entry", "model", "asked"};
  for (const std::string& group : groups) grid.heads.emplace_back(group);
  for (const char* head : {"all", "sets exact", "questions", "tokens", "played on", "known"})
    grid.heads.emplace_back(head);
  grid.align = "lll" + std::string(groups.size() + 4, 'r') + "ll";
  for (const Scored& one : all) {
    const Json& score = one.entry->score;
    const Json& sum = score.at("groups").at("all");
    Grid::Row row{{}, {Span(one.label), Span(models_of(score)), Span(score.at("asked").get<std::string>())}, false};
    for (const std::string& group : groups)
      row.cells.emplace_back(Span::number(
          score.at("groups").contains(group) ? share(score.at("groups").at(group), "exact_scenes", "scenes") : "–"));
    const report::Interval interval = report::wilson(sum.at("exact_scenes"), sum.at("scenes"));
    row.cells.emplace_back(Span::number(
        fmt::format("{} [{}, {}]", share(sum, "exact_scenes", "scenes"), fixed(interval.low), fixed(interval.high))));
    row.cells.emplace_back(Span::number(share(sum, "exact_sets", "commands")));
    for (const char* price : {"questions", "tokens"})
      row.cells.emplace_back(Span::number(std::to_string(score.at(price).get<long long>())));
    row.cells.emplace_back(Span(one.entry->evidence.front().at("started").get<std::string>().substr(0, 10)));
    row.cells.emplace_back(Span(one.entry->was_replayed() ? to_string(one.entry->tier()) : "not yet replayed"));
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

std::optional<Grid> wrong_grid(const NamedTable& table, const std::vector<Scored>& all) {
  Grid grid;
  grid.name = table.setting.name() + "_wrong";
  grid.caption = "What was wrong";
  const Titles titles(table.setting.suite);
  grid.heads = {"entry", "asked", "scenario", "scenes exact", "wrong in the others"};
  grid.align = "lllrl";
  for (const Scored& one : all) {
    const Json& score = one.entry->score;
    if (score.at("asked") == "named") continue;  // nobody's mistakes
    for (const auto& [id, wrong] : score.at("wrong").items())
      grid.rows.push_back(
          {{},
           {Span(one.label), Span(score.at("asked").get<std::string>()), Span(titles.scenario(id)),
            Span::number(fmt::format("{} of {}", wrong.at("exact_scenes").get<int>(), wrong.at("scenes").get<int>())),
            Span(in_words(wrong))},
           false});
  }
  if (grid.rows.empty()) return {};
  return grid;
}

}  // namespace

std::optional<Section> answers_section(const NamedTable& table, const std::string& id) {
  const std::vector<Scored> all = scored_of(table);
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

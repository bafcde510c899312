#include <lgabench/leaderboard/pages.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/leaderboard/suite_page.hpp>
#include <lgabench/report/names.hpp>
#include <lgabench/report/writers.hpp>

namespace lgabench::leaderboard {
namespace {

using report::csv_line;
using report::display_name;
using report::Document;
using report::Grid;
using report::Heading;
using report::html;
using report::markdown;
using report::Paragraph;
using report::reading;
using report::Section;
using report::Span;

// A table as README.md and index.html have it: of README.md all rows, of index.html the first.
Grid short_grid(const NamedTable& table, std::size_t most) {
  Grid grid;
  grid.name = table.setting.name();
  grid.caption = title_of(table.setting);
  grid.heads = {"rank", "entry", "success", "tier", "by", "id"};
  grid.align = "rlrlll";
  for (std::size_t i = 0; i < std::min(most, table.standings.size()); ++i) {
    const Standing& s = table.standings[i];
    grid.rows.push_back({{},
                         {Span::number(rank_text(s)), Span(display_name(table.names[i])), Span::number(score_text(s)),
                          Span(to_string(s.entry->tier())), Span(s.entry->about.at("by").get<std::string>()),
                          Span::link(s.entry->id(), s.entry->place().string() + "/entry.json")},
                         s.entry->identity.row.is_reference()});
  }
  return grid;
}

Document index(const std::map<std::string, std::vector<NamedTable>>& suites, std::size_t most) {
  Document document;
  document.title = "lgabench leaderboard";
  document.headline = {
      "Every number here is computed from the episodes in entries/. Entries with one rank are ties: none of them is "
      "significantly better than the other by the paired test on these scenes."};
  for (const auto& [suite, tables] : suites) {
    Section section{"suite-" + suite, suite};
    section.add<Paragraph>(reading, {{Span::link("Sortable table, scenarios, episodes of " + suite, suite + ".html")}});
    for (const NamedTable& table : tables) {
      section.add<Heading>(reading, {title_of(table.setting)});
      section.add<Paragraph>(reading, {{what_was_played(table.setting)}});
      section.add<Grid>(reading, short_grid(table, most));
    }
    document.sections.push_back(std::move(section));
  }
  if (suites.empty()) {
    Section section{"none", "No entry yet"};
    section.add<Paragraph>(reading, {{"docs/leaderboard.md says how to submit one."}});
    document.sections.push_back(std::move(section));
  }
  return document;
}

std::string number(double value) { return fmt::format("{:.6g}", value); }

std::string csv_of(const std::map<std::string, std::vector<NamedTable>>& suites) {
  std::string text = csv_line({"suite",          "preset",       "preset_hash", "scene_seed", "id",
                               "method",         "name",         "version",     "engine",     "answers",
                               "demonstrations", "rank",         "success",     "low",        "high",
                               "episodes",       "failed_cells", "precision",   "recall",     "lm_queries",
                               "lm_tokens",      "learn_s",      "tier",        "not_ranked", "by"});
  for (const auto& suite : suites)
    for (const NamedTable& table : suite.second)
      for (std::size_t i = 0; i < table.standings.size(); ++i) {
        const Standing& s = table.standings[i];
        const Identity& identity = s.entry->identity;
        const auto line = [&](const std::string& n, double success, bool all) {
          const auto when_all = [all](const std::string& value) { return all ? value : std::string(); };
          text += csv_line({table.setting.suite,
                            table.setting.preset,
                            identity.preset_sha256.substr(0, 8),
                            std::to_string(identity.scene_seed),
                            s.entry->id(),
                            identity.row.id,
                            display_name(table.names[i]),
                            identity.row.version,
                            identity.engine,
                            identity.answers,
                            n,
                            when_all(s.rank ? std::to_string(*s.rank) : ""),
                            number(success),
                            when_all(number(s.interval.low)),
                            when_all(number(s.interval.high)),
                            when_all(std::to_string(s.episodes)),
                            when_all(std::to_string(s.failed_cells)),
                            when_all(s.precision ? number(*s.precision) : ""),
                            when_all(s.recall ? number(*s.recall) : ""),
                            when_all(number(s.lm_queries)),
                            when_all(number(s.lm_tokens)),
                            when_all(number(s.learn_s)),
                            when_all(to_string(s.entry->tier())),
                            when_all(s.not_ranked),
                            when_all(s.entry->about.at("by"))});
        };
        line("all", s.score, true);
        for (const auto& [n, rate] : s.at) line(std::to_string(n), rate, false);
      }
  return text;
}

}  // namespace

std::map<std::string, std::string> pages(const std::vector<Entry>& entries) {
  std::map<std::string, std::vector<NamedTable>> suites;
  for (const auto& table : tables(entries)) suites[table.front()->setting.suite].push_back(named_table(table));
  std::map<std::string, std::string> files;
  constexpr std::size_t first_rows = 10, all_rows = 1'000'000;
  files["README.md"] = markdown(index(suites, all_rows));
  files["index.html"] = html(index(suites, first_rows), Json::object(), "leaderboard.js");
  files["leaderboard.csv"] = csv_of(suites);
  for (const auto& [suite, tables] : suites)
    files[suite + ".html"] = html(suite_document(suite, tables), suite_data(tables), "leaderboard.js");
  return files;
}

std::vector<std::string> build(const fs::path& board) {
  const std::map<std::string, std::string> files = pages(read_entries(board));
  std::vector<std::string> names;
  for (const auto& [name, bytes] : files) {
    write_file(board / name, bytes);
    names.push_back(name);
  }
  for (const auto& file : fs::directory_iterator(board))
    if (file.path().extension() == ".html" && files.count(file.path().filename()) == 0) fs::remove(file.path());
  return names;
}

}  // namespace lgabench::leaderboard

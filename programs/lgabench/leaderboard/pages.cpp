#include <lgabench/leaderboard/pages.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include <lgabench/document/writers.hpp>
#include <lgabench/leaderboard/overview.hpp>
#include <lgabench/leaderboard/titles.hpp>
#include <lgabench/leaderboard/units.hpp>
#include <lgabench/statistics/about_suite.hpp>
#include <lgabench/statistics/names.hpp>

namespace lgabench::leaderboard {
namespace {

using document::csv_line;
using document::Document;
using document::Grid;
using document::Heading;
using document::html;
using document::markdown;
using document::Paragraph;
using document::reading;
using document::Section;
using document::Span;
using statistics::display_name;

// A ranking's rows.
Grid short_grid(const NamedTable& table) {
  Grid grid = grid_of(table, "", title_of(table));
  for (const NamedStanding& s : table.standings) {
    add_row(grid, s);
    put(grid, "rank", 'r', rank_span(s));
    put(grid, "method", 'l', Span(s.label));
    put(grid, "policy", 'l', Span(s.policy));
    put(grid, success_word(table.setting), 'r', Span::number(score_text(s)));
    if (s.below_random) grid.rows.back().cells.back().spans.push_back(below_random_mark());
    put(grid, "known", 'l', Span(tier_and_marks(s)));
    put(grid, "by", 'l', by_span(*s.entry));
    put(grid, "id", 'l', id_span(*s.entry));
  }
  return grid;
}

void add_table(Section& section, const NamedTable& table) {
  section.add<Paragraph>(reading, {{what_was_played(table.setting) + " " + words_of(table.ranking, &table.track)}});
  if (!table.standings.empty()) section.add<Grid>(reading, short_grid(table));
  if (auto note = below_random_note(table.standings)) section.add<Paragraph>(reading, std::move(*note));
  if (auto waiting = waiting_grid(table)) section.add<Grid>(reading, std::move(*waiting));
}

// README.md: the first page's words, and every ranking.
Document readme(const Suites& suites) {
  Document document;
  Document first = overview({});
  document.title = first.title;
  document.headline = first.headline;
  document.sections.push_back(how_to_enter());
  for (const auto& [suite, tables] : suites) {
    Section section{"suite-" + suite, Titles(suite).suite()};
    document::Spans introduction;
    if (const std::string question = statistics::about_suite(suite).question; !question.empty())
      introduction.emplace_back(question + " ");
    introduction.push_back(Span::link("Sortable tables, scenarios, episodes", suite + ".html"));
    section.add<Paragraph>(reading, {std::move(introduction)});
    for (const NamedTable& table : tables) {
      if (tables.size() > 1) section.add<Heading>(reading, {section_title(table, tables)});
      add_table(section, table);
    }
    document.sections.push_back(std::move(section));
  }
  document.sections.push_back(words_of_the_board());
  return document;
}

std::string number(double value) { return fmt::format("{:.6g}", value); }

// A line's cells: `first`, the row's conditions, `rest`.
std::string csv_line_of(const Conditions& conditions, std::string std::pair<std::string, std::string>::*which,
                        std::vector<std::string> first, const std::vector<std::string>& rest) {
  for (const auto& one : conditions.values()) first.push_back(one.*which);
  first.insert(first.end(), rest.begin(), rest.end());
  return csv_line(first);
}

std::string csv_of(const Suites& suites) {
  using Column = std::pair<std::string, std::string>;
  const bool paired =
      std::any_of(suites.begin(), suites.end(), [](const auto& suite) { return is_paired(suite.second); });
  std::vector<std::string> heads{"demonstrations", "ranking",      "rank",       "success", "low",        "high",
                                 "episodes",       "failed_cells", "precision",  "recall",  "lm_queries", "lm_tokens",
                                 "learn_s",        "tier",         "not_ranked", "by"};
  if (paired) heads.insert(heads.end(), {"paired_share", "paired_low", "paired_high"});
  std::string text = csv_line_of(
      {}, &Column::first,
      {"suite", "preset", "preset_hash", "scene_seed", "id", "method", "name", "version", "engine", "answers"}, heads);
  for (const auto& suite : suites)
    for (const NamedTable& table : suite.second)
      for (const NamedStanding& s : table.standings) {
        const Identity& identity = s.entry->identity;
        // `share`: what ranks the row, of its episodes or of its pairs; `success` is always that of episodes.
        const auto line = [&](const std::string& n, double success, double share, bool all) {
          const auto when_all = [all](const std::string& value) { return all ? value : std::string(); };
          const std::string low = when_all(number(s.interval.low)), high = when_all(number(s.interval.high));
          std::vector<std::string> cells{n,
                                         to_string(table.ranking),
                                         when_all(s.rank ? std::to_string(*s.rank) : ""),
                                         number(success),
                                         s.each ? "" : low,
                                         s.each ? "" : high,
                                         when_all(std::to_string(s.episodes)),
                                         when_all(std::to_string(s.failed_cells)),
                                         when_all(s.precision ? number(*s.precision) : ""),
                                         when_all(s.recall ? number(*s.recall) : ""),
                                         when_all(number(s.lm_queries)),
                                         when_all(number(s.lm_tokens)),
                                         when_all(number(s.learn_s)),
                                         when_all(to_string(s.entry->tier())),
                                         when_all(s.not_ranked),
                                         when_all(s.entry->about.at("by"))};
          if (s.each) cells.insert(cells.end(), {number(share), low, high});
          cells.resize(heads.size());
          text +=
              csv_line_of(identity.conditions, &Column::second,
                          {table.setting.suite, table.setting.preset, identity.preset_sha256.substr(0, 8),
                           std::to_string(identity.scene_seed), s.entry->id(), identity.row.own_name(),
                           display_name(s.name), identity.row.version, identity.engine, to_string(identity.answers)},
                          cells);
        };
        const Means& of_episodes = s.each ? *s.each : s;
        line("all", of_episodes.score, s.score, true);
        for (const auto& [n, rate] : s.at) line(std::to_string(n), of_episodes.at.at(n), rate, false);
      }
  return text;
}

// A document: its text up to the end of each opening marker, with the marker's name, and the rest of it.
struct Marked {
  std::vector<std::pair<std::string, std::string>> parts;
  std::string rest;
};

Marked read_marked(const fs::path& file) {
  const std::string text = read_file(file), open = "<!-- board:", close = "<!-- /board -->";
  Marked marked;
  std::size_t at = 0;
  for (std::size_t begin = 0; (begin = text.find(open, at)) != text.npos;) {
    const std::size_t end = text.find(close, begin), inside = text.find(" -->", begin) + 4;
    if (end == text.npos || inside > end || text.find(open, begin + 1) < end)
      throw InputError(fmt::format("{}: expected {} after {}SUITE-PRESET -->", file.string(), close, open));
    marked.parts.emplace_back(text.substr(at, inside - at),
                              text.substr(begin + open.size(), inside - 4 - begin - open.size()));
    at = end;
  }
  if (at == 0) throw InputError(fmt::format("{}: expected {}SUITE-PRESET --> and {}", file.string(), open, close));
  marked.rest = text.substr(at);
  return marked;
}

// The document whose text between <!-- board:SUITE-PRESET --> and <!-- /board --> is that preset's tables, and all
// suites' steps between <!-- board:steps --> and that.
std::string with_tables(const Marked& marked, const fs::path& board, const Suites& suites) {
  std::string out;
  for (const auto& [text, name] : marked.parts) {
    Section section;
    if (name == "steps") section.add<Grid>(reading, all_steps_grid(suites));
    for (const auto& suite : suites)
      for (const NamedTable& table : suite.second)
        if (table.setting.name() == name && section.blocks.empty()) add_results(section, table, board);
    if (section.blocks.empty()) section.add<Paragraph>(reading, {{fmt::format("No entry of {} yet.", name)}});
    out += text + '\n' + markdown(section) + '\n';
  }
  return out + marked.rest;
}

// Files, and of folders the Markdown with markers in it.
std::set<fs::path> documents_in(const std::vector<fs::path>& named) {
  std::set<fs::path> files;
  for (const fs::path& one : named) {
    if (!fs::is_directory(one))
      files.insert(one);
    else
      for (const auto& file : fs::directory_iterator(one))
        if (file.path().extension() == ".md" && read_file(file.path()).find("<!-- board:") != std::string::npos)
          files.insert(file.path());
  }
  return files;
}

bool ranks_entries(const NamedTable& table) {
  return std::any_of(table.standings.begin(), table.standings.end(), [](const Standing& s) { return s.rank; });
}

// In the order of tracks.json, then by name; suites for diagnosis, without a rank, come last. A suite's newest presets,
// whose scene seeds are the highest, come first: they replace earlier ones.
Suites suites_of(const std::vector<Entry>& entries, const Labels& labels, const Tracks& tracks,
                 const std::vector<std::string>& order, const OnProgress& on_progress) {
  std::map<std::pair<std::ptrdiff_t, std::string>, std::vector<NamedTable>> by_place;
  const auto all = tables(entries);
  std::size_t done = 0;
  for (const auto& table : all) {
    const std::string& suite = table.front()->setting.suite;
    for (NamedTable& ranking : named_tables(table, labels, tracks))
      by_place[{std::find(order.begin(), order.end(), suite) - order.begin(), suite}].push_back(std::move(ranking));
    if (on_progress) on_progress("computed", ++done, all.size(), "tables");
  }
  Suites suites;
  for (auto& [place, named] : by_place) {
    std::stable_sort(named.begin(), named.end(), [](const NamedTable& one, const NamedTable& other) {
      return std::tie(other.setting.scene_seed, one.ranking) < std::tie(one.setting.scene_seed, other.ranking);
    });
    suites.emplace_back(place.second, std::move(named));
  }
  std::stable_partition(suites.begin(), suites.end(), [](const auto& suite) {
    return std::any_of(suite.second.begin(), suite.second.end(), ranks_entries);
  });
  return suites;
}

}  // namespace

std::map<fs::path, std::string> made_files(const fs::path& board, const std::vector<Entry>& entries,
                                           const std::vector<fs::path>& documents, const OnProgress& on_progress) {
  const Tracks tracks = read_tracks(board);
  for (const Entry& entry : entries) expect_arms(board, tracks, entry.setting);
  const BoardScenes scenes = read_scenes(board, entries);
  const Labels labels = read_labels(board);
  std::map<fs::path, Marked> marked;
  for (const fs::path& document : documents_in(documents)) marked[document] = read_marked(document);
  const Suites suites = suites_of(entries, labels, tracks, read_order(board), on_progress);
  std::map<fs::path, std::string> files;
  files[board / "README.md"] = markdown(readme(suites));
  files[board / "index.html"] = html(overview(suites), overview_data(suites), "leaderboard.js");
  files[board / "leaderboard.csv"] = csv_of(suites);
  for (const auto& [suite, tables] : suites)
    files[board / (suite + ".html")] =
        html(suite_document(suite, tables), suite_data(tables, scenes), "leaderboard.js");
  for (const auto& [document, text] : marked)
    files[document] = with_tables(text, fs::relative(board, fs::absolute(document).parent_path()), suites);
  return files;
}

std::vector<fs::path> build(const fs::path& board, const std::vector<fs::path>& documents,
                            const OnProgress& on_progress) {
  const BoardWriter writer(board);
  expect_entries_of_scenes(board);
  const std::vector<Entry> entries = read_entries(board, on_progress);
  std::map<fs::path, std::string> files = made_files(board, entries, documents, on_progress);
  for (const Entry& entry : entries) files[board / entry.place() / "entry.json"] = entry_text(entry);
  std::vector<fs::path> paths;
  for (const auto& [path, bytes] : files) {
    if (fs::exists(path) && read_file(path) == bytes) continue;
    write_file(path, bytes);
    paths.push_back(path);
  }
  for (const auto& file : fs::directory_iterator(board))
    if (file.path().extension() == ".html" && files.count(board / file.path().filename()) == 0) fs::remove(file.path());
  std::error_code stays;  // a directory, of which check complains
  for (const fs::path& file : other_answers(board, entries)) fs::remove(board / file, stays);
  return paths;
}

}  // namespace lgabench::leaderboard

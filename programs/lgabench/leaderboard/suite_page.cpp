#include <lgabench/leaderboard/suite_page.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include <lgabench/core/rounding.hpp>
#include <lgabench/leaderboard/answer_score.hpp>
#include <lgabench/leaderboard/areas.hpp>
#include <lgabench/leaderboard/board_steps.hpp>
#include <lgabench/leaderboard/titles.hpp>
#include <lgabench/leaderboard/units.hpp>
#include <lgabench/statistics/about_suite.hpp>
#include <lgabench/statistics/names.hpp>
#include <lgabench/statistics/tables.hpp>

namespace lgabench::leaderboard {
namespace {

using document::Chart;
using document::Charts;
using document::Document;
using document::Grid;
using document::on_page;
using document::Paragraph;
using document::reading;
using document::Section;
using document::Series;
using document::Span;
using document::TableCell;
using statistics::display_name;
using statistics::MethodStyle;
using statistics::MethodStyles;

constexpr std::size_t scenarios_of_a_row = 1000;  // data-row: the standing's number times this, and its scenario's + 1
constexpr std::size_t curves = 8;                 // more would hide each other

std::string amount(double value) { return value == 0 ? "–" : fixed(value, value < 10 ? 1 : 0); }

// The rows with their names: the id, and those options, at every row that has them, by which two rows of one method
// differ (one row's default is another's variant); then what else tells them apart.
std::vector<NamedStanding> named(const std::vector<Standing>& standings, const Labels& words) {
  std::map<std::pair<std::string, std::string>, std::set<Json>> values;  // by id and option
  const auto source_of = [](const Identity& identity) {                  // of recorded answers; else ""
    const auto* const from = std::get_if<RecordedAnswers>(&identity.answers);
    return from && !identity.row.is_reference() ? from->source : "";
  };
  std::set<std::string> sources;
  for (const Standing& s : standings) sources.insert(source_of(s.entry->identity));
  sources.erase("");
  for (const Standing& s : standings)
    for (const auto& [option, value] : s.entry->identity.row.options.items())
      values[{s.entry->identity.row.own_name(), option}].insert(value);
  for (const Standing& s : standings)  // an option that came later is not among a row's where it has its default
    for (auto& [key, different] : values)
      if (key.first == s.entry->identity.row.own_name() && !s.entry->identity.row.options.contains(key.second))
        different.insert(Json());
  std::set<std::string> telling;
  for (const auto& [key, different] : values)
    if (different.size() > 1) telling.insert(key.second);
  const std::vector<std::string> options(telling.begin(), telling.end());
  std::vector<NamedStanding> all;
  std::map<std::string, int> times;
  std::map<std::pair<std::string, std::string>, int> labelled;
  for (const Standing& standing : standings) {
    NamedStanding& s = all.emplace_back(NamedStanding{standing});
    const Identity& identity = s.entry->identity;
    s.name = identity.row.own_name();
    for (const auto& [option, value] : identity.row.options.items())
      if (telling.count(option) > 0) s.name += fmt::format("+{}={}", option, option_text(value));
    s.name += identity.conditions.suffix();
    ++times[s.name];
    s.label = label_of(words, *s.entry, options);
    s.policy = policy_label(words, *s.entry);
    // One model's answers to all commands, where "recorded" may be several models'.
    const std::string source = source_of(identity);
    if (sources.size() > 1 && !source.empty() && source != "recorded") s.label += ", answers " + spaced(source);
    ++labelled[{s.label, s.policy}];
  }
  for (NamedStanding& s : all) {
    const Identity& identity = s.entry->identity;
    const std::string id = s.entry->id().substr(0, 6);
    if (times[s.name] > 1)
      s.name += fmt::format("+version={}+answers={}+engine={}+id={}", identity.row.version,
                            to_string(identity.answers).substr(0, 20), identity.engine, id);
    if (labelled[{s.label, s.policy}] > 1) s.label += fmt::format(", version {}, {}", identity.row.version, id);
  }
  return all;
}

// The first row of a method is its best, as rows stand by rank and success, and stays in view; so does the best whose
// policy was trained. Each file of answers that somebody submits competes for itself, and so do rows of other
// conditions.
void mark_more(std::vector<NamedStanding>& standings) {
  std::set<std::string> known;
  for (NamedStanding& s : standings) {
    const std::string answers = s.entry->has_answers_as_submitted() ? s.entry->identity.answers_sha256 : "";
    const Identity& identity = s.entry->identity;
    const std::string untrained = policy_of(*s.entry) == "centroid" ? " untrained" : "";
    s.more = !known
                  .insert(fmt::format("{}{} {}{}", identity.row.own_name(), identity.conditions.suffix(), answers,
                                      untrained))
                  .second;
  }
}

// What a row is called; its options under the pointer.
TableCell named_cell(const NamedStanding& s) {
  Span name(s.label);
  if (const std::string options = display_name(s.name); options != name.text) name.title = options;
  return name;
}

MethodStyles styles_of(const NamedTable& table) {
  std::vector<std::string> names;
  for (const NamedStanding& s : table.standings) names.push_back(s.name);
  return MethodStyles(names);
}

TableCell rate_button(const std::string& text, double rate, std::size_t row) {
  TableCell cell(Span::number(text));
  cell.rate = rate;
  cell.episodes = row;
  return cell;
}

// Success, its interval small beside it.
TableCell score_button(const Standing& s, std::size_t row) {
  TableCell cell = rate_button(score_text(s.score), s.score, row);
  if (s.below_random) cell.spans.push_back(below_random_mark());
  cell.spans.push_back(Span::number(" " + interval_text(s), "", document::Emphasis::detail));
  return cell;
}

// A column without a value in any row says nothing.
void drop_empty_columns(Grid& grid) {
  for (std::size_t k = grid.heads.size(); k-- > 3;) {
    if (!std::all_of(grid.rows.begin(), grid.rows.end(),
                     [k](const Grid::Row& row) { return row.cells[k].text() == "–" || row.cells[k].text().empty(); }))
      continue;
    const auto at = static_cast<std::ptrdiff_t>(k);
    grid.heads.erase(grid.heads.begin() + at);
    grid.align.erase(k, 1);
    for (Grid::Row& row : grid.rows) row.cells.erase(row.cells.begin() + at);
  }
}

TableCell rate_if_any(const std::optional<double>& rate) { return Span::number(rate ? fixed(*rate) : "–"); }

// The table, with a column for each number of demonstrations, and for each arm where there are several.
Grid standings_grid(const NamedTable& table, std::size_t first_row) {
  const Setting& setting = table.setting;
  const Titles titles(setting.suite);
  const std::vector<std::string> axes = axes_of(setting);
  std::set<std::string> arms;
  for (const Standing& s : table.standings)
    for (const auto& arm : s.in_arm)
      if (axes.empty()) arms.insert(arm.first);
  const MethodStyles styles = styles_of(table);
  Grid grid = grid_of(table, "", title_of(table));
  for (const NamedStanding& s : table.standings) {
    add_row(grid, s);
    put(grid, "rank", 'r', rank_span(s));
    put(grid, "method", 'l', named_cell(s));
    grid.rows.back().cells.back().style = s.is_reference() ? MethodStyle() : styles(s.name);
    put(grid, axes.empty() ? success_word(setting) : "area", 'r',
        score_button(s, (first_row + table.row(s)) * scenarios_of_a_row));
    if (s.each) put(grid, "success per episode", 'r', Span::number(fixed(s.each->score)));
    put(grid, "policy", 'l', Span(s.policy));
    if (setting.demonstrations.size() > 1)
      for (const int n : setting.demonstrations) {
        const auto at = s.at.count(n) ? s.at.find(n) : s.at.find(0);
        put(grid, fmt::format("n = {}", n), 'r',
            at == s.at.end() ? TableCell("") : TableCell(Span::number(fixed(at->second))));
      }
    if (table.track.kind == Track::abstraction) {
      put(grid, "where it decides", 'r', rate_if_any(s.in_track));
      put(grid, "gap closed", 'r', rate_if_any(s.gap_closed));
    }
    if (!axes.empty()) {
      const double control = control_success(*s.entry);
      put(grid, "control", 'r', rate_if_any(control));
      put(grid, "of the control", 'r', rate_if_any(control > 0 ? std::optional(s.score / control) : std::nullopt));
    }
    for (const std::string& axis : axes) put(grid, titles.arm(axis), 'r', rate_if_any(s.areas.at(axis)));
    if (arms.size() > 1)
      for (const std::string& arm : arms) put(grid, titles.arm(arm), 'r', rate_if_any(s.in_arm.at(arm)));
    if (table.undisputed)
      put(grid, titles.arm(table.undisputed->main.arm) + ", undisputed", 'r',
          rate_if_any(success(*table.undisputed, *s.entry)));
    put(grid, "known", 'r',
        document::Spans{Span(tier_and_marks(s)), Span(" " + replayed_on(*s.entry), document::Emphasis::detail)});
  }
  drop_empty_columns(grid);
  return grid;
}

// What rows are based on and what they cost, when they were computed and replayed, and by whom.
Grid details_grid(const NamedTable& table) {
  Grid grid = grid_of(table, "_details", title_of(table) + ": answers, costs, dates and sources");
  for (const NamedStanding& s : table.standings) {
    const Json& score = s.entry->score;
    const auto cost = [&s](double value) { return Span::number(s.is_reference() ? "–" : amount(value)); };
    add_row(grid, s);
    put(grid, "method", 'l', named_cell(s));
    put(grid, "policy", 'l', Span(s.policy));
    put(grid, "answers", 'l', Span(answers_label(*s.entry)));
    put(grid, "answers exact", 'r', Span::number(score.is_null() ? "–" : fixed(scenes_exact(score))));
    put(grid, "φ̂ precision", 'r', rate_if_any(s.precision));
    put(grid, "φ̂ recall", 'r', rate_if_any(s.recall));
    const auto cells = static_cast<int>(s.entry->cells.size()) - s.failed_cells;
    put(grid, "questions", 'r',
        s.cells_not_asked == 0       ? cost(s.lm_queries)
        : s.cells_not_asked == cells ? Span("not asked")
                                     : Span(fmt::format("{}, in part not asked", amount(s.lm_queries))));
    put(grid, "tokens", 'r', cost(s.lm_tokens));
    put(grid, "training s", 'r', cost(s.learn_s));
    put(grid, "computed", 'l', Span(computed_on(*s.entry)));
    put(grid, "replayed", 'l', Span(replayed_on(*s.entry)));
    put(grid, "source", 'l', source_span(*s.entry));
    put(grid, "by", 'l', by_span(*s.entry));
    put(grid, "id", 'l', id_span(*s.entry));
  }
  drop_empty_columns(grid);
  return grid;
}

// The best entries along the demonstrations.
Chart curve_chart(const NamedTable& table) {
  Chart chart;
  const std::vector<int>& demonstrations = table.setting.demonstrations;
  chart.title = statistics::capital(success_word(table.setting)) + " against the number of demonstrations";
  chart.subtitle = fmt::format("mean over {} scenarios; each method's best rows", table.setting.scenarios.size());
  chart.axis = "demonstrations";
  chart.alternative = chart.title + ", as in the table's columns";
  const double pad = .08 * (demonstrations.back() - demonstrations.front());
  chart.left = demonstrations.front() - pad;
  chart.right = demonstrations.back() + pad;
  for (const int n : demonstrations) chart.ticks.push_back({static_cast<double>(n), std::to_string(n)});
  const MethodStyles styles = styles_of(table);
  std::size_t drawn = 0;
  for (const NamedStanding& s : table.standings) {
    if (!s.is_reference() && (s.more || ++drawn > curves)) continue;
    const std::string name = s.full_name();
    Series series{s.is_reference() ? Series::reference : Series::measured, name, styles(s.name), true};
    for (const int n : demonstrations)
      if (const auto at = s.at.count(n) ? s.at.find(n) : s.at.find(0); at != s.at.end()) {
        const double rate = at->second;
        series.points.push_back(
            {static_cast<double>(n), rate, rate, rate, fmt::format("{} at {}: {}", name, n, fixed(rate))});
      }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

// Which scenarios an entry can do: a colour for each.
Grid heat_grid(const NamedTable& table, std::size_t first_row) {
  const Titles titles(table.setting.suite);
  Grid grid = grid_of(table, "_scenarios",
                      axes_of(table.setting).empty()
                          ? fmt::format("{} in each scenario, over all arms and numbers of demonstrations",
                                        statistics::capital(success_word(table.setting)))
                          : "Area in each scenario, over its axes and numbers of demonstrations");
  for (const NamedStanding& s : table.standings) {
    std::size_t number = (first_row + table.row(s)) * scenarios_of_a_row;
    add_row(grid, s);
    put(grid, "method", 'l', named_cell(s));
    put(grid, "policy", 'l', Span(s.policy));
    for (const Setting::Scenario& scenario : table.setting.scenarios) {
      const auto rate = s.in_scenario.find(scenario.id);
      ++number;
      if (rate == s.in_scenario.end()) continue;  // the second of two scenarios that make the pairs
      const std::string other = scenario.pair.empty() || scenario.pair == scenario.id ? "" : " + " + scenario.pair;
      put(grid, titles.scenario(scenario.id + other), 'r', rate_button(fixed(rate->second), rate->second, number));
    }
  }
  return grid;
}

}  // namespace

Grid grid_of(const NamedTable& table, const std::string& what, std::string caption) {
  Grid grid;
  grid.name = table.setting.name() + what;
  grid.caption = std::move(caption);
  return grid;
}

void add_row(Grid& grid, const NamedStanding& s) { grid.rows.push_back({{}, {}, s.is_reference(), s.more}); }

std::vector<NamedTable> named_tables(const std::vector<const Entry*>& table, const Labels& labels,
                                     const Tracks& tracks) {
  const Setting& setting = table.front()->setting;
  const Track track = track_of(tracks, setting);
  std::vector<NamedTable> all;
  for (const Ranking ranking : rankings_of(track)) {
    const std::vector<Standing> standing = standings(table, track, ranking);
    if (!all.empty() && std::none_of(standing.begin(), standing.end(), [](const Standing& s) { return s.rank; }))
      continue;
    NamedTable& one = all.emplace_back();
    one.setting = setting;
    one.track = track;
    one.ranking = ranking;
    if (track.kind == Track::abstraction) one.undisputed = undisputed_of(setting);
    one.steps = steps_of(standing, track, one.undisputed);
    if (one.steps && setting.demonstrations.size() > 1)
      for (const int n : setting.demonstrations)
        if (auto steps = n == one.steps->column.demonstrations ? one.steps : steps_of(standing, track, {}, n))
          one.curve.push_back(std::move(*steps));
    one.standings = named(standing, labels);
    mark_more(one.standings);
    if (all.size() > 1) continue;
    one.waiting = named(not_yet_replayed(table), labels);
    one.withdrawn = static_cast<int>(table.size() - one.standings.size() - one.waiting.size());
  }
  return all;
}

std::string title_of(const NamedTable& table) {
  return fmt::format("{}, {}", Titles(table.setting.suite).suite(), to_string(table.ranking));
}

std::string with_preset(const std::string& title, const NamedTable& table, const std::vector<NamedTable>& tables) {
  const auto alike = std::count_if(tables.begin(), tables.end(),
                                   [&table](const NamedTable& one) { return one.ranking == table.ranking; });
  if (alike < 2) return title;
  std::string preset = table.setting.preset;
  std::replace(preset.begin(), preset.end(), '_', ' ');
  return fmt::format("{}, {}", title, preset);
}

std::string section_title(const NamedTable& table, const std::vector<NamedTable>& tables) {
  return with_preset(statistics::capital(to_string(table.ranking)), table, tables);
}

document::Document suite_document(const std::string& suite, const std::vector<NamedTable>& tables) {
  Document document;
  const Setting& setting = tables.front().setting;
  document.suite = suite;
  document.title = "lgabench leaderboard: " + Titles(suite).suite();
  document.question = statistics::about_suite(suite).question;
  document.description = document.question.empty() ? "Published results of lgabench." : document.question;
  document.headline = {
      Span::link("All suites", "index.html"),
      fmt::format(". {} is the mean over scenarios of the share of {}, over all arms and numbers of "
                  "demonstrations. A click on a number shows the episodes behind it, two of them as "
                  "pictures.",
                  statistics::capital(success_word(setting)),
                  setting.paired() ? "scenes in which both commands of a pair end right" : "successful episodes")};
  std::size_t first_row = 0, number = 0;
  for (const NamedTable& table : tables) {
    const std::string id = fmt::format("table{}", ++number);
    Section section{id, section_title(table, tables)};
    section.add<Paragraph>(reading, {{what_was_played(table.setting) + " " + words_of(table.ranking, &table.track)}});
    if (!axes_of(table.setting).empty())
      section.add<Paragraph>(
          reading,
          {{"The area is what entries are compared by: the mean success from the control to an axis’ last level, "
            "averaged over axes and scenarios. \"Of the control\" divides it by the success in the control; 1 means no "
            "loss. "
            "Each axis has its own column. The best constant action loses nothing because it has little to lose; "
            "compare its control."}});
    if (!table.standings.empty()) section.add<Grid>(reading, standings_grid(table, first_row));
    if (auto note = below_random_note(table.standings)) section.add<Paragraph>(reading, std::move(*note));
    if (table.undisputed) section.add<Paragraph>(reading, {{words_of(*table.undisputed)}});
    if (!table.standings.empty())
      section.add<Grid>(reading, details_grid(table), "Answers, costs, dates and sources of these rows");
    if (auto waiting = waiting_grid(table)) section.add<Grid>(reading, std::move(*waiting));
    if (table.withdrawn > 0)
      section.add<Paragraph>(reading,
                             {{fmt::format("{} entries were withdrawn; their files remain.", table.withdrawn)}});
    document.sections.push_back(std::move(section));
    if (table.ranking != Ranking::papers_network)
      if (auto answers = answers_section(table, id + "-answers")) document.sections.push_back(std::move(*answers));
    if (table.standings.empty()) continue;
    if (table.steps) {
      Section added{id + "-steps", "What labels, the command and the truth add"};
      added.add<Grid>(reading, steps_grid(*table.steps, suite, table.setting.name() + "_steps"));
      if (!table.curve.empty())
        added.add<Grid>(reading, curve_grid(table.curve, suite, table.setting.name() + "_curve"));
      added.add<Paragraph>(reading,
                           {{fmt::format("{} Brackets: 95 % intervals over test scenes and training seeds of these "
                                         "scenarios, and over other scenarios as well.",
                                         statistics::words_of_steps)}});
      document.sections.push_back(std::move(added));
    }
    if (table.setting.demonstrations.size() > 1) {
      Section curve{id + "-curves", "Demonstrations"};
      curve.add<Charts>(on_page, {{curve_chart(table)}});
      document.sections.push_back(std::move(curve));
    }
    Section heat{id + "-scenarios", "Scenarios"};
    heat.add<Grid>(reading, heat_grid(table, first_row));
    document.sections.push_back(std::move(heat));
    first_row += table.standings.size();
  }
  document.sections.push_back(words_of_the_board());
  return document;
}

}  // namespace lgabench::leaderboard

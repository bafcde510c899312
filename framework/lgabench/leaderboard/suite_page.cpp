#include <lgabench/leaderboard/suite_page.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include <lgabench/core/base64.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/rounding.hpp>
#include <lgabench/core/shell.hpp>
#include <lgabench/leaderboard/answer_score.hpp>
#include <lgabench/leaderboard/answers_page.hpp>
#include <lgabench/leaderboard/areas.hpp>
#include <lgabench/leaderboard/verification.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/report/about_suite.hpp>
#include <lgabench/report/names.hpp>
#include <lgabench/report/tables.hpp>

namespace lgabench::leaderboard {
namespace {

using report::Chart;
using report::Charts;
using report::display_name;
using report::Document;
using report::Grid;
using report::MethodStyle;
using report::MethodStyles;
using report::on_page;
using report::Paragraph;
using report::reading;
using report::Section;
using report::Series;
using report::Span;
using report::TableCell;

constexpr std::size_t scenarios_of_a_row = 1000;  // data-row: the standing's number times this, and its scenario's + 1
constexpr std::size_t curves = 8;                 // more would hide each other

constexpr int score_digits = 3;

std::string amount(double value) { return value == 0 ? "–" : fixed(value, value < 10 ? 1 : 0); }
std::string interval_text(const Standing& s) {
  return fmt::format(" [{}, {}]", fixed(s.interval.low, score_digits), fixed(s.interval.high, score_digits));
}

// Names of a table's rows: the id, and those options, at every row that has them, by which two rows of one method
// differ (one row's default is another's variant); then what else tells them apart.
struct Names {
  std::vector<std::string> names, labels;
};
Names names_of(const std::vector<Standing>& all, const Labels& words) {
  std::map<std::pair<std::string, std::string>, std::set<Json>> values;  // by id and option
  for (const Standing& s : all)
    for (const auto& [option, value] : s.entry->identity.row.options.items())
      values[{s.entry->identity.row.own_name(), option}].insert(value);
  for (const Standing& s : all)  // an option that came later is not among a row's where it has its default
    for (auto& [key, different] : values)
      if (key.first == s.entry->identity.row.own_name() && !s.entry->identity.row.options.contains(key.second))
        different.insert(Json());
  std::set<std::string> telling;
  for (const auto& [key, different] : values)
    if (different.size() > 1) telling.insert(key.second);
  const std::vector<std::string> options(telling.begin(), telling.end());
  std::vector<std::string> names, labels;
  std::map<std::string, int> times, labelled;
  for (const Standing& s : all) {
    const Identity& identity = s.entry->identity;
    std::string name = identity.row.own_name();
    for (const auto& [option, value] : identity.row.options.items())
      if (telling.count(option) > 0) name += fmt::format("+{}={}", option, option_text(value));
    names.push_back(name);
    ++times[name];
    labels.push_back(label_of(words, *s.entry, options));
    ++labelled[labels.back()];
  }
  for (std::size_t i = 0; i < names.size(); ++i)
    if (times[names[i]] > 1) {
      const Identity& identity = all[i].entry->identity;
      names[i] +=
          fmt::format("+version={}+answers={}+engine={}+id={}", identity.row.version,
                      to_string(identity.answers).substr(0, 20), identity.engine, all[i].entry->id().substr(0, 6));
    }
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (labelled[labels[i]] > 1)
      labels[i] += fmt::format(", version {}, {}", all[i].entry->identity.row.version, all[i].entry->id().substr(0, 6));
  return {names, labels};
}

// Whether each is the first of its method: the best, as rows stand by rank and success. Each file of answers that
// somebody submits competes for itself.
std::vector<bool> best_of(const std::vector<Standing>& all) {
  std::set<std::string> known;
  std::vector<bool> best;
  for (const Standing& s : all) {
    const std::string answers = s.entry->has_answers_as_submitted() ? s.entry->identity.answers_sha256 : "";
    best.push_back(known.insert(s.entry->identity.row.own_name() + " " + answers).second);
  }
  return best;
}

// What a row is called; its options under the pointer.
TableCell named_cell(const NamedTable& table, std::size_t i) {
  Span name(table.labels[i]);
  if (const std::string options = display_name(table.names[i]); options != name.text) name.title = options;
  return name;
}

TableCell rate_button(const std::string& text, double rate, std::size_t row) {
  TableCell cell(Span::number(text));
  cell.rate = rate;
  cell.episodes = row;
  return cell;
}

// Success, its interval small beside it.
TableCell score_button(const Standing& s, std::size_t row) {
  TableCell cell = rate_button(fixed(s.score, score_digits), s.score, row);
  if (s.below_random) cell.spans.push_back(below_random_mark());
  cell.spans.push_back(Span::number(interval_text(s), "", report::Emphasis::detail));
  return cell;
}

// The table, with a column for each number of demonstrations, and for each arm where there are several.
Grid standings_grid(const NamedTable& table, std::size_t first_row) {
  const Setting& setting = table.setting;
  const std::vector<std::string> axes = axes_of(setting);
  std::set<std::string> arms;
  for (const Standing& s : table.standings)
    for (const auto& arm : s.in_arm)
      if (axes.empty()) arms.insert(arm.first);
  Grid grid;
  grid.name = setting.name();
  grid.caption = title_of(setting);
  grid.heads = {"rank", "entry", axes.empty() ? "success" : "area"};
  const std::vector<int> numbers = setting.demonstrations.size() > 1 ? setting.demonstrations : std::vector<int>();
  for (const int n : numbers) grid.heads.emplace_back(fmt::format("n = {}", n));
  const bool selects = table.track.kind == Track::abstraction;
  if (selects)
    for (const char* head : {"where it decides", "gap closed"}) grid.heads.emplace_back(head);
  if (!axes.empty())
    for (const char* head : {"control", "of the control"}) grid.heads.emplace_back(head);
  grid.heads.insert(grid.heads.end(), axes.begin(), axes.end());
  if (arms.size() > 1)
    for (const std::string& arm : arms) grid.heads.emplace_back(arm);
  for (const char* head : {"answers exact", "φ̂ precision", "φ̂ recall", "questions", "tokens", "training s", "tier"})
    grid.heads.emplace_back(head);
  grid.align = "rl" + std::string(grid.heads.size() - 2, 'r');
  const MethodStyles styles(table.names);
  for (std::size_t i = 0; i < table.standings.size(); ++i) {
    const Standing& s = table.standings[i];
    const bool reference = s.entry->identity.row.is_reference();
    TableCell name = named_cell(table, i);
    name.style = reference ? MethodStyle() : styles(table.names[i]);
    Grid::Row row{
        {}, {Span::number(rank_text(s)), name, score_button(s, (first_row + i) * scenarios_of_a_row)}, reference};
    for (const int n : numbers) {
      const auto at = s.at.count(n) ? s.at.find(n) : s.at.find(0);
      row.cells.emplace_back(at == s.at.end() ? TableCell("") : TableCell(Span::number(fixed(at->second))));
    }
    if (selects)
      for (const auto& value : {s.in_track, s.gap_closed})
        row.cells.emplace_back(Span::number(value ? fixed(*value) : "–"));
    if (!axes.empty()) {
      const double control = control_success(*s.entry);
      row.cells.emplace_back(Span::number(fixed(control)));
      row.cells.emplace_back(Span::number(control > 0 ? fixed(s.score / control) : "–"));
    }
    for (const std::string& axis : axes) {
      const std::optional<double>& area = s.areas.at(axis);
      row.cells.emplace_back(Span::number(area ? fixed(*area) : "–"));
    }
    if (arms.size() > 1)
      for (const std::string& arm : arms) row.cells.emplace_back(Span::number(fixed(s.in_arm.at(arm))));
    const Json& score = s.entry->score;
    row.cells.emplace_back(Span::number(score.is_null() ? "–" : fixed(scenes_exact(score))));
    for (const auto& part : {s.precision, s.recall}) row.cells.emplace_back(Span::number(part ? fixed(*part) : "–"));
    for (const double value : {s.lm_queries, s.lm_tokens, s.learn_s})
      row.cells.emplace_back(Span::number(reference ? "–" : amount(value)));
    row.cells.emplace_back(tier_and_marks(s));
    row.more = !table.best[i];
    grid.rows.push_back(std::move(row));
  }
  // A column without a value in any row says nothing.
  for (std::size_t k = grid.heads.size(); k-- > 3;) {
    if (!std::all_of(grid.rows.begin(), grid.rows.end(),
                     [k](const Grid::Row& row) { return row.cells[k].text() == "–"; }))
      continue;
    const auto at = static_cast<std::ptrdiff_t>(k);
    grid.heads.erase(grid.heads.begin() + at);
    grid.align.erase(k, 1);
    for (Grid::Row& row : grid.rows) row.cells.erase(row.cells.begin() + at);
  }
  return grid;
}

// The best entries along the demonstrations.
Chart curve_chart(const NamedTable& table) {
  Chart chart;
  const std::vector<int>& demonstrations = table.setting.demonstrations;
  chart.title = "Success against the number of demonstrations";
  chart.subtitle = fmt::format("mean over {} scenarios; the best row of each method, and reference rows",
                               table.setting.scenarios.size());
  chart.axis = "demonstrations";
  chart.alternative = chart.title + ", as in the table's columns";
  const double pad = .08 * (demonstrations.back() - demonstrations.front());
  chart.left = demonstrations.front() - pad;
  chart.right = demonstrations.back() + pad;
  for (const int n : demonstrations) chart.ticks.push_back({static_cast<double>(n), std::to_string(n)});
  const MethodStyles styles(table.names);
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < table.standings.size(); ++i) {
    const Standing& s = table.standings[i];
    const bool reference = s.entry->identity.row.is_reference();
    if (!reference && (!table.best[i] || ++drawn > curves)) continue;
    const std::string& name = table.labels[i];
    Series series{reference ? Series::reference : Series::measured, name, styles(table.names[i]), true};
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
  Grid grid;
  grid.name = table.setting.name() + "_scenarios";
  grid.caption = axes_of(table.setting).empty()
                     ? "Success in each scenario, over all arms and numbers of demonstrations"
                     : "Area in each scenario, over its axes and numbers of demonstrations";
  grid.heads = {"entry"};
  for (const Setting::Scenario& scenario : table.setting.scenarios) {
    std::string words = scenario.id;
    std::replace(words.begin(), words.end(), '_', ' ');
    grid.heads.emplace_back(words);
  }
  grid.align = "l" + std::string(table.setting.scenarios.size(), 'r');
  for (std::size_t i = 0; i < table.standings.size(); ++i) {
    const Standing& s = table.standings[i];
    Grid::Row row{{}, {named_cell(table, i)}, s.entry->identity.row.is_reference(), !table.best[i]};
    for (std::size_t k = 0; k < table.setting.scenarios.size(); ++k) {
      const double rate = s.in_scenario.at(table.setting.scenarios[k].id);
      row.cells.push_back(rate_button(fixed(rate), rate, (first_row + i) * scenarios_of_a_row + k + 1));
    }
    grid.rows.push_back(std::move(row));
  }
  return grid;
}

// Successes of all cells, in the order of places, arms and episodes, eight to a byte, the first in its highest bit.
std::string success_bits(const Entry& entry) {
  std::string bytes;
  std::size_t bit = 0;
  for (const PlayedCell& cell : entry.cells)
    for (const std::string& arm : entry.setting.scenario(cell.place.scenario).arms)
      for (const char letter : cell.outcomes.at(arm)) {
        if (bit % 8 == 0) bytes.push_back('\0');
        if (is_success(letter)) bytes.back() = static_cast<char>(bytes.back() | (0x80 >> bit % 8));
        ++bit;
      }
  return base64(bytes);
}

std::string command_of(const Entry& entry) {
  const Identity& identity = entry.identity;
  std::vector<std::string> words{"lgabench",           "run",       entry.setting.suite, "--preset",
                                 entry.setting.preset, "--engines", identity.engine};
  if (!identity.row.is_reference()) words.insert(words.end(), {"--methods", entry.spec(), "--no-reference"});
  const std::string kept = answers_file(identity).string();
  words.insert(words.end(), {"--answers", kept.empty() ? to_string(identity.answers)
                                          : std::holds_alternative<FileAnswers>(identity.answers)
                                              ? kept
                                              : to_string(CassetteAnswers{kept})});
  return shell_line(words);
}

}  // namespace

NamedTable named_table(const std::vector<const Entry*>& table, const Labels& labels, const Tracks& tracks) {
  const Setting& setting = table.front()->setting;
  const Track track = track_of(tracks, setting);
  NamedTable named{setting, standings(table, track), {}, {}, {}, not_yet_replayed(table), {}, 0, track};
  Names names = names_of(named.standings, labels);
  named.names = std::move(names.names);
  named.labels = std::move(names.labels);
  named.best = best_of(named.standings);
  named.waiting_labels = names_of(named.waiting, labels).labels;
  named.withdrawn = static_cast<int>(table.size() - named.standings.size() - named.waiting.size());
  return named;
}

std::string title_of(const Setting& setting) { return fmt::format("{}, preset {}", setting.suite, setting.preset); }

std::string what_was_played(const Setting& setting) {
  return fmt::format(
      "{} scenarios, {} demonstrations, {} training seeds, {} test scenes of each arm and {}; scene seed {}, preset "
      "{}.",
      setting.scenarios.size(), fmt::join(setting.demonstrations, ", "), setting.seeds.size(), setting.episodes,
      setting.test_scenes == TestScenes::per_seed ? "training seed" : "scenario", setting.scene_seed,
      hash(setting).substr(0, 8));
}

std::string rank_text(const Standing& standing) { return standing.rank ? std::to_string(*standing.rank) : "–"; }

std::string tier_and_marks(const Standing& s) {
  std::vector<std::string> words{to_string(s.entry->tier())};
  if (!s.not_ranked.empty() && !s.entry->identity.row.is_reference()) words.push_back(s.not_ranked);
  if (s.entry->has_answers_as_submitted() && s.not_ranked != as_submitted) words.emplace_back(as_submitted);
  const std::string confined = s.entry->evidence.front().at("confinement");
  if (confined.rfind("Landlock ", 0) != 0 || confined.find("no ") != std::string::npos)
    words.emplace_back("unconfined");
  else if (confined.find("without") != std::string::npos)
    words.emplace_back("partly confined");
  if (s.failed_cells > 0) words.push_back(fmt::format("{} cells failed", s.failed_cells));
  if (s.entry->fresh() > 0) words.emplace_back("fresh");
  for (std::string& claim : claims(*s.entry)) words.push_back(std::move(claim));
  return fmt::format("{}", fmt::join(words, "; "));
}

std::string score_text(const Standing& standing) {
  return fixed(standing.score, score_digits) + interval_text(standing);
}

Span below_random_mark() {
  const auto mark = std::find_if(report::table_marks.begin(), report::table_marks.end(), [](const report::Mark& one) {
    return one.word == std::string_view("below_random_object");
  });
  Span span(mark->sign);
  span.title = mark->meaning;
  return span;
}

std::optional<Paragraph> below_random_note(const std::vector<Standing>& standings) {
  if (std::none_of(standings.begin(), standings.end(), [](const Standing& s) { return s.below_random; })) return {};
  const Span mark = below_random_mark();
  return Paragraph{{mark, " " + mark.title + "."}};
}

std::optional<Grid> waiting_grid(const NamedTable& table, const fs::path& board) {
  if (table.waiting.empty()) return {};
  Grid grid;
  grid.name = table.setting.name() + "_waiting";
  grid.caption = title_of(table.setting) + ", not yet replayed";
  grid.heads = {"not yet replayed", "claimed success", "known", "by", "id"};
  grid.align = "lrlll";
  for (std::size_t i = 0; i < table.waiting.size(); ++i) {
    const Standing& s = table.waiting[i];
    grid.rows.push_back({{},
                         {TableCell(Span(table.waiting_labels[i])), Span::number(fixed(s.score, score_digits)),
                          Span(tier_and_marks(s)), Span(s.entry->about.at("by").get<std::string>()),
                          Span::link(s.entry->id(), (board / s.entry->place() / "entry.json").string())},
                         false});
  }
  return grid;
}

Section words_of_the_board() {
  Section section{"words", "What the words mean"};
  section.add<report::Facts>(
      reading,
      {{{"rank",
         "1 plus the number of entries that are significantly better (paired test on these scenes, Holm’s "
         "correction). Two entries of one rank have as many better ones; it does not say that they are equal."},
        {"reference rows",
         "not methods: the same action everywhere, any visible object, the expert that demonstrates. "
         "They stand where their success puts them, and have no rank."},
        {"§", "below the random visible object, which needs no demonstration."},
        {"recomputed", "the numbers follow from the entry’s files; nothing was played again."},
        {"replayed",
         "a maintainer’s build played some of its cells again, chosen by bits drawn after it was written, "
         "and got the same."},
        {"reproduced", "so did another person, on another machine."},
        {"fresh", "played on scenes that nobody knew when it was submitted, and no worse there."},
        {"not yet replayed", "what the files of an entry claim; nobody has played it again, and it has no rank."},
        {"claimed by", "somebody says so; the maintainers have not confirmed it."},
        {"answers",
         "whose words say what matters: recorded with the benchmark, a language model’s replies, or a file that the "
         "entry brings."},
        {as_submitted,
         "that file is used as it came. Nobody can ask whoever gave the answers again, and the truth of shipped "
         "commands is public, so the file may be a copy of it: the row has no rank."},
        {"the truth stands in for people",
         "the row needs people’s answers, and was given the true features: an upper "
         "bound, without a rank."},
        {"partly confined, unconfined", "the kernel could not keep the method from some files or calls."},
        {"n = 10", "success with 10 demonstrations."},
        {"training s", "seconds of training of one policy, on the submitter’s machine."}}});
  return section;
}

report::Document suite_document(const std::string& suite, const std::vector<NamedTable>& tables) {
  Document document;
  document.suite = suite;
  document.title = "lgabench leaderboard: " + suite;
  document.question = report::about_suite(suite).question;
  document.headline = {Span::link("All suites", "index.html"),
                       ". Success is the mean over scenarios of the share of successful episodes, over all arms and "
                       "numbers of demonstrations, with its 95 % interval. A click on a number shows the episodes "
                       "behind it."};
  std::size_t first_row = 0, number = 0;
  for (const NamedTable& table : tables) {
    const std::string id = fmt::format("table{}", ++number);
    Section section{id, title_of(table.setting)};
    section.add<Paragraph>(reading, {{what_was_played(table.setting)}});
    section.add<Paragraph>(reading, {{words_of(table.track)}});
    if (!axes_of(table.setting).empty())
      section.add<Paragraph>(
          reading,
          {{"Area: under the curve of success against an axis’ levels, from the control to the last, as the "
            "mean over axes and scenarios; it is what entries are compared by. Of the control: what that is of "
            "the success in the control, and then of each axis alone, where 1 is no loss. The best constant "
            "action keeps all of what it has, which is little: read it beside the control."}});
    if (!table.standings.empty()) section.add<Grid>(reading, standings_grid(table, first_row));
    if (auto note = below_random_note(table.standings)) section.add<Paragraph>(reading, std::move(*note));
    if (auto waiting = waiting_grid(table)) section.add<Grid>(reading, std::move(*waiting));
    if (table.withdrawn > 0)
      section.add<Paragraph>(reading,
                             {{fmt::format("{} entries were withdrawn; their files remain.", table.withdrawn)}});
    document.sections.push_back(std::move(section));
    if (auto answers = answers_section(table, id + "-answers")) document.sections.push_back(std::move(*answers));
    if (table.standings.empty()) continue;
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

Json suite_data(const std::vector<NamedTable>& tables) {
  Json settings = Json::array(), entries = Json::array();
  for (const NamedTable& table : tables) {
    settings.push_back(to_json(table.setting));
    for (std::size_t i = 0; i < table.standings.size(); ++i) {
      const Entry& entry = *table.standings[i].entry;
      Json failed = Json::array(), evidence = Json::array();
      for (std::size_t c = 0; c < entry.cells.size(); ++c)
        if (!entry.cells[c].failed.empty()) failed.push_back({c, entry.cells[c].failed});
      const Json& source = entry.about.at("source");
      entries.push_back(
          {{"table", settings.size() - 1},
           {"name", table.labels[i]},
           {"row", display_name(table.names[i])},
           {"id", entry.id()},
           {"place", entry.place().string()},
           {"learns", learns(entry.identity.row)},
           {"version", entry.identity.row.version},
           {"answers", to_string(entry.identity.answers)},
           {"kept_answers", answers_file(entry.identity).string()},
           {"command", command_of(entry)},
           {"authors", entry.about.at("authors")},
           {"license", entry.about.at("license")},
           {"source",
            source.contains("repository")
                ? source.at("repository").get<std::string>() + " @ " + source.at("commit").get<std::string>()
                : source.at("file").get<std::string>() + ", SHA-256 " + source.at("sha256").get<std::string>()},
           {"program", entry.evidence.front().at("program")},
           {"processor", entry.evidence.front().at("machine").at("processor")},
           {"tier", to_string(entry.tier())},
           {"failed", failed},
           {"successes", success_bits(entry)}});
    }
  }
  return {{"settings", settings}, {"entries", entries}};
}

}  // namespace lgabench::leaderboard

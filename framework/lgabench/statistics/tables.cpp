#include <lgabench/statistics/tables.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <tuple>

#include <lgabench/abstraction/selection_text.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/rounding.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/statistics/names.hpp>

namespace lgabench::statistics {

namespace {

bool any_shift(const Table& table, const Column& column) {
  return std::any_of(table.rows.begin(), table.rows.end(), [&column](const Row& row) {
    return row.arm == column.arm && row.shift && row.demonstrations == column.demonstrations;
  });
}

bool any_ambiguous(const Table& table, const std::string& arm) {
  return std::any_of(table.rows.begin(), table.rows.end(),
                     [&arm](const Row& row) { return row.arm == arm && row.marked("ambiguous"); });
}

// "LGA, Human and GCBC-SEG"
std::string listed(const std::vector<std::string>& methods) {
  std::string text;
  for (std::size_t i = 0; i < methods.size(); ++i)
    text += (i == 0 ? "" : i + 1 == methods.size() ? " and " : ", ") + display_name(methods[i]);
  return text;
}

}  // namespace

std::string command_text(const std::string& utterance, bool seen, bool tell) {
  return utterance + (!tell ? "" : seen ? " (seen)" : " (unseen)");
}

std::vector<View> views(const Table& table) {
  std::vector<View> all;
  const std::vector<int> demonstrations = table.demonstrations();
  if (table.arms.size() == 1) {
    const char* corner = table.demonstrated_commands == 1 ? "demonstrations" : "demonstrations per command";
    View& view = all.emplace_back(View{corner, {}, {}});
    for (const int n : demonstrations) view.columns.push_back({std::to_string(n), table.arms.front(), n});
    return all;
  }
  for (const int n : demonstrations) {
    View& view = all.emplace_back(View{table.demonstrations_text(n), {}, {}});
    for (const std::string& arm : table.arms) view.columns.push_back({table.arm_head(arm), arm, n});
    std::copy_if(view.columns.begin(), view.columns.end(), std::back_inserter(view.shifted),
                 [&table](const Column& column) { return any_shift(table, column); });
  }
  return all;
}

std::vector<Column> View::unperturbed(const Table& table, std::vector<Column> columns) {
  columns.erase(std::remove_if(columns.begin(), columns.end(),
                               [&table](const Column& column) { return table.perturbs(column.arm); }),
                columns.end());
  return columns;
}

std::optional<Column> main_column(const Table& table, const AboutSuite& about) {
  const std::vector<int> all = table.demonstrations();
  if (table.arms.empty() || all.empty()) return {};
  Column column{"", table.arms.back(), all.back()};
  for (const std::string& arm : table.arms)
    if (table.arm_head(arm) == table.arm_title(arm)) column.arm = arm;
  if (contains(table.arms, about.main_arm)) column.arm = about.main_arm;
  if (about.main_demonstrations && contains(all, *about.main_demonstrations))
    column.demonstrations = *about.main_demonstrations;
  return column;
}

const std::vector<RowMark>& table_marks() {
  static const std::vector<RowMark> all = [] {
    std::vector<RowMark> marks;
    for (const ReferenceRow& row : reference_rows())
      if (row.below_it) marks.push_back(*row.below_it);
    marks.insert(
        marks.end(),
        {{"incomplete", "‡", "incomplete: a cell failed, or the mean lacks a scenario"},
         {"method_error", "!", "the method's own code failed in some of the episodes, which count as failures"},
         {"ambiguous", "?", "ambiguous words, by which a person might mean something else: shown, in no mean"},
         {"network", "¶", "reached the network on its own: in no leaderboard"}});
    return marks;
  }();
  return all;
}

std::string marks_text(const Row& row) {
  std::string text;
  for (const RowMark& mark : table_marks())
    if (row.marked(mark.word)) text += mark.sign;
  return text;
}

bool acts_the_same(const Row& row) { return !row.is_reference() && row.shift && row.shift->same_actions; }

bool any_seen(const Table& table) {
  return std::any_of(table.rows.begin(), table.rows.end(), [](const Row& row) { return row.seen_share(); });
}

namespace {

// Why the command's Selection keeps no object; "" where it may, and for what is no Selection.
std::string why_empty(const CommandResult& command) {
  try {
    Selection selection;
    selection.provenance = provenance_from(command.selection.at("provenance"));
    const Json distribution = distribution_of(command.selection);
    for (const auto& [role, json] : distribution.items()) {
      const Meaning meaning = read_unchecked_meaning(JsonReader(json, role));
      if (role == "target")
        selection.target = meaning;
      else
        selection.second = SecondSet{meaning.product(), role};
    }
    return empty_text(selection);
  } catch (const Error&) {
    return "";
  }
}

// "LGA keeps no object in heart; star: the target has no texture.": a row whose Selection is empty.
std::vector<std::string> empty_selections(const RunResults& run) {
  constexpr std::size_t most = 5;
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> all;  // row, why -> commands
  for (const CellResult& cell : run.cells)
    for (const CommandResult& command : cell.commands) {
      if (cell.failed || cell.is_reference()) continue;
      const std::string why = why_empty(command);
      if (why.empty()) continue;
      std::vector<std::string>& commands = all[{cell.method, why}];
      const std::string name =
          cell.scenario + (cell.commands.size() == 1 ? "" : fmt::format(", \"{}\"", command.utterance));
      if (!contains(commands, name)) commands.push_back(name);
    }
  std::vector<std::string> lines;
  for (const auto& [row, commands] : all) {
    if (lines.size() == most) break;
    const auto shown = commands.begin() + static_cast<std::ptrdiff_t>(std::min(commands.size(), most));
    lines.push_back(fmt::format(
        "{} keeps no object in {}{}: {}.", display_name(row.first), fmt::join(commands.begin(), shown, "; "),
        commands.size() > most ? fmt::format("; {} more", commands.size() - most) : "", row.second));
  }
  if (all.size() > most) lines.push_back(fmt::format("{} more rows keep no object somewhere.", all.size() - most));
  return lines;
}

// What the tables' rows and arms have to be told with.
struct Noted {
  std::set<std::string> marked;   // words of marks
  std::set<std::string> same_as;  // arms whose actions another arm repeats
  std::set<std::string> of_some;  // lines on arms that not all scenarios have
  // Name of a row -> whom its Selections measure, where that has to be said.
  std::map<std::string, std::string> people;
  std::set<std::string> models, live;  // behind cassettes, and asked while cells ran
};

void note_arms(const Table& table, Noted& noted) {
  for (const std::string& arm : table.arms)
    if (const auto some = table.scenarios_with(arm); some.size() + 1 < table.scenarios().size())
      noted.of_some.insert(fmt::format(
          "{}: the mean is over {}; {}.", table.arm_head(arm), fmt::join(some, ", "),
          any_ambiguous(table, arm) ? "in the others its words are ambiguous (?)" : "no other scenario has this arm"));
}

void note_selections(const Row& row, Noted& noted) {
  for (const PhiOfCommand& phi : row.phi) {
    if (phi.provenance == "truth" || phi.provenance == "simulated_edit")
      noted.people[row_id(row.method) == "human" ? display_name(true_mask_row) : display_name(row.method)] =
          provenance_words(phi.provenance, phi.erring);
    if (phi.provenance == "cassette") noted.models.insert(phi.source);
    if (phi.provenance == "live") noted.live.insert(phi.source);
  }
}

// Whether the method's Selections began as a language model's.
bool edits(const RunResults& run, const std::string& method) {
  return std::any_of(run.cells.begin(), run.cells.end(),
                     [&method](const CellResult& cell) { return cell.method == method && cell.asks == "edit"; });
}

void note_row(const RunResults& run, const Row& row, Noted& noted) {
  noted.marked.insert(row.marks.begin(), row.marks.end());
  if (acts_the_same(row)) noted.same_as.insert(row.shift->against_title);
  note_selections(row, noted);
  if (row.is_mean() && row.participants > 0)
    noted.people[display_name(row.method)] =
        fmt::format("{} participant{}{}{}", row.participants, row.participants == 1 ? "" : "s",
                    run.rehearsal ? fmt::format(" ({})", rehearsal_words) : "",
                    edits(run, row.method) ? ", who edited a language model's φ̂" : "");
}

}  // namespace

std::vector<std::string> what_it_lacks(const RunResults& run) {
  std::vector<std::string> lines;
  if (run.rehearsal) lines.push_back(fmt::format("{}: not for the leaderboard.", rehearsal_words));
  if (run.not_run > 0)
    lines.push_back(
        fmt::format("{} of {} cells have not run yet: the tables are partial.", run.not_run, run.record.cells.size()));
  if (!run.unreadable.empty())
    lines.push_back(fmt::format("{} of {} cells cannot be read, and were left out.", run.unreadable.size(),
                                run.record.cells.size()));
  if (run.foreign > 0)
    lines.push_back(fmt::format("{} cell directories that run.json does not list were left out.", run.foreign));
  const std::vector<std::string> empty = empty_selections(run);
  lines.insert(lines.end(), empty.begin(), empty.end());
  return lines;
}

std::vector<std::string> notes(const RunResults& run, const Summary& summary) {
  Noted noted;
  for (const Table& table : summary.tables) {
    note_arms(table, noted);
    for (const Row& row : table.rows) note_row(run, row, noted);
  }
  std::vector<std::string> lines;
  if (run.record.smoke) lines.emplace_back("Smoke or limited run: not for the leaderboard.");
  const std::vector<std::string> lacks = what_it_lacks(run);
  lines.insert(lines.end(), lacks.begin(), lacks.end());
  for (const RowMark& mark : table_marks())
    if (noted.marked.count(mark.word) != 0) lines.push_back(fmt::format("{} {}.", mark.sign, mark.meaning));
  for (const std::string& arm : noted.same_as) lines.push_back(fmt::format("= the same actions as in {}.", arm));
  lines.insert(lines.end(), noted.of_some.begin(), noted.of_some.end());
  for (const auto& [name, who] : noted.people) lines.push_back(fmt::format("{}: {}.", name, who));
  for (const Table& table : summary.tables)
    if (const auto& near = table.nearness)
      lines.push_back(
          fmt::format("Beside the paper, {}, {}: {} of {} points of {} lie within 1.5 of its error bars; the mean "
                      "distance is {}.",
                      table.title(), table.title(mean_scenario), near->near, near->points, listed(near->methods),
                      fixed(near->mean_distance, 3)));
  for (const std::string& model : noted.models)
    lines.push_back(fmt::format("Language model: {}, its replies played from a cassette.", model));
  for (const std::string& model : noted.live)
    lines.push_back(fmt::format("Language model: {}, asked during the run; its replies are in answers/.", model));
  return lines;
}

std::vector<MethodError> method_errors(const RunResults& run) {
  struct Errors {
    int episodes = 0, errors = 0;
    const CellResult* first = nullptr;
  };
  std::map<std::string, Errors> all;  // by the row's name
  for (const CellResult& cell : run.cells) {
    if (cell.is_reference()) continue;
    Errors& row = all[cell.method];
    for (const auto& arm : cell.episodes)
      for (const Episode& e : arm.second) {
        ++row.episodes;
        if (e.failure != "method_error") continue;
        ++row.errors;
        if (!row.first) row.first = &cell;
      }
  }
  std::vector<MethodError> found;
  for (const auto& [method, row] : all)
    if (row.first)
      found.push_back(
          {fmt::format("{} of {} episodes of {} are method_error: {}", row.errors, row.episodes, display_name(method),
                       row.first->method_error.empty() ? "no reason is recorded" : row.first->method_error),
           (fs::path("cells") / row.first->key / cell_file::log).string()});
  return found;
}

std::vector<PhaseTimes> phase_times(const RunResults& run) {
  std::map<std::tuple<std::string, std::string, int, std::string>, PhaseTimes> all;  // layout, engine, rank, method
  for (const CellResult& cell : run.cells) {
    if (cell.failed) continue;
    PhaseTimes& times = all[{cell.layout, cell.engine, display_rank(cell.method), cell.method}];
    times.layout = cell.layout;
    times.engine = cell.engine;
    times.method = cell.method;
    ++times.cells;
    for (std::size_t i = 0; i < phases().size(); ++i) times.mean_s[i] += cell.timing.at(phases()[i]).get<double>();
  }
  std::vector<PhaseTimes> list;
  for (auto& item : all) {
    for (double& s : item.second.mean_s) s /= item.second.cells;
    list.push_back(item.second);
  }
  return list;
}

std::vector<PhiOfRow> distinct_phi(const Summary& summary) {
  std::set<std::string> shown;
  std::vector<PhiOfRow> all;
  for (const Table& table : summary.tables)
    for (const Row& row : table.rows)
      for (std::size_t i = 0; i < row.phi.size(); ++i)
        if (shown.insert(row.scenario + '\n' + row.method + '\n' + canonical(to_json(row.phi[i]))).second)
          all.push_back({&row, i});
  return all;
}

bool has_unseen(const RunResults& run) {
  return std::any_of(run.cells.begin(), run.cells.end(), [](const CellResult& cell) {
    return std::any_of(cell.commands.begin(), cell.commands.end(), [](const auto& c) { return !c.seen; });
  });
}

}  // namespace lgabench::statistics

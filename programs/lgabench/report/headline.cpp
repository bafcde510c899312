#include <lgabench/report/headline.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include <lgabench/document/writers.hpp>
#include <lgabench/record/reference_rows.hpp>
#include <lgabench/report/sections.hpp>
#include <lgabench/statistics/claims_field.hpp>
#include <lgabench/statistics/pairs.hpp>
#include <lgabench/statistics/settings.hpp>
#include <lgabench/statistics/tables.hpp>

namespace lgabench::report {
namespace {

constexpr std::size_t most_others = 3;  // beside the random visible object

// Of a table's methods the `most` that a reader would compare the first one with: those that the paper does not have,
// then its baselines.
std::vector<std::string> most_compared(const std::vector<std::string>& methods, std::size_t most) {
  if (methods.empty()) return {};
  std::vector<std::string> others(methods.begin() + 1, methods.end());
  const auto rank = [](const std::string& row) {
    constexpr std::array order{"gcbc_seg", "human", "gcbc_dart", "lga_s", "lga_l", "lga_hill"};
    const std::string id = row.substr(0, row.find('+'));
    const auto found = std::find(order.begin(), order.end(), id);
    return found == order.end() ? -1 : found - order.begin();
  };
  std::stable_sort(others.begin(), others.end(),
                   [&](const std::string& a, const std::string& b) { return rank(a) < rank(b); });
  if (others.size() > most) others.resize(most);
  return others;
}

std::optional<Change> against_method(const Material& material, const Table& table, const std::string& first,
                                     const std::string& other, const Column& column, bool paired) {
  Field field;
  for (const CellResult& cell : material.run.cells)
    if (cell.layout == table.layout && cell.engine == table.engine && (cell.method == first || cell.method == other))
      field.add(cell);
  if (!field.find(first, column.demonstrations) || !field.find(other, column.demonstrations)) return {};
  return measured_rows(field, "headline", first, other, column.arm, column.demonstrations, paired).these.change;
}

// The reference row learns nothing: each policy is paired with the reference in the same scenes.
std::optional<Change> against_random(const Material& material, const Table& table, const std::string& first,
                                     const Column& column) {
  PairedRow pairs;
  for (const CellResult& cell : material.run.cells) {
    if (cell.method != first || cell.demonstrations != column.demonstrations || cell.layout != table.layout ||
        cell.engine != table.engine || !has_arm(cell, column.arm))
      continue;
    const auto same = std::find_if(material.run.cells.begin(), material.run.cells.end(), [&](const CellResult& other) {
      return other.id == random_object && !other.failed && other.scenario == cell.scenario &&
             other.layout == cell.layout && other.engine == cell.engine && has_arm(other, column.arm) && !cell.failed &&
             why_unpaired(other, cell, column.arm).empty();
    });
    if (cell.failed || same == material.run.cells.end()) return {};
    pairs.add(cell.scenario, pair_policies(*same, cell, column.arm), cell.participant);
  }
  if (pairs.policies() == 0) return {};
  return pairs.change(
      fmt::format("headline/{}/{}/{}/{}/{}", table.layout, table.engine, first, column.arm, column.demonstrations));
}

// "counting labels adds 0.20 [0.14, 0.26], reading the command adds 0.18 [0.15, 0.21] and the true mask adds 0.17
// [0.15, 0.20]"
Spans steps_sentence(const Steps& of) {
  Spans spans;
  const std::vector<Step>& steps = of.steps;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Interval& interval = steps[i].interval;
    const char* const joined = i == 0 ? "" : i + 1 < steps.size() ? ", " : " and ";
    spans.emplace_back(fmt::format("{}{} ", joined, of.played[i + 1].stage->adds));
    spans.push_back(Span::number(fixed(steps[i].difference), "", Emphasis::strong));
    spans.push_back(
        Span::number(fmt::format(" [{}, {}]", fixed(interval.low), fixed(interval.high)), "", Emphasis::detail));
  }
  return spans;
}

// "the true mask" for the name of a row that is a thing.
std::string in_a_sentence(std::string name) {
  if (name.rfind(display_name(true_mask_row), 0) != 0) return name;
  name.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(name.front())));
  return "the " + name;
}

void add_difference(Spans& spans, const Change& change, const std::string& other, const char* before) {
  const bool less = change.difference < 0;
  const Interval low_high = less ? Interval{-change.interval.high, -change.interval.low} : change.interval;
  spans.emplace_back(before);
  spans.push_back(Span::number(fixed(std::abs(change.difference)), "", Emphasis::strong));
  spans.push_back(
      Span::number(fmt::format(" [{}, {}]", fixed(low_high.low), fixed(low_high.high)), "", Emphasis::detail));
  spans.emplace_back(fmt::format(" {} {}", less ? "less than" : "more than", other));
}

}  // namespace

Spans headline(const Material& material, const AboutSuite& about) {
  if (material.summary.tables.empty()) return {};
  const Table table = material.summary.tables.front().without_errors();
  const std::optional<Column> column = main_column(table, about);
  if (!column) return {};
  std::vector<std::string> methods = table.methods(mean_scenario);
  const auto row_of = [&](const std::string& id) {
    const Row* row = table.find(column->arm, mean_scenario, id, column->demonstrations);
    return row && row->success ? row : nullptr;
  };
  methods.erase(std::remove_if(methods.begin(), methods.end(), [&](const std::string& id) { return !row_of(id); }),
                methods.end());
  if (methods.empty()) return {};
  const std::string& first = methods.front();
  const Row& row = *row_of(first);
  const bool paired = row.paired.has_value();
  Spans spans{
      {fmt::format("{}, {}{}: {} {} in ", table.title(mean_scenario), table.demonstrations_text(column->demonstrations),
                   table.arms.size() > 1 ? ", arm \"" + table.arm_head(column->arm) + '"' : "",
                   material.styles.name(first), paired ? "gets both commands of a pair right" : "succeeds")},
      Span::number(fixed(paired ? row.paired->share : *row.success), place_of(row, paired ? "paired/share" : "success"),
                   Emphasis::strong),
      {paired ? " of the scenes" : " of the episodes"}};
  spans.front().text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(spans.front().text.front())));
  const auto steps = std::find_if(material.summary.steps.begin(), material.summary.steps.end(), [&](const Steps& one) {
    return !paired && first == command_read && one.layout == table.layout && one.engine == table.engine &&
           one.demonstrations == column->demonstrations;
  });
  bool any = steps != material.summary.steps.end();
  if (any) {
    spans.emplace_back(fmt::format(". From pixels {} has {}; ", material.styles.name(steps->played[0].stage->method),
                                   fixed(steps->played[0].success)));
    for (Span& span : steps_sentence(*steps)) spans.push_back(std::move(span));
  } else {
    const auto add = [&](const std::optional<Change>& change, const std::string& other) {
      if (!change) return;
      add_difference(spans, *change, other, any ? ", " : ": ");
      any = true;
    };
    for (const std::string& other : most_compared(methods, most_others))
      add(against_method(material, table, first, other, *column, paired), in_a_sentence(material.styles.name(other)));
    if (!paired) add(against_random(material, table, first, *column), "the " + display_name(random_object));
  }
  spans.emplace_back(any ? " (95 % intervals of the paired differences)." : ".");
  std::vector<std::string> verdicts;
  for (const Claim& claim : material.claims)
    if (claim.verdict != Verdict::not_tested)
      verdicts.push_back(fmt::format("{} {}", claim.id, to_string(claim.verdict)));
  if (!verdicts.empty()) {
    const bool of_suite = !material.claims.front().refuted_if.empty();
    spans.emplace_back(" ");
    spans.push_back(Span::link(of_suite ? "The suite’s claims" : "The paper’s claims", "#claims"));
    spans.emplace_back(fmt::format(": {}.", fmt::join(verdicts, ", ")));
  }
  return spans;
}

std::vector<ArmLine> arm_lines(const Material& material, const AboutSuite& about) {
  std::vector<ArmLine> lines;
  for (const Table& table : material.summary.tables)
    for (const std::string& arm : table.arms) {
      if (table.perturbs(arm) ||
          std::any_of(lines.begin(), lines.end(), [&arm](const ArmLine& line) { return line.name == arm; }))
        continue;
      ArmLine& line = lines.emplace_back(ArmLine{arm, table.arm_title(arm), about.arm(arm), ""});
      for (const CellResult& cell : material.run.cells) {
        if (cell.failed || !has_arm(cell, arm) || !line.png.empty()) continue;
        for (const Episode& episode : cell.episodes.at(arm))
          if (const auto scene = material.pictures.scenes.find(episode.scene);
              line.png.empty() && scene != material.pictures.scenes.end())
            line.png = scene->second;
      }
    }
  return lines;
}

Spans setting_line(const RunResults& run) {
  std::vector<std::string> texts;
  for (const auto& [option, value] : shared_options(run)) texts.push_back(fmt::format("{}={}", option, value));
  if (texts.empty()) return {};
  return {{fmt::format("All rows: {}. Every other option has the plugin’s default.", fmt::join(texts, ", "))}};
}

namespace {

constexpr std::size_t most_methods = 8, most_columns = 80;  // rows; columns of a terminal

enum class Shown { intervals, rates, main_and_mean };

std::size_t width_of(const std::string& text) {
  std::size_t widest = 0, now = 0;
  for (const char c : text) {
    now = c == '\n' ? 0 : now + ((c & 0xC0) != 0x80);
    widest = std::max(widest, now);
  }
  return widest;
}

// What a row is compared by: its success, or where scenes are pairs that in both commands.
std::optional<std::pair<double, Interval>> value_of(const Row& row, bool paired) {
  if (paired) return row.paired ? std::optional(std::pair(row.paired->share, row.paired->interval)) : std::nullopt;
  return row.success ? std::optional(std::pair(*row.success, row.interval)) : std::nullopt;
}

std::string value_text(const Row& row, bool paired, bool with_interval) {
  const auto value = value_of(row, paired);
  if (!value) return "–";
  const auto& [share, interval] = *value;
  return fixed(share) + (with_interval ? fmt::format(" [{}, {}]", fixed(interval.low), fixed(interval.high)) : "") +
         marks_text(row);
}

struct Means {
  const Material& material;
  const Table& table;
  const Column& main;
  std::set<std::string> marks{};  // of the rows that are shown
  bool paired = std::any_of(table.rows.begin(), table.rows.end(),
                            [this](const Row& row) { return row.is_mean() && row.arm == main.arm && row.paired; });

  std::vector<Column> columns() const {
    std::vector<Column> all;
    if (table.arms.size() == 1)
      for (const int n : table.demonstrations()) all.push_back({std::to_string(n), main.arm, n});
    else
      for (const std::string& arm : table.arms) all.push_back({table.arm_head(arm), arm, main.demonstrations});
    return all;
  }

  TableCell cell(const std::string& id, const Column& column, bool interval) {
    const Row* row = table.find(column.arm, mean_scenario, id, column.demonstrations);
    if (!row) return {};
    marks.insert(row->marks.begin(), row->marks.end());
    return value_text(*row, paired, interval);
  }

  // Over columns in which the row has a value.
  TableCell mean(const std::string& id) const {
    double sum = 0;
    int n = 0;
    for (const Column& column : columns())
      if (const Row* row = table.find(column.arm, mean_scenario, id, column.demonstrations))
        if (const auto value = value_of(*row, paired)) {
          sum += value->first;
          ++n;
        }
    return n == 0 ? "–" : fixed(sum / n);
  }

  Grid grid(const std::vector<std::string>& ids, Shown shown) {
    const std::vector<Column> all = columns();
    const bool one_arm = table.arms.size() == 1;
    Grid grid;
    grid.caption = fmt::format("{}, {}{}", paired ? "Both commands of a pair right" : "Success",
                               table.title(mean_scenario), shown == Shown::rates ? "" : " [95 % interval]");
    if (material.summary.tables.size() > 1) grid.caption += ", " + table.title();
    grid.heads = {one_arm ? "demonstrations" : table.demonstrations_text(main.demonstrations)};
    if (shown == Shown::main_and_mean)
      grid.heads.insert(grid.heads.end(), {one_arm ? std::to_string(main.demonstrations) : table.arm_head(main.arm),
                                           fmt::format("mean of {}{}", all.size(), one_arm ? "" : " arms")});
    else
      for (const Column& column : all) grid.heads.emplace_back(column.head);
    for (const std::string& id : ids) {
      Grid::Row& row = grid.rows.emplace_back(Grid::Row{{}, {material.styles.name(id)}});
      row.reference = material.styles(id).reference();
      if (shown == Shown::main_and_mean)
        row.cells.insert(row.cells.end(), {cell(id, main, true), mean(id)});
      else
        for (const Column& column : all) row.cells.push_back(cell(id, column, shown == Shown::intervals));
    }
    return grid;
  }
};

}  // namespace

Brief brief(const Material& material) {
  Brief brief;
  const std::vector<Table>& tables = material.summary.tables;
  const Table all = tables.empty() ? Table() : tables.front();
  const std::size_t rows = all.methods(mean_scenario).size();
  const Table table = rows <= most_methods ? all : all.without_errors();  // which are then in the report alone
  if (const auto main = main_column(table, about_suite(material.run.suite, material.run.record.about))) {
    const std::vector<std::string> methods = table.methods(mean_scenario), references = table.references(mean_scenario),
                                   others = most_compared(methods, most_methods - 1);
    std::vector<std::string> ids;
    for (const std::string& id : methods)
      if (id == methods.front() || std::count(others.begin(), others.end(), id) > 0) ids.push_back(id);
    const std::size_t left_out = rows - ids.size();
    for (const std::string& id : references)
      if (const ReferenceRow* row = find_reference_row(id); row && row->below_it) ids.push_back(id);
    for (const Shown shown : {Shown::intervals, Shown::rates, Shown::main_and_mean}) {
      Means means{material, table, *main};
      brief.means = means.grid(ids, shown);
      if (shown != Shown::main_and_mean && width_of(terminal(brief.means)) > most_columns) continue;
      for (const RowMark& mark : table_marks())
        if (means.marks.count(mark.word) > 0) brief.notes.push_back(fmt::format("{} {}.", mark.sign, mark.meaning));
      break;
    }
    if (left_out > 0) brief.notes.push_back(fmt::format("More rows in the report: {}.", left_out));
    if (tables.size() > 1) brief.notes.push_back(fmt::format("More tables in the report: {}.", tables.size() - 1));
  }
  const std::vector<std::string> lacks = what_it_lacks(material.run);
  brief.notes.insert(brief.notes.end(), lacks.begin(), lacks.end());
  for (const statistics::MethodError& error : method_errors(material.run))
    brief.notes.push_back(fmt::format("{} ({})", error.text, (material.run.directory / error.log).string()));
  return brief;
}

}  // namespace lgabench::report

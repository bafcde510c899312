// Why methods fail: what they selected, how their episodes ended, and what failures are attributed to.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>

#include <lgabench/core/environments.hpp>
#include <lgabench/document/document.hpp>
#include <lgabench/report/sections.hpp>
#include <lgabench/statistics/phi_words.hpp>
#include <lgabench/statistics/tables.hpp>

namespace lgabench::report {
namespace {

std::string words(std::string word) {
  std::replace(word.begin(), word.end(), '_', ' ');
  return word;
}

// A number of a φ̂, or "–" where there is none; without digits, a count or a mean of counts.
Span phi_number(const Row& row, const std::string& place, std::optional<double> value, int digits) {
  if (!value) return Span::number("–");
  return Span::number(digits ? fixed(*value, digits) : fmt::format("{:.4g}", *value), place_of(row, "phi" + place));
}

// A chip for each name; too many are counted.
TableCell chips(const std::vector<std::string>& names, std::size_t known, Emphasis emphasis) {
  return names.empty() ? TableCell("none") : TableCell(Span(listed(names, known), emphasis));
}

// The words of each distinct φ̂: what it has of the truth, what it lacks, what it has beside it.
Grid words_grid(const Material& material, bool tell) {
  Grid grid;
  grid.name = "phi_words";
  grid.caption = "What was selected, in words, beside what the scenario means";
  grid.group_head = "scenario";
  grid.heads = {"command", "method", "about", "feature", "correct", "missed", "wrong"};
  grid.align = std::string(grid.heads.size() + 1, 'l');
  std::set<std::vector<std::string>> shown;
  for (const CellResult& cell : material.run.cells)
    for (const CommandResult& command : cell.commands)
      for (const PhiWords& words : phi_words(cell, command)) {
        const std::string of_all[] = {listed(words.right, words.known), listed(words.missed, words.known),
                                      listed(words.wrong, words.known)};
        if (!shown
                 .insert({cell.scenario, command.utterance, cell.method, words.about, words.feature, of_all[0],
                          of_all[1], of_all[2]})
                 .second)
          continue;
        grid.rows.push_back(
            {cell.scenario,
             {command_text(command.utterance, command.seen, tell), named(material, cell.method), words.about,
              words.feature, chips(words.right, words.known, Emphasis::better),
              chips(words.missed, words.known, Emphasis::missed), chips(words.wrong, words.known, Emphasis::worse)}});
      }
  return grid;
}

TableCell bar(const std::vector<BarPart>& parts, int of) {
  TableCell cell;
  cell.bar = parts;
  cell.bar_of = of;
  return cell;
}

// How episodes ended, a bar beside its numbers: over all scenarios, and in groups of one scenario each; of perturbed
// arms those of methods over all scenarios, in groups of one axis each.
struct Endings {
  Grid mean, each, levels;

  Endings(const std::string& name, const char* bars, std::string caption, std::string each_caption) {
    mean.heads = {"table", "arm", "method", "demonstrations", bars};
    mean.bars = mean.heads.size() - 1;
    mean.align = "lllrr";
    mean.name = name;
    mean.caption = std::move(caption);
    each.name = name + "_scenarios";
    each.caption = std::move(each_caption);
    each.group_head = "scenario";
    levels.name = name + "_levels";
    levels.caption = mean.caption + ", at each level";
    levels.group_head = "axis";
  }

  // A column of numbers; the bars' parts of that `kind`, if any, are what it counts.
  void column(TableCell head, const std::string& kind = "") {
    if (!kind.empty()) head.bar = {{kind, "", 1}};
    mean.heads.push_back(std::move(head));
    mean.align += 'r';
  }

  // Adds a row with its bar and the columns' numbers.
  void add(const Material& material, const Table& table, const Row& row, TableCell bar,
           std::vector<TableCell> numbers) {
    if (row.perturbation && (!row.is_mean() || row.is_reference())) return;
    std::vector<TableCell> cells{table.title(), table.arm_title(row.arm), named(material, row.method),
                                 count_cell(row, "demonstrations", row.demonstrations), std::move(bar)};
    std::move(numbers.begin(), numbers.end(), std::back_inserter(cells));
    if (row.perturbation) return levels.rows.push_back({row.perturbation->axis, std::move(cells)});
    Grid& grid = row.is_mean() ? mean : each;
    grid.rows.push_back({row.is_mean() ? TableCell() : TableCell(row.scenario), std::move(cells)});
  }

  void put_into(Section& section, const std::string& lead = "") {
    for (Grid* grouped : {&each, &levels}) {
      grouped->heads = mean.heads;
      grouped->bars = mean.bars;
      grouped->align = "l" + mean.align;
    }
    // Levels of a method below each other, axes and methods as they came: the rows come arm by arm.
    std::map<std::string, std::size_t> came;
    const auto words = [](const Grid::Row& row) {
      return std::array{row.group.text(), row.cells[0].text(), row.cells[2].text(), row.cells[3].text()};
    };
    for (const Grid::Row& row : levels.rows)
      for (const std::string& word : words(row)) came.emplace(word, came.size());
    std::stable_sort(levels.rows.begin(), levels.rows.end(), [&](const Grid::Row& a, const Grid::Row& b) {
      const auto [of_a, of_b] = std::pair(words(a), words(b));
      return std::lexicographical_compare(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                                          [&](const auto& x, const auto& y) { return came.at(x) < came.at(y); });
    });
    section.add(reading, std::move(mean), "", lead);
    if (!each.rows.empty()) section.add_detail(std::move(each), "Each scenario");
    if (!levels.rows.empty()) section.add(reading, std::move(levels), "Each level of each axis");
  }
};

}  // namespace

Section phi(const Material& material) {
  Section section{"phi", "The feature abstraction φ̂"};
  const bool tell = has_unseen(material.run);
  Grid grid;
  grid.name = "phi";
  grid.caption =
      "What was selected, against the scenario's true distribution; selected: how many of how many true ones";
  grid.group_head = "scenario";
  grid.align = "l";
  std::set<std::string> known;
  std::set<std::size_t> shown;
  for (const Table& table : material.summary.tables)
    for (const Row& row : table.without_errors().rows) shown.insert(row.index);
  List wordings;
  for (const PhiOfRow& of : distinct_phi(material.summary)) {
    const Row& row = *of.row;
    if (shown.count(row.index) == 0) continue;
    const PhiOfCommand& phi = row.phi[of.command];
    const std::string place = fmt::format("/{}/", of.command);
    for (const auto& [about, set] : phi.quality) {
      grid.rows.push_back({row.scenario, {}});
      put(grid, "command", 'l', command_text(phi.utterance, phi.seen, tell));
      put(grid, "method", 'l', named(material, row.method));
      put(grid, "about", 'l', about);
      put(grid, "answered by", 'l', provenance_words(phi.provenance, phi.erring));
      put(grid, "source", 'l', phi.source);
      for (const auto& [group, names] : {std::pair("object_types", &set.object_types), {"textures", &set.textures}}) {
        const std::string numbers = fmt::format("{}quality/{}/{}/", place, about, group);
        const std::string head = names == &set.textures ? "textures: " : "types: ";
        put(grid, head + "precision", 'r', phi_number(row, numbers + "precision", names->precision, 2));
        put(grid, head + "recall", 'r', phi_number(row, numbers + "recall", names->recall, 2));
        put(grid, head + "selected", 'r',
            Spans{phi_number(row, numbers + "size", names->size, 0), " of ",
                  phi_number(row, numbers + "true_size", names->true_size, 0)});
      }
      put(grid, "queries", 'r',
          was_asked(phi.provenance, phi.source) ? phi_number(row, place + "lm_queries", phi.lm_queries, 0)
                                                : Span("not asked"));
      put(grid, "a person's seconds", 'r', phi_number(row, place + "human_seconds", phi.human_seconds, 0));
    }
    const std::string wording = fmt::format("{}, of {}: “{}”", row.scenario, phi.source, phi.asked_as);
    if (worded_otherwise(phi.asked_as, phi.utterance)) known.insert(wording);
  }
  if (grid.rows.empty()) return section;
  section.add_detail(
      Paragraph{{"φ̂ is what a method selected as mattering for a command: object types and textures. "
                 "Precision is the share of it that is right, recall the share of what is right that it has."}});
  if (Grid in_words = words_grid(material, tell); !in_words.rows.empty()) section.add_detail(std::move(in_words));
  section.add(reading, std::move(grid), "Precision, recall, queries and seconds",
              "Against the scenario's true distribution: precision and recall of what was selected, and how many were "
              "selected of how many that are true.");
  if (known.empty()) return section;
  for (const std::string& wording : known) wordings.items.push_back({wording});
  section.add(reading, Paragraph{{"Where the question was worded otherwise than the command:"}});
  section.add(reading, std::move(wordings));
  return section;
}

Section failures(const Material& material) {
  Section section{"failures", "Failures by type"};
  std::set<std::string> used;
  for (const Table& table : material.summary.tables)
    for (const Row& row : table.rows)
      for (const auto& item : row.failures) used.insert(item.first);
  if (used.empty()) return section;
  Endings endings("failures", "failures of all episodes", "Episodes over all scenarios, by how they ended",
                  "Each scenario's episodes, by how they ended, with the most demonstrations");
  endings.column("episodes");
  endings.column("success");
  const std::vector<std::string> all = failure_words(used);  // in the order of their colours
  const auto kind = [&all](const std::string& word) {
    return fmt::format("f{}", (std::find(all.begin(), all.end(), word) - all.begin()) % failure_colours);
  };
  for (const std::string& word : used) endings.column(words(word), kind(word));
  for (const Table& table : material.summary.tables)
    for (const Row& row : table.rows) {
      if (row.episodes == 0) continue;
      if (!row.is_mean() && (row.is_reference() || row.demonstrations != table.demonstrations().back())) continue;
      std::vector<TableCell> numbers{count_cell(row, "episodes", row.episodes),
                                     count_cell(row, "successes", row.successes)};
      std::vector<BarPart> parts;
      for (const std::string& word : used) {
        const auto found = row.failures.find(word);
        const int n = found == row.failures.end() ? 0 : found->second;
        parts.push_back({kind(word), words(word), n});
        numbers.push_back(n == 0 ? TableCell(Span::number("0")) : count_cell(row, "failures/" + word, n));
        if (n == 0) continue;
        numbers.back().episodes = row.index;
        numbers.back().outcome = words(word);
      }
      endings.add(material, table, row, bar(parts, row.episodes), std::move(numbers));
    }
  endings.put_into(section, "Episodes over all scenarios.");
  return section;
}

Section attribution(const Material& material) {
  Section section{"attribution", "What failures are attributed to"};
  const auto any = [&](const char* cause) {
    const auto has = [cause](const Row& row) { return row.attributed_to(cause) > 0; };
    return std::any_of(material.summary.tables.begin(), material.summary.tables.end(),
                       [&](const Table& table) { return std::any_of(table.rows.begin(), table.rows.end(), has); });
  };
  const bool any_read = any("reading"), any_perceived = any("perception");
  std::vector<const char*> causes{"abstraction", "policy"};
  if (any_perceived) causes.push_back("perception");
  if (any_read) causes.push_back("reading");
  Endings endings("attribution", "share of failures",
                  "Failures attributed to abstraction or policy, over all scenarios",
                  "Each scenario's failures, attributed to abstraction or policy");
  for (const char* to : causes) endings.column(to, to);
  for (const Table& table : material.summary.tables)
    for (const Row& row : table.rows) {
      if (row.attributed() == 0) continue;
      std::vector<BarPart> parts;
      std::vector<TableCell> numbers;
      for (const char* to : causes) {
        const int n = row.attributed_to(to);
        parts.push_back({to, to, n});
        numbers.push_back(row.attribution.count(to) == 0 ? TableCell(Span::number("0"))
                                                         : count_cell(row, fmt::format("attribution/{}", to), n));
      }
      endings.add(material, table, row, bar(parts, row.attributed()), std::move(numbers));
    }
  if (endings.mean.rows.empty() && endings.levels.rows.empty()) return section;
  std::string seen;
  if (any_read) seen = "Reading, where the same policy succeeds with the simulator's names in the same picture; else ";
  if (any_perceived) seen += "perception, where the same policy succeeds in the same scene seen without error; else ";
  seen += "the";
  section.add(reading, Paragraph{{fmt::format("{} abstraction, where the same policy succeeds in the same scene with "
                                              "the true mask; else the policy. Episodes over all scenarios, of methods "
                                              "that select.",
                                              capital(seen))}});
  endings.put_into(section);
  return section;
}

}  // namespace lgabench::report

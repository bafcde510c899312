#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>
#include <tuple>

#include <lgabench/report/names.hpp>
#include <lgabench/report/tables.hpp>

namespace lgabench::report {
namespace {

// Text from a file inside a table's cell: it may neither end the cell nor the line.
std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|') out += '\\';
    out += std::iscntrl(static_cast<unsigned char>(c)) ? ' ' : c;
  }
  return out;
}

std::string plain(const Json& value) { return plain(value.is_string() ? value.get<std::string>() : canonical(value)); }

std::string row_of(const std::vector<std::string>& cells) { return fmt::format("| {} |\n", fmt::join(cells, " | ")); }

// The first `words` columns hold words, the others numbers.
std::string head_of(const std::vector<std::string>& names, std::size_t words) {
  std::vector<std::string> rules(names.size(), "---:");
  std::fill_n(rules.begin(), std::min(words, rules.size()), "---");
  return row_of(names) + row_of(rules);
}

std::string what_was_run(const RunResults& run) {
  std::size_t failed = 0;
  std::vector<std::pair<std::string, std::string>> commands;
  for (const CellResult& cell : run.cells) {
    failed += cell.failed ? 1 : 0;
    const std::pair command(cell.scenario, cell.utterance);
    if (std::find(commands.begin(), commands.end(), command) == commands.end()) commands.push_back(command);
  }
  std::string text = "## What was run\n\n";
  text += fmt::format("- cells: {} finished, {} failed, {} not run\n", run.cells.size() - failed, failed, run.not_run);
  for (const auto& [name, value] : run.json.items())
    if (value.is_primitive() && !value.is_null() && value != "") text += fmt::format("- {}: {}\n", name, plain(value));
  for (const auto& item : run.json.at("machine").items())
    text += fmt::format("- machine, {}: {}\n", item.key(), plain(item.value()));
  text += "\n" + head_of({"scenario", "command"}, 2);
  for (const auto& [scenario, utterance] : commands) text += row_of({plain(scenario), plain(utterance)});
  return text;
}

std::string paper_text(const PaperValues& paper, const std::string& method, int demonstrations) {
  const auto values = paper.find(method);
  if (values == paper.end()) return "";
  const auto value = values->second.find(demonstrations);
  return value == values->second.end() ? "" : fmt::format("*{:.3f}*", value->second);
}

// Success of every method, one column a number of demonstrations; the paper's values under ours on the mean.
std::string success_table(const Table& table, const PaperValues& paper, const std::vector<std::string>& scenarios) {
  const std::vector<int> columns = table.demonstrations();
  std::vector<std::string> head{"scenario", "method"};
  for (const int n : columns) head.push_back(std::to_string(n));
  std::string text = head_of(head, 2);
  for (const std::string& scenario : scenarios) {
    const auto line = [&](const std::string& id, const std::string& shown) {
      std::vector<std::string> cells{plain(table.title(scenario)), shown};
      for (const int n : columns) cells.push_back(success_text(table.find(scenario, id, n)));
      text += row_of(cells);
    };
    for (const std::string& id : table.methods(scenario)) {
      const std::string name = display_name(id);
      line(id, "**" + plain(name) + "**");
      if (scenario != mean_scenario || paper.count(name) == 0) continue;
      std::vector<std::string> cells{"*the paper's scenarios*", "*" + plain(name) + ", the paper*"};
      for (const int n : columns) cells.push_back(paper_text(paper, name, n));
      text += row_of(cells);
    }
    for (const std::string& id : table.references(scenario)) line(id, "reference: " + plain(display_name(id)));
  }
  return text;
}

std::string success(const Summary& summary, const PaperValues& paper, const std::vector<Figure>& figures) {
  std::string text;
  for (std::size_t i = 0; i < summary.tables.size(); ++i) {
    const Table& table = summary.tables[i];
    std::vector<std::string> each = table.scenarios();
    each.pop_back();  // the mean
    text += fmt::format("\n## Success: {}\n\n", plain(table.title()));
    text += figures[i].problem.empty() ? fmt::format("![success against demonstrations]({})\n\n", figures[i].file)
                                       : fmt::format("No figure: {}.\n\n", figures[i].problem);
    text += "Columns: number of demonstrations.\n\n" + success_table(table, paper, {mean_scenario});
    text += "\nEach scenario:\n\n" + success_table(table, {}, each);
  }
  return text;
}

// "0.80" or "–" where there is none.
std::string share(const Json& value) { return value.is_number() ? fmt::format("{:.2f}", value.get<double>()) : "–"; }
std::string count(const Json& value) { return value.is_number() ? fmt::format("{:.4g}", value.get<double>()) : "–"; }

// Precision, recall and size of every Selection; equal ones (of other layouts, demonstrations) once.
std::string phi(const RunResults& run, const Summary& summary) {
  std::map<std::string, std::string> commands;
  for (const CellResult& cell : run.cells) commands[cell.scenario] = cell.utterance;
  std::string text;
  std::set<std::string> seen, wordings;
  for (const Table& table : summary.tables)
    for (const Row& row : table.rows) {
      if (row.phi.is_null() || !seen.insert(row.scenario + '\n' + row.method + '\n' + canonical(row.phi)).second)
        continue;
      for (const auto& [about, groups] : row.phi.at("quality").items()) {
        if (groups.is_null()) continue;
        std::vector<std::string> cells{plain(row.scenario), plain(display_name(row.method)), about,
                                       plain(provenance_words(row.phi.at("provenance"))), plain(row.phi.at("source"))};
        for (const char* group : {"object_types", "textures"}) {
          const Json numbers = groups.value(group, Json::object());
          cells.push_back(share(numbers.value("precision", Json())));
          cells.push_back(share(numbers.value("recall", Json())));
          cells.push_back(count(numbers.value("size", Json())) + " of " + count(numbers.value("true_size", Json())));
        }
        cells.push_back(count(row.phi.at("lm_queries")));
        text += row_of(cells);
      }
      if (const std::string asked = row.phi.at("asked_as"); asked != commands[row.scenario])
        wordings.insert(
            fmt::format("- {}, of {}: “{}”\n", plain(row.scenario), plain(row.phi.at("source")), plain(asked)));
    }
  if (text.empty()) return "";
  return "\n## The feature abstraction φ̂\n\nAgainst the scenario's true distribution: precision and recall of what was "
         "selected, and how many were selected of how many that are true.\n\n" +
         head_of({"scenario", "method", "about", "answered by", "source", "types: precision", "recall", "selected",
                  "textures: precision", "recall", "selected", "queries"},
                 5) +
         text + (wordings.empty() ? "" : "\nWhere the question was worded otherwise than the command:\n\n") +
         fmt::format("{}", fmt::join(wordings, ""));
}

std::string failures(const Summary& summary) {
  std::set<std::string> words;
  for (const Table& table : summary.tables)
    for (const Row& row : table.rows)
      for (const auto& item : row.failures) words.insert(item.first);
  if (words.empty()) return "";

  std::vector<std::string> head{"table", "method", "episodes", "won"};
  head.insert(head.end(), words.begin(), words.end());
  std::string text =
      "\n## Failures by type\n\nEpisodes over all scenarios and numbers of demonstrations.\n\n" + head_of(head, 2);
  for (const Table& table : summary.tables) {
    auto ids = table.methods(mean_scenario);
    for (std::string& id : table.references(mean_scenario)) ids.push_back(std::move(id));
    for (const std::string& id : ids) {
      int episodes = 0, won = 0;
      std::map<std::string, int> failed;
      for (const Row& row : table.rows) {
        if (!row.is_mean() || row.method != id) continue;
        episodes += row.episodes;
        won += row.successes;
        for (const auto& [word, n] : row.failures) failed[word] += n;
      }
      std::vector<std::string> cells{plain(table.title()), plain(display_name(id)), std::to_string(episodes),
                                     std::to_string(won)};
      for (const std::string& word : words) cells.push_back(std::to_string(failed[word]));
      text += row_of(cells);
    }
  }
  return text;
}

std::string times(const RunResults& run) {
  struct Sum {
    int cells = 0;
    std::array<double, phases.size()> seconds{};
  };
  std::map<std::tuple<std::string, std::string, int, std::string>, Sum> sums;  // layout, engine, rank, method
  for (const CellResult& cell : run.cells) {
    if (cell.failed) continue;
    Sum& sum = sums[{cell.layout, cell.engine, display_rank(cell.method), cell.method}];
    ++sum.cells;
    for (std::size_t i = 0; i < phases.size(); ++i) sum.seconds[i] += cell.timing.at(phases[i]).get<double>();
  }
  if (sums.empty()) return "";
  std::string text =
      "\n## Time per cell\n\nMean seconds of each phase.\n\n" +
      head_of({"layout", "engine", "method", "cells", "select", "sample", "demonstrate", "learn", "evaluate", "total"},
              3);
  for (const auto& [place, sum] : sums) {
    const auto& [layout, engine, rank, method] = place;
    std::vector<std::string> cells{plain(layout), plain(engine), plain(display_name(method)),
                                   std::to_string(sum.cells)};
    for (const double s : sum.seconds) cells.push_back(fmt::format("{:.2f}", s / sum.cells));
    text += row_of(cells);
  }
  return text;
}

std::string failed_cells(const Summary& summary) {
  if (summary.failed.empty()) return "";
  std::string text =
      "\n## Cells that failed\n\nThey count for nothing above; `log.txt` in a cell's directory says more.\n\n" +
      head_of({"cell", "method", "scenario", "layout", "engine", "demonstrations", "training seed", "fault", "reason"},
              9);
  for (const CellResult& cell : summary.failed)
    text += row_of({cell.key, plain(display_name(cell.method)), plain(cell.scenario), plain(cell.layout),
                    plain(cell.engine), std::to_string(cell.demonstrations), std::to_string(cell.training_seed),
                    plain(cell.fault), plain(cell.reason)});
  return text;
}

constexpr const char* how_to_read =
    "\n## How to read the numbers\n\n"
    "- Success is the mean over scenarios of the mean over training seeds of the share of test episodes won.\n"
    "- Brackets hold a 95 % interval: Wilson's where the number stands on one policy; otherwise a percentile interval "
    "from a cluster bootstrap over scenarios, then training seeds (10,000 times), nowhere narrower than Wilson's on "
    "all "
    "episodes. With few seeds or scenarios it is rough.\n"
    "- Reference rows are no methods: the best constant action knows the training actions alone, the random visible "
    "object is handled by the oracle's rule, the oracle knows the target. The last two learn nothing and stand the "
    "same "
    "in every column.\n";

}  // namespace

std::string markdown(const RunResults& run, const Summary& summary, const PaperValues& paper,
                     const std::vector<Figure>& figures) {
  std::string text = fmt::format("# {}: success of learned policies\n\n", plain(run.suite));
  for (const std::string& note : notes(run, summary)) text += "> " + plain(note) + "  \n";
  text += "\n" + what_was_run(run) + success(summary, paper, figures);
  if (!paper.empty())
    text +=
        "\nThe paper's values are those of its figure 3a, on the mean over its own scenarios, not only those of this "
        "run.\n";
  return text + phi(run, summary) + failures(summary) + times(run) + failed_cells(summary) + how_to_read;
}

}  // namespace lgabench::report

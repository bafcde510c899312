#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>

#include <lgabench/core/terminal.hpp>
#include <lgabench/report/names.hpp>
#include <lgabench/report/settings.hpp>
#include <lgabench/report/tables.hpp>

namespace lgabench::report {

std::string plain(const std::string& text) {
  std::string flat = text, out;
  std::replace(flat.begin(), flat.end(), '\n', ' ');
  for (const char c : one_line(flat)) {
    constexpr std::string_view marks = "|[]`*<\\";
    if (marks.find(c) != marks.npos) out += '\\';
    out += c;
  }
  return out;
}

static std::string plain(const Json& value) {
  return plain(value.is_string() ? value.get<std::string>() : canonical(value));
}

namespace {

std::string row_of(const std::vector<std::string>& cells) { return fmt::format("| {} |\n", fmt::join(cells, " | ")); }

// The first `words` columns hold words, the others numbers.
std::string head_of(const std::vector<std::string>& names, std::size_t words) {
  std::vector<std::string> rules(names.size(), "---:");
  std::fill_n(rules.begin(), std::min(words, rules.size()), "---");
  return row_of(names) + row_of(rules);
}

// Whether demonstrations with the command were given, where that is not so for all.
std::string command_text(const std::string& utterance, bool seen, bool tell) {
  return plain(utterance) + (!tell ? "" : seen ? " (seen)" : " (unseen)");
}

std::string what_was_run(const RunResults& run) {
  std::size_t failed = 0;
  std::vector<std::string> commands;  // rows
  const bool tell = has_unseen(run);
  for (const CellResult& cell : run.cells) {
    failed += cell.failed ? 1 : 0;
    for (const CommandResult& command : cell.commands) {
      const std::string row = row_of({plain(cell.scenario), command_text(command.utterance, command.seen, tell)});
      if (std::find(commands.begin(), commands.end(), row) == commands.end()) commands.push_back(row);
    }
  }
  std::string text = "## What was run\n\n";
  text += fmt::format("- cells: {} finished, {} failed, {} not run\n", run.cells.size() - failed, failed, run.not_run);
  for (const auto& [name, value] : run.json.items())
    if (value.is_primitive() && !value.is_null() && value != "") text += fmt::format("- {}: {}\n", name, plain(value));
  for (const auto& item : run.json.at("machine").items())
    text += fmt::format("- machine, {}: {}\n", item.key(), plain(item.value()));
  return text + "\n" + head_of({"scenario", "command"}, 2) + fmt::format("{}", fmt::join(commands, ""));
}

// "*0.293 ± 0.078*", with its error bar where the figure has one.
std::string paper_text(const PaperValues& paper, const std::string& scenario, const std::string& id, int n,
                       int digits) {
  const auto rate = paper.find(scenario, display_name(id), n), error = paper.error(scenario, display_name(id), n);
  if (!rate) return "";
  return fmt::format("*{:.{}f}{}*", *rate, digits, error ? fmt::format(" ± {:.{}f}", *error, digits) : "");
}

// The method's values at the columns' numbers of demonstrations.
std::vector<std::string> paper_texts(const PaperValues& paper, const std::string& scenario, const std::string& id,
                                     const std::vector<Column>& columns) {
  std::vector<std::string> texts;
  for (const Column& c : columns) texts.push_back(paper_text(paper, scenario, id, c.demonstrations, 3));
  return texts;
}

// `columns` of `text_of` for every method of `scenarios`.
std::string table_of(const Table& table, const std::vector<Column>& columns, std::string (*text_of)(const Row*),
                     const std::vector<std::string>& scenarios, const PaperValues& paper) {
  // Beside several arms the paper's value, pooled over its own, has a column; else its curve a row.
  const bool arms = table.arms.size() > 1;
  const auto pooled = [&](const std::string& scenario, const std::string& id) {
    return paper_text(paper, scenario, id, columns.front().demonstrations, 2);
  };
  bool beside = false;
  for (const std::string& scenario : scenarios)
    for (const std::string& id : table.methods(scenario)) beside = beside || (arms && !pooled(scenario, id).empty());

  std::vector<std::string> head{"scenario", "method"};
  for (const Column& column : columns) head.push_back(plain(column.head));
  if (beside) head.emplace_back("*the paper, its arms pooled*");
  std::string text = head_of(head, 2);
  for (const std::string& scenario : scenarios) {
    const auto line = [&](const std::string& id, const std::string& shown) {
      std::vector<std::string> cells{plain(table.title(scenario)), shown};
      for (const Column& c : columns) cells.push_back(text_of(table.find(c.arm, scenario, id, c.demonstrations)));
      if (beside) cells.push_back(pooled(scenario, id));
      text += row_of(cells);
    };
    for (const std::string& id : table.methods(scenario)) {
      const std::string name = plain(display_name(id));
      line(id, "**" + name + "**");
      if (arms || scenario != mean_scenario) continue;
      std::vector<std::string> cells{"*the paper's scenarios*", "*" + name + ", the paper*"};
      const auto published = paper_texts(paper, scenario, id, columns);
      if (std::all_of(published.begin(), published.end(), [](const auto& t) { return t.empty(); })) continue;
      cells.insert(cells.end(), published.begin(), published.end());
      text += row_of(cells);
    }
    for (const std::string& id : table.references(scenario)) line(id, "reference: " + plain(display_name(id)));
  }
  return text;
}

std::string success(const Summary& summary, const PaperValues& paper, const std::vector<std::vector<Figure>>& figures) {
  std::string text;
  for (std::size_t i = 0; i < summary.tables.size(); ++i) {
    const Table& table = summary.tables[i];
    std::vector<std::string> each = table.scenarios();
    each.pop_back();  // the mean
    text += fmt::format("\n## Success: {}\n\n", plain(table.title()));
    for (const Figure& figure : figures[i])
      text += figure.problem.empty() ? fmt::format("![{}]({})\n\n", figure.title, figure.file)
                                     : fmt::format("No figure: {}.\n\n", figure.problem);
    const std::vector<View> all = views(table);
    for (const View& view : all) {
      const char* gap = &view == &all.front() ? "" : "\n";
      text += table.arms.size() > 1 ? fmt::format("{}### {}\n\nColumns: arms of the test. ", gap, view.corner)
                                    : "Columns: number of demonstrations. ";
      text += "Brackets: 95 % interval over test scenes and training seeds of these scenarios.\n\n";
      text += table_of(table, view.columns, success_text, {mean_scenario}, paper);
      text += "\nEach scenario:\n\n" + table_of(table, view.columns, success_text, each, paper);
      if (!view.shifted.empty())
        text += fmt::format("\nChange against {}, scene by scene:\n\n", plain(table.arms.front())) +
                table_of(table, view.shifted, shift_text, table.scenarios(), {});
      if (any_seen(table))
        text += "\nTest inputs seen in training, share:\n\n" +
                table_of(table, view.columns, seen_text, table.scenarios(), {});
    }
  }
  return text;
}

// "0.80" or "–" where there is none.
std::string share(const Json& value) { return value.is_number() ? fmt::format("{:.2f}", value.get<double>()) : "–"; }
std::string count(const Json& value) { return value.is_number() ? fmt::format("{:.4g}", value.get<double>()) : "–"; }

// Precision, recall and size of every Selection; equal ones (of other layouts, demonstrations) once.
std::string phi(const RunResults& run, const Summary& summary) {
  const bool tell = has_unseen(run);
  std::string text;
  std::set<std::string> wordings;
  for (const PhiOfRow& of : distinct_phi(summary)) {
    const Row& row = *of.row;
    const Json& phi = row.phi.at(of.command);
    for (const auto& [about, groups] : phi.at("quality").items()) {
      if (groups.is_null()) continue;
      std::vector<std::string> cells{plain(row.scenario),
                                     command_text(phi.at("utterance"), phi.at("seen"), tell),
                                     plain(display_name(row.method)),
                                     about,
                                     plain(provenance_words(phi.at("provenance"))),
                                     plain(phi.at("source"))};
      for (const char* group : {"object_types", "textures"}) {
        const Json numbers = groups.value(group, Json::object());
        cells.push_back(share(numbers.value("precision", Json())));
        cells.push_back(share(numbers.value("recall", Json())));
        cells.push_back(count(numbers.value("size", Json())) + " of " + count(numbers.value("true_size", Json())));
      }
      cells.push_back(count(phi.at("lm_queries")));
      cells.push_back(count(phi.at("human_seconds")));
      text += row_of(cells);
    }
    if (worded_otherwise(phi.at("asked_as"), phi.at("utterance")))
      wordings.insert(
          fmt::format("- {}, of {}: “{}”\n", plain(row.scenario), plain(phi.at("source")), plain(phi.at("asked_as"))));
  }
  if (text.empty()) return "";
  return "\n## The feature abstraction φ̂\n\nAgainst the scenario's true distribution: precision and recall of what was "
         "selected, and how many were selected of how many that are true.\n\n" +
         head_of({"scenario", "command", "method", "about", "answered by", "source", "types: precision", "recall",
                  "selected", "textures: precision", "recall", "selected", "queries", "a person's seconds"},
                 6) +
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
  for (const Table& table : summary.tables)
    for (const std::string& arm : table.arms) {
      auto ids = table.methods(mean_scenario);
      for (std::string& id : table.references(mean_scenario)) ids.push_back(std::move(id));
      const std::string title = table.title() + (table.arms.size() > 1 ? ", " + arm : "");
      for (const std::string& id : ids) {
        int episodes = 0, won = 0;
        std::map<std::string, int> failed;
        for (const Row& row : table.rows) {
          if (!row.is_mean() || row.arm != arm || row.method != id) continue;
          episodes += row.episodes;
          won += row.successes;
          for (const auto& [word, n] : row.failures) failed[word] += n;
        }
        std::vector<std::string> cells{plain(title), plain(display_name(id)), std::to_string(episodes),
                                       std::to_string(won)};
        for (const std::string& word : words) cells.push_back(std::to_string(failed[word]));
        text += row_of(cells);
      }
    }
  return text;
}

std::string times(const RunResults& run) {
  const std::vector<PhaseTimes> all = phase_times(run);
  if (all.empty()) return "";
  std::string text =
      "\n## Time per cell\n\nMean seconds of each phase.\n\n" +
      head_of({"layout", "engine", "method", "cells", "select", "sample", "demonstrate", "learn", "evaluate", "total"},
              3);
  for (const PhaseTimes& times : all) {
    std::vector<std::string> cells{plain(times.layout), plain(times.engine), plain(display_name(times.method)),
                                   std::to_string(times.cells)};
    for (const double s : times.mean_s) cells.push_back(fmt::format("{:.2f}", s));
    text += row_of(cells);
  }
  return text;
}

// Of the methods that select: whose failures the true mask would have turned.
std::string attribution(const Summary& summary) {
  std::string text;
  for (const Table& table : summary.tables)
    for (const Row& row : table.rows) {
      if (!row.is_mean() || row.attributed() == 0) continue;
      std::vector<std::string> cells{plain(table.title()), plain(row.arm), plain(display_name(row.method)),
                                     std::to_string(row.demonstrations)};
      for (const char* to : attributions) cells.push_back(std::to_string(row.attribution.at(to)));
      text += row_of(cells);
    }
  if (text.empty()) return "";
  return "\n## What failures are attributed to\n\nThe abstraction, where the same policy wins the same scene with the "
         "true "
         "mask; else the policy. Episodes over all scenarios, of methods that select.\n\n" +
         head_of({"table", "arm", "method", "demonstrations", "abstraction", "policy"}, 3) + text;
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
    "- Brackets hold a 95 % interval: Wilson's where the number is one policy's in one scenario; otherwise a "
    "percentile "
    "interval of 2,000 resamples. The scenarios are taken as they are; in each, test scenes and training seeds "
    "(participants, where there are several) are drawn again, crossed where the seeds share their scenes, else scenes "
    "within seeds, and with them two imagined scenes, one won and one lost. Three seeds on the same 20 scenes count as "
    "20 scenes. What other scenarios would do is not in it; claims test that apart.\n"
    "- A change against an arm is the difference of a policy's two rates, averaged alike; the arms are paired scene by "
    "scene. Its interval is found in the same way (one policy: Bonett and Price's for paired proportions).\n"
    "- A test input was seen in training where all that the policy is given, pictures and text, is there to the byte: "
    "a "
    "high share measures what was learned by heart. – where a policy does not tell.\n"
    "- Reference rows are no methods: the best constant action knows the training actions alone, the random visible "
    "object is handled by the oracle's rule, the oracle knows the target. The last two learn nothing and are "
    "the same for every number of demonstrations.\n";

}  // namespace

std::string markdown(const RunResults& run, const Summary& summary, const std::vector<Claim>& claims,
                     const std::vector<EngineAgreement>& agreements, const PaperValues& paper,
                     const std::vector<std::vector<Figure>>& figures) {
  std::string text = fmt::format("# {}: success of learned policies\n\n", plain(run.suite));
  for (const std::string& line : settings(run)) text += "> " + plain(line) + "  \n";
  for (const std::string& note : notes(run, summary)) text += "> " + plain(note) + "  \n";
  for (const std::string& line : method_errors(run, "")) text += "> " + plain(line) + "  \n";
  text += "\n" + what_was_run(run) + success(summary, paper, figures);
  if (!paper.rates.empty())
    text += fmt::format("\nThe paper's values, in italics, are those of its figure {}, {}.\n", paper.figure,
                        paper.rates.count(mean_scenario)
                            ? "± its error bars, on the mean over its own scenarios, not only those of this run"
                            : "at 50 demonstrations, a scenario's arms pooled; its scenes are not public");
  return text + claims_markdown(claims) + phi(run, summary) + failures(summary) + attribution(summary) +
         agreement_markdown(agreements) + times(run) + failed_cells(summary) + how_to_read;
}

}  // namespace lgabench::report

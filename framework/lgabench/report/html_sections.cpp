// The sections of report.html after success.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include <lgabench/core/environments.hpp>
#include <lgabench/report/html_parts.hpp>
#include <lgabench/report/names.hpp>

namespace lgabench::report::html_parts {
namespace {

std::string words(std::string word) {
  std::replace(word.begin(), word.end(), '_', ' ');
  return word;
}

// A number of a φ̂, or "–" where there is none.
std::string phi_value(const Row& row, const RowNumbers& numbers, const std::string& member, const char* format) {
  const Json& value = row.phi.at(Json::json_pointer(member.substr(std::string("phi").size())));
  return value.is_number() ? numbers.value(row, member, fmt::format(fmt::runtime(format), value.get<double>())) : "–";
}

// Counts side by side as one bar of the row's failures; `of`: the bar's whole width.
struct Part {
  std::string css, name;
  int count;
};
std::string bar(const std::vector<Part>& parts, int of) {
  std::string text = "<div class=bar aria-hidden=true>";
  for (const Part& part : parts)
    if (part.count > 0)
      text += fmt::format("<i class=\"{}\" style=\"width:{:.2f}%\" title=\"{}: {}\"></i>", part.css,
                          100.0 * part.count / std::max(of, 1), part.name, part.count);
  return text + "</div>";
}

std::string count(const Row& row, const RowNumbers& numbers, const std::string& member, int n) {
  return n == 0 ? "" : numbers.value(row, member, std::to_string(n));
}

std::string demonstrations(const Row& row, const RowNumbers& numbers) {
  return numbers.value(row, "demonstrations", std::to_string(row.demonstrations));
}

}  // namespace

std::string phi(const RunResults& run, const Summary& summary, const RowNumbers& numbers) {
  const bool tell = has_unseen(run);
  std::string body;
  for (const PhiOfRow& of : distinct_phi(summary)) {
    const Row& row = *of.row;
    const Json& one = row.phi.at(of.command);
    for (const auto& [about, groups] : one.at("quality").items()) {
      if (groups.is_null()) continue;
      const std::string utterance = one.at("utterance"), asked_as = one.at("asked_as");
      std::vector<std::string> cells{escaped(row.scenario), named(row.method),
                                     escaped(utterance) + (!tell                        ? ""
                                                           : one.at("seen").get<bool>() ? " <small>seen</small>"
                                                                                        : " <small>unseen</small>"),
                                     about};
      for (const char* group : {"object_types", "textures"}) {
        const std::string numbers_at = fmt::format("phi/{}/quality/{}/{}/", of.command, about, group);
        for (const char* number : {"precision", "recall", "size"}) {
          const auto place = [&numbers_at](const char* member) { return numbers_at + member; };
          cells.push_back(*number == 's' ? fmt::format("<small class=size>{} of {}</small>",
                                                       phi_value(row, numbers, place("size"), "{:.4g}"),
                                                       phi_value(row, numbers, place("true_size"), "{:.4g}"))
                                         : phi_value(row, numbers, place(number), "{:.2f}"));
        }
      }
      cells.push_back(phi_value(row, numbers, fmt::format("phi/{}/lm_queries", of.command), "{:.4g}"));
      cells.push_back(phi_value(row, numbers, fmt::format("phi/{}/human_seconds", of.command), "{:.1f}"));
      cells.push_back(escaped(provenance_words(one.at("provenance"))));
      cells.push_back(escaped(one.at("source")));
      cells.push_back(asked_as.empty() || !worded_otherwise(asked_as, utterance) ? "as the command"
                                                                                 : "“" + escaped(asked_as) + "”");
      body += row_of(cells, 4);
    }
  }
  if (body.empty()) return "";
  return section(
      "phi", "The feature abstraction φ̂",
      table("What was selected, against the scenario’s true distribution; size: selected of true",
            {"scenario", "method", "command", "about", "types: precision", "recall", "size", "textures: precision",
             "recall", "size", "queries", "a person’s seconds", "answered by", "source", "asked as"},
            body, true));
}

std::string failures(const Summary& summary, const RowNumbers& numbers) {
  std::set<std::string> used;
  for (const Table& table : summary.tables)
    for (const Row& row : table.rows)
      for (const auto& item : row.failures) used.insert(item.first);
  if (used.empty()) return "";

  std::vector<std::string> shown, heads{"arm", "method", "demon&shy;strations", "of all episodes", "episodes"};
  std::vector<std::string> css;
  std::string key = "<ul class=legend>";
  const std::vector<std::string> all = failure_words();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (used.count(all[i]) == 0) continue;
    shown.push_back(all[i]);
    css.push_back(fmt::format("f{}", i));
    heads.push_back(fmt::format("<span class=\"swatch f{}\"></span>{}", i, words(all[i])));
    key += fmt::format("<li><span class=\"swatch f{}\"></span>{}</li>", i, words(all[i]));
  }
  std::string text = key + "</ul>";
  for (const Table& table_ : summary.tables) {
    std::string body;
    for (const Row& row : table_.rows) {
      if (!row.is_mean() || row.episodes == 0) continue;
      std::vector<Part> parts;
      std::vector<std::string> cells{escaped(row.arm), named(row.method), demonstrations(row, numbers), "",
                                     numbers.value(row, "episodes", std::to_string(row.episodes))};
      for (std::size_t i = 0; i < shown.size(); ++i) {
        const auto found = row.failures.find(shown[i]);
        const int n = found == row.failures.end() ? 0 : found->second;
        parts.push_back({css[i], words(shown[i]), n});
        cells.push_back(count(row, numbers, "failures/" + shown[i], n));
      }
      cells[3] = bar(parts, row.episodes);
      body += row_of(cells, 2);
    }
    text += table(fmt::format("Failed episodes by type, over all scenarios, {}", escaped(table_.title())), heads, body);
  }
  return section("failures", "Failures by type", text);
}

std::string attribution(const Summary& summary, const RowNumbers& numbers) {
  std::string text;
  for (const Table& table_ : summary.tables) {
    std::string mean, each;
    for (const Row& row : table_.rows) {
      if (row.attributed() == 0) continue;
      std::vector<Part> parts;
      std::vector<std::string> cells{row.is_mean() ? "all" : escaped(row.scenario), escaped(row.arm), named(row.method),
                                     demonstrations(row, numbers), ""};
      for (const char* to : attributions) {
        parts.push_back({to, to, row.attribution.at(to)});
        cells.push_back(numbers.value(row, fmt::format("attribution/{}", to), std::to_string(row.attribution.at(to))));
      }
      cells[4] = bar(parts, row.attributed());
      (row.is_mean() ? mean : each) += row_of(cells, 3);
    }
    if (mean.empty()) continue;
    const std::vector<std::string> heads{"scenario",
                                         "arm",
                                         "method",
                                         "demon&shy;strations",
                                         "share of failures",
                                         "<span class=\"swatch abstraction\"></span>abstraction",
                                         "<span class=\"swatch policy\"></span>policy"};
    text +=
        table(fmt::format("Failures attributed to abstraction or policy, {}", escaped(table_.title())), heads, mean) +
        "<details><summary>Each scenario</summary>" +
        table(fmt::format("Each scenario’s failures, {}", escaped(table_.title())), heads, each, true) + "</details>";
  }
  if (text.empty()) return "";
  return section(
      "attribution", "Abstraction or policy",
      "<p class=hint>A failure is attributed to the abstraction where the same policy wins the same scene with the "
      "true mask; else to the policy. Methods that select nothing are not listed.</p>" +
          text);
}

std::string times(const RunResults& run) {
  std::string body;
  for (const PhaseTimes& of : phase_times(run)) {
    std::vector<std::string> cells{escaped(of.layout + ", " + of.engine), named(of.method), std::to_string(of.cells)};
    for (const double s : of.mean_s) cells.push_back(fmt::format("{:.2f}", s));
    body += row_of(cells, 2);
  }
  if (body.empty()) return "";
  return section(
      "times", "Time per phase",
      table("Seconds a cell, on the mean",
            {"layout, engine", "method", "cells", "select", "sample", "demonstrate", "learn", "evaluate", "total"},
            body, true));
}

std::string failed_cells(const Summary& summary) {
  if (summary.failed.empty()) return "";
  std::string body;
  for (const CellResult& cell : summary.failed) {
    std::string log;
    for (const std::string& line : cell.log_tail) log += escaped(line) + "\n";
    body += row_of(
        {fmt::format("<code>{}</code>", escaped(cell.key)), named(cell.method), escaped(cell.scenario),
         escaped(cell.layout + ", " + cell.engine), std::to_string(cell.demonstrations),
         std::to_string(cell.training_seed), escaped(cell.fault),
         escaped(cell.reason) +
             (log.empty() ? ""
                          : fmt::format("<details><summary>end of its log</summary><pre>{}</pre></details>", log))},
        2);
  }
  return section(
      "failed", "Cells that failed",
      "<p class=hint>They count for nothing above.</p>" +
          table("Cells that failed",
                {"cell", "method", "scenario", "layout, engine", "demonstrations", "training seed", "fault", "reason"},
                body));
}

}  // namespace lgabench::report::html_parts

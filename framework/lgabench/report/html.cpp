#include <lgabench/report/html.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include <lgabench/report/html_parts.hpp>
#include <lgabench/report/names.hpp>
#include <lgabench/report/settings.hpp>

namespace lgabench::report {
namespace html_parts {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += std::iscntrl(static_cast<unsigned char>(c)) ? ' ' : c;
    }
  return out;
}

RowNumbers::RowNumbers(const Summary& summary) {
  for (const Table& table : summary.tables)
    for (const Row& row : table.rows) numbers_.emplace(&row, numbers_.size());
}

std::string RowNumbers::value(const Row& row, const std::string& member, const std::string& text) const {
  return fmt::format("<span data-value=\"/rows/{}/{}\">{}</span>", (*this)(row), member, text);
}

std::string row_of(const std::vector<std::string>& cells, std::size_t words) {
  std::string text = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i)
    text += i < words ? fmt::format("<th scope=row>{}</th>", cells[i]) : fmt::format("<td>{}</td>", cells[i]);
  return text + "</tr>\n";
}

std::string table(const std::string& caption, const std::vector<std::string>& heads, const std::string& body,
                  bool sortable) {
  std::string head;
  for (const std::string& one : heads) head += fmt::format("<th scope=col>{}</th>", one);
  return fmt::format(
      "<div class=frame tabindex=0 role=region "
      "aria-label=\"{0}\"><table{1}><caption><span>{0}</span></caption>\n<thead><tr>{2}</tr>"
      "</thead>\n<tbody>\n{3}</tbody></table></div>\n",
      caption, sortable ? " class=sortable" : "", head, body);
}

std::string section(const std::string& id, const std::string& title, const std::string& body) {
  return fmt::format("<section id={0} aria-labelledby=\"{0}-title\"><h2 id=\"{0}-title\">{1}</h2>\n{2}</section>\n", id,
                     title, body);
}

}  // namespace html_parts

namespace {

using namespace html_parts;

std::string definition(const std::string& name, const Json& value) {
  return fmt::format("<dt>{}</dt><dd>{}</dd>", escaped(name),
                     escaped(value.is_string() ? value.get<std::string>() : canonical(value)));
}

std::string pictures_note(const Pictures& pictures) {
  if (pictures.wanted == 0) return "";
  if (pictures.scenes.empty()) return fmt::format("No pictures of scenes: {}.", pictures.problem);
  std::string text = fmt::format(
      "Pictures: {} of the {} scenes in which a method failed (at most {}, each scenario’s "
      "first)",
      pictures.scenes.size(), pictures.wanted, most_pictures);
  return text + (pictures.problem.empty() ? "." : fmt::format("; others could not be drawn: {}.", pictures.problem));
}

// Who said which features matter, a line each: what is a measurement of people or of a language model, and what is not.
std::set<std::string> sources(const Summary& summary) {
  std::set<std::string> lines;
  for (const PhiOfRow& of : distinct_phi(summary)) {
    const Json& phi = of.row->phi.at(of.command);
    const std::string provenance = phi.at("provenance"), words = provenance_words(provenance),
                      source = phi.at("source");
    lines.insert(fmt::format("φ̂ of {}: {}{}.", display_name(of.row->method), words.empty() ? provenance : words,
                             source.empty() ? "" : ", " + source));
  }
  return lines;
}

// Cells, notes, and the commands that were given.
std::string what_was_run(const RunResults& run, const Summary& summary, const Pictures& pictures) {
  std::string text = "<ul class=cards>";
  const auto card = [&text](std::size_t n, const char* what, const char* css = "") {
    text += fmt::format("<li class=\"{}\"><b>{}</b> {}</li>", css, n, what);
  };
  const std::size_t failed = summary.failed.size();
  card(run.cells.size() - failed, "cells finished");
  if (failed > 0) card(failed, "cells failed", "bad");
  if (run.not_run > 0) card(static_cast<std::size_t>(run.not_run), "cells not run", "bad");
  std::size_t episodes = 0;
  for (const CellResult& cell : run.cells)
    for (const auto& item : cell.episodes) episodes += item.second.size();
  card(episodes, "episodes played");
  text += "</ul><ul class=notes>";
  for (const std::string& line : settings(run)) text += fmt::format("<li>{}</li>", escaped(line));
  for (const std::string& note : notes(run, summary)) text += fmt::format("<li>{}</li>", escaped(note));
  for (const std::string& line : method_errors(run, "")) text += fmt::format("<li class=bad>{}</li>", escaped(line));
  for (const std::string& line : sources(summary)) text += fmt::format("<li>{}</li>", escaped(line));
  if (const std::string note = pictures_note(pictures); !note.empty())
    text += fmt::format("<li>{}</li>", escaped(note));
  text += "</ul>";

  const bool tell = has_unseen(run);
  std::vector<std::string> commands;
  for (const CellResult& cell : run.cells)
    for (const CommandResult& command : cell.commands) {
      const std::string row =
          row_of({escaped(cell.scenario), escaped(command.utterance) + (!tell          ? ""
                                                                        : command.seen ? " <small>seen</small>"
                                                                                       : " <small>unseen</small>")});
      if (std::find(commands.begin(), commands.end(), row) == commands.end()) commands.push_back(row);
    }
  text += fmt::format(
      "<details{}><summary>The commands</summary>{}</details>", commands.size() <= 4 ? " open" : "",
      table("Scenarios and their commands", {"scenario", "command"}, fmt::format("{}", fmt::join(commands, ""))));
  return section("run", "What was run", text);
}

std::string provenance(const RunResults& run) {
  std::string text = "<dl>";
  for (const auto& [name, value] : run.json.items())
    if (value.is_primitive() && !value.is_null() && value != "") text += definition(name, value);
  for (const auto& [name, value] : run.json.at("machine").items()) text += definition("machine, " + name, value);
  for (const Json& plugin : run.json.value("plugins", Json::array()))
    text += definition("plugin " + plugin.value("id", ""),
                       fmt::format("{} {}, sha256 {:.16}", plugin.value("kind", ""), plugin.value("version", ""),
                                   plugin.value("sha256", "")));
  const Json builds = run.json.value("build", Json::object());
  for (const auto& [name, value] : builds.items())
    if (value.is_string()) text += definition(name, "sha256 " + value.get<std::string>().substr(0, 16));
  return section("provenance", "Provenance and machine", text + "</dl>");
}

// Every {{name}} of the template. Values are not searched again.
std::string filled(const std::string& page, const std::map<std::string, std::string>& values) {
  std::string out;
  std::size_t at = 0;
  for (std::size_t open; (open = page.find("{{", at)) != std::string::npos;) {
    const std::size_t close = page.find("}}", open);
    out += page.substr(at, open - at) + values.at(page.substr(open + 2, close - open - 2));
    at = close + 2;
  }
  return out + page.substr(at);
}

// JSON inside a script element: no text of it may end the element.
std::string embedded(const Json& json) {
  std::string text = canonical(json);
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) text.replace(at, 1, "\\u003c");
  return text;
}

}  // namespace

std::string html(const RunResults& run, const Summary& summary, const std::vector<Claim>& tested,
                 const std::vector<EngineAgreement>& agreements, const PaperValues& paper, const Pictures& pictures) {
  const fs::path installed = data_directory() / "page";
  const RowNumbers numbers(summary);
  const std::string body = what_was_run(run, summary, pictures) + success(summary, paper, numbers) +
                           arms(summary, paper, numbers) + scenarios(summary, paper, numbers) +
                           seen_inputs(summary, numbers) + claims(tested) + phi(run, summary, numbers) +
                           failures(summary, numbers) + attribution(summary, numbers) + engines(agreements, pictures) +
                           times(run) + failed_cells(summary) + provenance(run);
  return filled(read_file(installed / "page.html"), {{"suite", escaped(run.suite)},
                                                     {"style", read_file(installed / "page.css")},
                                                     {"body", body},
                                                     {"data", embedded(episodes(run, summary, pictures, numbers))},
                                                     {"script", read_file(installed / "page.js")}});
}

}  // namespace lgabench::report

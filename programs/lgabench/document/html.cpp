// report.html. Every number of a table that stands in summary.json or claims.json carries the JSON pointer to it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <utility>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/filled.hpp>
#include <lgabench/document/writers.hpp>

namespace lgabench::document {
namespace {

// Text for readers: words in place of ids.
std::string shown(const std::string& text) { return escaped(statistics::readable(text)); }

// A span without what is around it for its emphasis.
std::string words_html(const Span& span) {
  std::string text = span.emphasis == Emphasis::code ? escaped(span.text) : shown(span.text);
  if (!span.pointer.empty()) text = fmt::format("<span data-value=\"{}\">{}</span>", escaped(span.pointer), text);
  if (!span.title.empty()) text = fmt::format("<span title=\"{}\">{}</span>", escaped(span.title), text);
  return span.url.empty() ? text : fmt::format("<a href=\"{}\">{}</a>", escaped(span.url), text);
}

// Details side by side, as an interval's bounds and brackets, are one element: a narrow table sets it below the number.
std::string spans_html(const Spans& spans) {
  constexpr std::array<std::array<const char*, 2>, 8> around{{{"", ""},
                                                              {"<b>", "</b>"},
                                                              {"<i class=paper>", "</i>"},
                                                              {"<code>", "</code>"},
                                                              {"<small>", "</small>"},
                                                              {"<span class=better>", "</span>"},
                                                              {"<span class=worse>", "</span>"},
                                                              {"<span class=missed>", "</span>"}}};
  std::string text;
  for (std::size_t i = 0; i < spans.size(); ++i) {
    const auto is_detail = [&spans](std::size_t k) {
      return k < spans.size() && spans[k].emphasis == Emphasis::detail;
    };
    const auto& [open, close] = around[static_cast<std::size_t>(spans[i].emphasis)];
    if (!is_detail(i) || i == 0 || !is_detail(i - 1)) text += open;
    text += words_html(spans[i]);
    if (!is_detail(i) || !is_detail(i + 1)) text += close;
  }
  return text;
}

std::string bar_html(const std::vector<BarPart>& parts, int of) {
  std::string text = "<div class=bar aria-hidden=true>";
  for (const BarPart& part : parts)
    if (part.count > 0)
      text += fmt::format("<i class=\"{}\" style=\"width:{:.2f}%\" title=\"{}: {}\"></i>", part.kind,
                          100.0 * part.count / of, shown(part.name), part.count);
  return text + "</div>";
}

std::string cell_html(const TableCell& cell) {
  if (cell.bar_of > 0) return bar_html(cell.bar, cell.bar_of);
  std::string text = spans_html(cell.spans);
  if (cell.episodes && cell.rate)
    text = fmt::format("<button type=button class=rate data-row={} style=\"--rate:{:.0f}%\">{}</button>",
                       *cell.episodes, *cell.rate * 100, text);
  else if (cell.episodes)
    text = fmt::format("<button type=button class=count data-row={} data-outcome=\"{}\">{}</button>", *cell.episodes,
                       escaped(cell.outcome), text);
  if (!cell.link.empty()) text = fmt::format("<a href=\"{}\">{}</a>", escaped(cell.link), text);
  if (cell.style)
    text = fmt::format("<span class=\"name{}\">{}{}</span>", cell.style->reference() ? " reference" : "",
                       cell.style->reference() ? "" : svg_mark(*cell.style), text);
  if (!cell.log.empty()) text += "<details><summary>end of its log</summary><pre>";
  for (const std::string& line : cell.log) text += escaped(line) + '\n';
  if (!cell.log.empty()) text += "</pre></details>";
  return text;
}

bool is_published(const TableCell& cell) {
  return !cell.spans.empty() && cell.spans.front().emphasis == Emphasis::published;
}

// The groups' texts, but that of the paper's rows, which stand among others.
std::set<std::string> groups_of(const Grid& grid) {
  std::set<std::string> texts;
  for (const Grid::Row& row : grid.rows)
    if (!grid.group_head.empty() && !is_published(row.group)) texts.insert(row.group.text());
  return texts;
}

// Heads of settings, never of what was measured: only these may leave a table.
constexpr std::array settings_heads{"layout", "engine", "arm", "version", "table", "suite", "preset", "about"};

// Words that every row repeats in a column of settings, as "layout cells": the caption says them once.
std::vector<std::string> repeated(const Grid& grid) {
  std::vector<std::string> words(grid.heads.size());
  if (grid.rows.size() < 2) return words;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const TableCell& first = grid.rows.front().cells[i];
    const bool of_settings = contains(settings_heads, grid.heads[i].text());
    const bool plain = of_settings && !first.style && !first.episodes && first.bar_of == 0 && !first.text().empty() &&
                       !first.spans.front().numeric;
    if (plain && std::all_of(grid.rows.begin(), grid.rows.end(),
                             [&](const Grid::Row& row) { return row.cells[i].text() == first.text(); }))
      words[i] = grid.heads[i].text() + " " + first.text();
  }
  return words;
}

// What the table's symbols mean, each once.
std::string legend_html(const Grid& grid) {
  std::vector<std::pair<std::string, std::string>> all;
  const auto add = [&all](const std::string& symbol, const std::string& meaning) {
    if (!contains(all, std::pair(symbol, meaning))) all.emplace_back(symbol, meaning);
  };
  for (const Grid::Row& row : grid.rows)
    for (const TableCell& cell : row.cells)
      for (const Span& span : cell.spans) {
        if (span.emphasis == Emphasis::detail && span.text == " [") add("[low, high]", "95 % interval");
        if (span.numeric && !span.title.empty()) add(span.text, span.title);
      }
  std::string text;
  for (const auto& [symbol, meaning] : all)
    text += fmt::format("{}<b>{}</b> {}", text.empty() ? "" : "; ", escaped(symbol), shown(meaning));
  return text.empty() ? "" : "<p class=legend>" + text + "</p>\n";
}

// In a frame that scrolls sideways, with its caption. A group is a body of its own, below its name; columns up to the
// method's name head a row.
std::string grid_html(const Grid& grid) {
  std::string heads, body, group, caption = shown(grid.caption);
  const bool grouped = groups_of(grid).size() > 1;
  const std::vector<std::string> said = repeated(grid);
  for (const std::string& words : said)
    if (!words.empty()) caption += "; " + shown(words);
  const auto shown = std::count(said.begin(), said.end(), "");
  const auto head = [&heads](const TableCell& cell) {
    heads +=
        fmt::format("<th scope=col>{}{}</th>",
                    cell.bar.empty() ? "" : fmt::format("<span class=\"swatch {}\"></span>", cell.bar.front().kind),
                    spans_html(cell.spans));
  };
  for (std::size_t i = 0; i < grid.heads.size(); ++i)
    if (said[i].empty()) head(grid.heads[i]);
  for (const Grid::Row& row : grid.rows) {
    if (grouped && !is_published(row.group) && row.group.text() != group) {
      if (!group.empty()) body += "</tbody>\n<tbody>\n";
      group = row.group.text();
      body += fmt::format("<tr class=group><th scope=rowgroup colspan={}>{}</th></tr>\n", shown, cell_html(row.group));
    }
    std::size_t headed = 0;
    while (headed < row.cells.size() && !row.cells[headed].style) ++headed;
    if (headed == row.cells.size()) headed = 0;  // no method: the first column
    body += row.reference && row.more ? "<tr class=\"reference more\">"
            : row.reference           ? "<tr class=reference>"
            : row.more                ? "<tr class=more>"
                                      : "<tr>";
    for (std::size_t i = 0; i < row.cells.size(); ++i)
      if (said[i].empty())
        body += fmt::format(i <= headed ? "<th scope=row>{}</th>" : "<td>{}</td>", cell_html(row.cells[i]));
    body += "</tr>\n";
  }
  return fmt::format(
      "<div class=frame tabindex=0 role=region aria-label=\"{0}\"><table{1}><caption><span>{0}</span></caption>\n"
      "<thead><tr>{2}</tr></thead>\n<tbody>\n{3}</tbody></table></div>\n{4}",
      caption, grid.rows.size() > 1 ? " class=sortable" : "", heads, body, legend_html(grid));
}

Chart readable(Chart chart) {
  for (std::string* text : {&chart.title, &chart.subtitle, &chart.axis, &chart.values, &chart.alternative})
    *text = statistics::readable(*text);
  for (Chart::Tick& tick : chart.ticks) tick.label = statistics::readable(tick.label);
  for (Series& series : chart.series) {
    series.name = statistics::readable(series.name);
    for (ChartPoint& point : series.points) point.label = statistics::readable(point.label);
  }
  return chart;
}

// A chart alone is as wide as the page, and drawn once more for a narrow one, so that its text has its size on both.
std::string charts_html(const Charts& charts) {
  constexpr double wide = 1000, narrow = 420;
  const bool alone = charts.charts.size() == 1;
  std::string text = fmt::format("<div class=\"charts{}\">", charts.charts.front().legend ? "" : " small");
  for (Chart chart : charts.charts) {
    chart = readable(std::move(chart));
    if (!chart.legend || chart.heat) {
      text += "<figure>" + svg(chart, false) + "</figure>";
      continue;
    }
    if (alone) chart.width = wide;
    text += "<figure class=wide>" + svg(chart, false) + "</figure>";
    chart.width = narrow;
    text += "<figure class=narrow>" + svg(chart, false) + "</figure>";
  }
  return text + "</div>\n";
}

std::string pictures_html(const PictureRow& row) {
  std::string text;
  const std::string where = escaped(row.caption);
  for (const auto& [caption, png] : row.pictures)
    text += fmt::format(
        "<div><img width=256 height=128 alt=\"{}: {}\" src=\"data:image/png;base64,{}\"><br><small>{}</small></div>",
        where, escaped(caption), png, escaped(caption));
  return fmt::format("<figure class=engines><div class=pair>{}</div><figcaption>{}</figcaption></figure>\n", text,
                     where);
}

std::string block_html(const Block& block) {
  std::string text;
  if (const auto* heading = std::get_if<Heading>(&block.content)) text = "<h3>" + shown(heading->text) + "</h3>\n";
  if (const auto* words = std::get_if<Paragraph>(&block.content))
    text = "<p class=hint>" + spans_html(words->spans) + "</p>\n";
  if (const auto* list = std::get_if<List>(&block.content)) {
    for (const Spans& item : list->items) text += "<li>" + spans_html(item) + "</li>\n";
    text = "<ul>\n" + text + "</ul>\n";
  }
  if (const auto* facts = std::get_if<Facts>(&block.content)) {
    for (const auto& [name, value] : facts->items)
      text += fmt::format(facts->prose ? "<dt>{}</dt><dd>{}</dd>" : "<dt>{}</dt><dd><code>{}</code></dd>", shown(name),
                          escaped(value));
    text = "<dl>" + text + "</dl>\n";
  }
  if (const auto* grid = std::get_if<Grid>(&block.content)) text = grid_html(*grid);
  if (const auto* charts = std::get_if<Charts>(&block.content)) text = charts_html(*charts);
  if (const auto* pictures = std::get_if<PictureRow>(&block.content)) text = pictures_html(*pictures);
  if (block.folded.empty()) return text;
  return fmt::format("<details><summary>{}</summary>\n{}</details>\n", shown(block.folded), text);
}

std::string notes_html(const Document& document) {
  std::string text;
  for (const Note& note : document.notes)
    text += fmt::format("<li{}>{}{}</li>\n", note.kind == Note::error ? " class=bad" : "",
                        note.kind == Note::error ? escaped(note.text) : shown(note.text),
                        note.log.empty() ? "" : fmt::format(" ({})", escaped(note.log)));
  if (text.empty()) return "";
  const std::size_t errors = static_cast<std::size_t>(
      std::count_if(document.notes.begin(), document.notes.end(), [](const Note& n) { return n.kind == Note::error; }));
  return fmt::format(
      "<details class=notes{}><summary>Notes about this run ({}{})</summary>\n<ul "
      "class=notes>\n{}</ul></details>\n",
      errors ? " open" : "", document.notes.size(), errors ? fmt::format(", {} of them errors", errors) : "", text);
}

// The arms' names, what their scenes are, and one of these each.
std::string arms_html(const Document& document) {
  std::string text;
  for (const ArmLine& arm : document.arms) {
    const std::string picture = arm.png.empty() ? ""
                                                : fmt::format(
                                                      "<img width=160 height=80 alt=\"A scene of the arm {0}\" "
                                                      "src=\"data:image/png;base64,{1}\">",
                                                      shown(arm.title), arm.png);
    if (arm.text.empty() && picture.empty() && arm.title == arm.name) continue;
    text += fmt::format("<li>{}<b>{}{}</b><span>{}</span></li>\n", picture, shown(arm.title),
                        arm.title == arm.name ? "" : " <code>" + escaped(arm.name) + "</code>", shown(arm.text));
  }
  return text.empty() ? "" : "<ul class=arms aria-label=\"Arms of the test\">\n" + text + "</ul>\n";
}

// JSON inside a script element: no text of it may end the element.
std::string embedded(const Json& json) {
  std::string text = canonical(json);
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) text.replace(at, 1, "\\u003c");
  return text;
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const char* entity = c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : nullptr;
    if (entity)
      out += entity;
    else
      out += std::iscntrl(static_cast<unsigned char>(c)) ? ' ' : c;
  }
  return out;
}

std::string html(const Document& document, const Json& data, const std::string& script) {
  std::string body;
  if (!document.question.empty()) body += "<p class=question>" + escaped(document.question) + "</p>\n";
  if (!document.headline.empty()) body += "<p class=headline>" + spans_html(document.headline) + "</p>\n";
  if (!document.setting.empty()) body += "<p class=hint>" + spans_html(document.setting) + "</p>\n";
  const auto first = std::find_if(document.sections.begin(), document.sections.end(),
                                  [](const Section& section) { return (section.in & on_page) != 0; });
  // The arms stand below the first section's charts, whose places they explain.
  const auto has_charts = [](const Block& block) {
    return (block.in & on_page) != 0 && block.folded.empty() && std::holds_alternative<Charts>(block.content);
  };
  std::string arms = arms_html(document);
  if (first == document.sections.end() || std::none_of(first->blocks.begin(), first->blocks.end(), has_charts))
    body += std::exchange(arms, "");
  body += notes_html(document);
  for (const Section& section : document.sections) {
    if ((section.in & on_page) == 0) continue;
    std::string blocks;
    for (const Block& block : section.blocks) {
      if ((block.in & on_page) != 0) blocks += block_html(block);
      if (has_charts(block)) blocks += std::exchange(arms, "");
    }
    body +=
        fmt::format("<section id=\"{0}\" aria-labelledby=\"{0}-title\"><h2 id=\"{0}-title\">{1}</h2>\n{2}</section>\n",
                    section.id, shown(section.title), blocks);
  }
  const fs::path installed = data_directory() / "page", style = installed / fs::path(script).replace_extension(".css");
  std::string summary = document.description;  // for those to whom the page is sent
  if (summary.empty())
    for (const Span& span : document.headline) summary += span.text;
  return filled(read_file(installed / "page.html"),
                {{"{{title}}", shown(document.title)},
                 {"{{summary}}", shown(summary.empty() ? document.question : summary)},
                 {"{{first}}", first == document.sections.end() ? "" : first->id},
                 {"{{style}}", read_file(installed / "page.css") + (fs::exists(style) ? read_file(style) : "")},
                 {"{{body}}", body},
                 {"{{data}}", embedded(data)},
                 {"{{script}}", read_file(installed / "page.js") + read_file(installed / script)}});
}

}  // namespace lgabench::document

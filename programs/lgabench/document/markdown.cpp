// report.md.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include <lgabench/core/terminal.hpp>
#include <lgabench/document/writers.hpp>

namespace lgabench::document {
namespace {

// Text from a file inside a Markdown table's cell: it may neither end the cell nor the line.
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

std::string markdown_text(const Spans& spans) {
  std::string text;
  for (const Span& span : spans) {
    const std::string words = span.numeric ? span.text : plain(span.text);
    const char* around = span.emphasis == Emphasis::strong      ? "**"
                         : span.emphasis == Emphasis::published ? "*"
                         : span.emphasis == Emphasis::code      ? "`"
                                                                : "";
    text += span.url.empty() ? around + words + around : fmt::format("[{}]({})", words, span.url);
  }
  return text;
}

std::string row_of(const std::vector<std::string>& cells) { return fmt::format("| {} |\n", fmt::join(cells, " | ")); }

std::string grid_text(const Grid& grid) {
  const auto line = [&grid](const TableCell& group, const std::vector<TableCell>& cells) {
    std::vector<std::string> texts;
    if (!grid.group_head.empty()) texts.push_back(markdown_text(group.spans));
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (i != grid.bars) texts.push_back(markdown_text(cells[i].spans));
    return row_of(texts);
  };
  std::vector<std::string> rules;
  for (const char side : grid.text_align()) rules.emplace_back(side == 'r' ? "---:" : "---");
  std::string text = line(Span(grid.group_head), grid.heads) + row_of(rules);
  for (const Grid::Row& row : grid.rows) text += line(row.group, row.cells);
  return text;
}

std::string markdown_block(const Block& block) {
  std::string text;
  if (const auto* heading = std::get_if<Heading>(&block.content)) text = "### " + plain(heading->text) + '\n';
  if (const auto* paragraph = std::get_if<Paragraph>(&block.content)) text = markdown_text(paragraph->spans) + '\n';
  if (const auto* list = std::get_if<List>(&block.content))
    for (const Spans& item : list->items) text += "- " + markdown_text(item) + '\n';
  if (const auto* facts = std::get_if<Facts>(&block.content))
    for (const auto& [name, value] : facts->items) text += fmt::format("- {}: {}\n", plain(name), plain(value));
  if (const auto* grid = std::get_if<Grid>(&block.content)) text = grid_text(*grid);
  if (const auto* charts = std::get_if<Charts>(&block.content))
    for (const Chart& chart : charts->charts)
      if (!chart.file.empty())
        text +=
            fmt::format("{}![{}](figures/{}.svg)\n", text.empty() ? "" : "\n", plain(chart.alternative), chart.file);
  return text;
}

}  // namespace

std::string markdown(const Section& section) {
  std::string text;
  for (const Block& block : section.blocks)
    if (const std::string words = markdown_block(block); (block.in & in_markdown) != 0 && !words.empty())
      text += (block.lead.empty() ? "" : '\n' + plain(block.lead) + '\n') + '\n' + words;
  return text;
}

std::string markdown(const Document& document) {
  std::string text = fmt::format("# {}\n\n", plain(document.title));
  if (!document.question.empty()) text += plain(document.question) + "\n\n";
  if (!document.headline.empty()) text += markdown_text(document.headline) + "\n\n";
  if (!document.setting.empty()) text += markdown_text(document.setting) + "\n\n";
  for (const ArmLine& arm : document.arms)
    if (!arm.text.empty())
      text += fmt::format("- {}`{}`: {}\n", arm.title == arm.name ? "" : plain(arm.title) + ", ", arm.name,
                          plain(arm.text));
  if (!document.arms.empty()) text += '\n';
  for (const Note& note : document.notes)
    if (note.kind != Note::source)
      text +=
          fmt::format("> {}{}  \n", plain(note.text), note.log.empty() ? "" : fmt::format(" ({})", plain(note.log)));
  for (const Section& section : document.sections) {
    if (const std::string words = markdown(section); (section.in & in_markdown) != 0 && !words.empty())
      text += fmt::format("\n## {}\n", plain(section.title)) + words;
  }
  return text;
}

}  // namespace lgabench::document

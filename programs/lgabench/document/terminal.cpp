// A document for a terminal: fixed width, without colour.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include <lgabench/document/writers.hpp>

namespace lgabench::document {
namespace {

std::size_t display_width(const std::string& text) {  // of UTF-8 without wide or combining characters
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, display_width(text)), ' ');
}

std::string text_of(const Spans& spans) { return TableCell(spans).text(); }

constexpr std::size_t indent = 2, gap = 2, widest = 132;  // columns of a terminal

std::vector<std::size_t> widths_of(const Grid& grid) {
  std::vector<std::size_t> wide(grid.heads.size());
  for (std::size_t i = 0; i < wide.size(); ++i) {
    wide[i] = display_width(grid.heads[i].text());
    if (i == 0 && !grid.group_head.empty()) wide[i] -= std::min(indent, wide[i]);  // such a corner has no indent
    for (const Grid::Row& row : grid.rows) wide[i] = std::max(wide[i], display_width(row.cells[i].text()));
    wide[i] += gap;
  }
  return wide;
}

// A table that is too wide as several, of about as many columns each, below each other.
std::vector<Grid> narrow(const Grid& grid) {
  const std::vector<std::size_t> wide = widths_of(grid);
  const std::size_t all = std::accumulate(wide.begin(), wide.end(), indent), columns = wide.size() - 1;
  if (all <= widest || columns < 2 || grid.group_head.empty()) return {grid};
  const std::size_t room = widest - std::min(widest - 1, wide.front() + indent),
                    parts = std::min(columns, (all - wide.front() - indent + room - 1) / room);
  std::vector<Grid> grids;
  for (std::size_t part = 0; part < parts; ++part) {
    const auto begin = static_cast<std::ptrdiff_t>(1 + part * columns / parts),
               end = static_cast<std::ptrdiff_t>(1 + (part + 1) * columns / parts);
    const auto some = [&](const std::vector<TableCell>& cells) {
      std::vector<TableCell> kept{cells.front()};
      kept.insert(kept.end(), cells.begin() + begin, cells.begin() + end);
      return kept;
    };
    Grid& one = grids.emplace_back(grid);
    if (part > 0) one.caption.clear();
    one.heads = some(grid.heads);
    for (std::size_t i = 0; i < grid.rows.size(); ++i) one.rows[i].cells = some(grid.rows[i].cells);
  }
  return grids;
}

std::string one_table(const Grid& grid) {
  const std::vector<std::size_t> wide = widths_of(grid);
  std::string text = grid.caption.empty() ? "" : grid.caption + "\n\n";
  const auto line = [&](const std::vector<TableCell>& cells, std::size_t inset) {
    std::string row;
    for (std::size_t i = 0; i < cells.size(); ++i)
      row += i == 0 ? padded(std::string(inset, ' ') + cells[i].text(), wide[i] + indent)
                    : padded(cells[i].text(), wide[i]);
    text += row.erase(row.find_last_not_of(' ') + 1) + '\n';
  };
  line(grid.heads, grid.group_head.empty() ? indent : 0);
  std::size_t all = 0;
  for (const std::size_t one : wide) all += one;
  const Grid::Row* before = nullptr;
  for (const Grid::Row& row : grid.rows) {
    const bool first = !before || before->group.text() != row.group.text();
    if (first && !grid.group_head.empty()) text += '\n' + row.group.text() + '\n';
    if (row.reference && (first || !before->reference)) text += "  " + std::string(all - gap, '-') + '\n';
    line(row.cells, indent);
    before = &row;
  }
  return text;
}

}  // namespace

std::string terminal(const Grid& grid) {
  std::string text;
  for (const Grid& one : narrow(grid)) text += (text.empty() ? "" : "\n") + one_table(one);
  return text;
}

namespace {

std::string terminal_block(const Block& block) {
  if (const Grid* grid = std::get_if<Grid>(&block.content)) return terminal(*grid) + '\n';
  std::string text;
  if (const List* list = std::get_if<List>(&block.content))
    for (const Spans& item : list->items) text += text_of(item) + '\n';
  if (const Paragraph* paragraph = std::get_if<Paragraph>(&block.content)) text = text_of(paragraph->spans) + '\n';
  return text;
}

}  // namespace

std::string terminal(const Section& section) {
  std::string text;
  for (const Block& block : section.blocks)
    if ((block.in & in_terminal) != 0) text += terminal_block(block);
  return text;
}

std::string terminal(const Document& document, const fs::path& run) {
  std::string text;
  for (const Note& note : document.notes)
    if (note.kind == Note::setting) text += fmt::format("{}: {}\n", document.suite, note.text);
  if (!text.empty()) text += '\n';
  for (const Section& section : document.sections)
    if ((section.in & in_terminal) != 0) text += terminal(section);
  for (const Note& note : document.notes)
    if (note.kind == Note::note)
      text += note.text + '\n';
    else if (note.kind == Note::error)
      text += fmt::format("{} ({})\n", note.text, (run / note.log).string());
  return text;
}

}  // namespace lgabench::document

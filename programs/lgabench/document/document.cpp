#include <lgabench/document/document.hpp>

namespace lgabench::document {

Span Span::number(std::string text, std::string pointer, Emphasis how) {
  Span span(std::move(text), how);
  span.pointer = std::move(pointer);
  span.numeric = true;
  return span;
}

Span Span::link(std::string words, std::string url) {
  Span span(std::move(words));
  span.url = std::move(url);
  return span;
}

std::string TableCell::text() const {
  std::string all;
  for (const Span& span : spans) all += span.text;
  return all;
}

std::string Grid::text_align() const {
  std::string text = align;
  if (bars) text.erase(*bars + (group_head.empty() ? 0 : 1), 1);
  return text;
}

void put(Grid& grid, TableCell head, char align, TableCell cell) {
  if (grid.rows.size() == 1) {
    grid.heads.push_back(std::move(head));
    grid.align += align;
  }
  grid.rows.back().cells.push_back(std::move(cell));
}

std::vector<const Grid*> Document::grids() const {
  std::vector<const Grid*> all;
  for (const Section& section : sections)
    for (const Block& block : section.blocks)
      if (const Grid* grid = std::get_if<Grid>(&block.content); grid && !grid->name.empty()) all.push_back(grid);
  return all;
}

std::vector<const Chart*> Document::charts() const {
  std::vector<const Chart*> all;
  for (const Section& section : sections)
    for (const Block& block : section.blocks)
      if (const Charts* charts = std::get_if<Charts>(&block.content))
        for (const Chart& chart : charts->charts)
          if (!chart.file.empty()) all.push_back(&chart);
  return all;
}

}  // namespace lgabench::document

// A table that is written cell by cell.
#pragma once
#include <utility>

#include <lgabench/document/document.hpp>

namespace lgabench::report {

/// Appends a cell to the grid's last row. The first row's cells bring their columns' heads and alignment, l or r.
inline void put(Grid& grid, TableCell head, char align, TableCell cell) {
  if (grid.rows.size() == 1) {
    grid.heads.push_back(std::move(head));
    grid.align += align;
  }
  grid.rows.back().cells.push_back(std::move(cell));
}

}  // namespace lgabench::report

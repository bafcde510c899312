// Figures of a table, drawn by gnuplot.
#pragma once
#include <string>
#include <vector>

#include <lgabench/report/paper.hpp>
#include <lgabench/report/summary.hpp>

namespace lgabench::report {

/// A figure in RUN/figures: the SVG, and beside it the gnuplot script with its data that drew it.
struct Figure {
  std::string title;    // one line, e.g. "success against demonstrations"
  std::string file;     // relative to the run, e.g. "figures/success_cells_mujoco.svg"
  std::string problem;  // why there is no SVG; empty if there is
};

/// Draws the mean over scenarios with whiskers for the 95 % intervals. Several numbers of demonstrations: a figure an
/// arm, of curves, the paper's dashed, with its error bars. One number: a single figure, bars grouped by arm. Reference
/// rows are thin lines. Byte-stable for one version of gnuplot. A gnuplot that is missing or fails is the Figure's
/// problem, not an error.
/// @throws InputError if a file cannot be written.
std::vector<Figure> draw_figures(const fs::path& run, const std::string& suite, const Table& table,
                                 const PaperValues& paper);

/// The scripts that draw_figures runs; "" for a table without a finished cell.
std::string curves_script(const std::string& suite, const Table& table, const std::string& arm,
                          const PaperValues& paper);
std::string bars_script(const std::string& suite, const Table& table);

}  // namespace lgabench::report

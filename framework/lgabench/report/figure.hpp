// Success against demonstrations, drawn by gnuplot.
#pragma once
#include <string>

#include <lgabench/report/paper.hpp>
#include <lgabench/report/summary.hpp>

namespace lgabench::report {

/// A figure in RUN/figures: the SVG, and beside it the gnuplot script with its data that drew it.
struct Figure {
  std::string file;     // relative to the run, e.g. "figures/success_cells_mujoco.svg"
  std::string problem;  // why there is no SVG; empty if there is
};

/// Draws the mean over scenarios with whiskers for the 95 % intervals, the paper's values dashed, reference rows as
/// thin lines. Byte-stable for one version of gnuplot. A gnuplot that is missing or fails is the Figure's problem, not
/// an error.
/// @throws InputError if a file cannot be written.
Figure draw_figure(const fs::path& run, const std::string& suite, const Table& table, const PaperValues& paper);

/// The script that draw_figure runs; "" for a table without a finished cell.
std::string figure_script(const std::string& suite, const Table& table, const PaperValues& paper);

}  // namespace lgabench::report

// Tables as LaTeX, with the rules of booktabs.
#include <fmt/format.h>

#include <map>

#include <lgabench/core/terminal.hpp>
#include <lgabench/document/canvas.hpp>
#include <lgabench/document/writers.hpp>

namespace lgabench::document {
namespace {

// Text as LaTeX sets it in any encoding: what is no ASCII becomes a command where one is known.
std::string tex(const std::string& words) {
  static const std::map<char32_t, const char*> commands{{'&', "\\&"},
                                                        {'%', "\\%"},
                                                        {'$', "\\$"},
                                                        {'#', "\\#"},
                                                        {'_', "\\_"},
                                                        {'{', "\\{"},
                                                        {'}', "\\}"},
                                                        {'~', "\\textasciitilde{}"},
                                                        {'^', "\\textasciicircum{}"},
                                                        {'\\', "\\textbackslash{}"},
                                                        {'<', "\\textless{}"},
                                                        {'>', "\\textgreater{}"},
                                                        {'|', "\\textbar{}"},
                                                        {U'†', "\\textdagger{}"},
                                                        {U'‡', "\\textdaggerdbl{}"},
                                                        {U'§', "\\textsection{}"},
                                                        {U'¶', "\\textparagraph{}"},
                                                        {U'–', "--"},
                                                        {U'−', "$-$"},
                                                        {U'±', "$\\pm$"},
                                                        {U'’', "'"},
                                                        {U'“', "``"},
                                                        {U'”', "''"},
                                                        {U'φ', "$\\hat\\varphi$"},
                                                        {0x302, ""}};  // φ̂ is φ and a hat
  std::string out;
  for (const char32_t c : characters(one_line(words))) {
    const auto command = commands.find(c);
    out += command != commands.end() ? command->second : c < 0x80 ? std::string(1, static_cast<char>(c)) : "?";
  }
  return out;
}

std::string tex(const TableCell& cell) {
  std::string out;
  for (const Span& span : cell.spans)
    out += span.emphasis == Emphasis::published ? "\\emph{" + tex(span.text) + "}" : tex(span.text);
  return out;
}

}  // namespace

std::string latex(const Grid& grid) {
  std::string text = fmt::format("% {}\n% \\usepackage{{booktabs}}\n\\begin{{tabular}}{{{}}}\n\\toprule\n",
                                 one_line(grid.caption), grid.text_align());
  const auto line = [&](const std::string& group, const std::vector<TableCell>& cells) {
    std::string row = group;
    bool first = grid.group_head.empty();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (i == grid.bars) continue;
      row += (first ? "" : " & ") + tex(cells[i]);
      first = false;
    }
    text += row + " \\\\\n";
  };
  line(tex(grid.group_head), grid.heads);
  const Grid::Row* before = nullptr;
  for (const Grid::Row& row : grid.rows) {
    const bool first = !before || before->group.text() != row.group.text();
    if (!before || (!grid.group_head.empty() && first)) text += "\\midrule\n";
    line(first ? tex(row.group) : "", row.cells);
    before = &row;
  }
  return text + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace lgabench::document

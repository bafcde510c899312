#include <set>

#include <lgabench/document/writers.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench::document {
namespace {

using Names = std::set<std::string>;

// Removes what an earlier report wrote and this one does not: files of these kinds with other names.
void remove_others(const fs::path& directory, const Names& kinds, const Names& names) {
  std::vector<fs::path> others;
  std::error_code none_there;
  for (const auto& entry : fs::directory_iterator(directory, none_there))
    if (const fs::path& file = entry.path(); kinds.count(file.extension()) != 0 && names.count(file.stem()) == 0)
      others.push_back(file);
  for (const fs::path& file : others) fs::remove(file, none_there);
}

}  // namespace

void write_document(const fs::path& directory, const Document& document, const Json& data) {
  Names figures, tables;
  for (const Chart* chart : document.charts()) {
    figures.insert(chart->file);
    write_file(directory / report_file::figures / (chart->file + ".svg"), svg(*chart, true) + "\n");
    write_file(directory / report_file::figures / (chart->file + ".pdf"), pdf(*chart));
  }
  for (const Grid* grid : document.grids()) {
    tables.insert(grid->name);
    write_file(directory / report_file::tables / (grid->name + ".tex"), latex(*grid));
    write_file(directory / report_file::tables / (grid->name + ".csv"), csv(*grid));
  }
  remove_others(directory / report_file::figures, {".svg", ".pdf"}, figures);
  remove_others(directory / report_file::tables, {".tex", ".csv"}, tables);
  write_file(directory / report_file::markdown, markdown(document));
  write_file(directory / report_file::page, html(document, data));
}

}  // namespace lgabench::document

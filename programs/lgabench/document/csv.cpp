// Tables as CSV (RFC 4180).
#include <cstdlib>
#include <string_view>

#include <lgabench/core/terminal.hpp>
#include <lgabench/document/writers.hpp>

namespace lgabench::document {
namespace {

bool is_number(const std::string& text) {
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return end == text.c_str() + text.size();
}

std::string quoted(const std::string& words) {
  constexpr std::string_view formula = "=+-@";
  std::string text = one_line(words);
  if (!text.empty() && formula.find(text.front()) != formula.npos && !is_number(text))
    text.insert(0, 1, '\'');  // no spreadsheet takes it for a formula
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2) text.insert(at, 1, '"');
  return '"' + text + '"';
}

}  // namespace

std::string csv_line(const std::vector<std::string>& values) {
  std::string line;
  for (std::size_t i = 0; i < values.size(); ++i) line += (i == 0 ? "" : ",") + quoted(values[i]);
  return line + '\n';
}

std::string csv_text(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return canonical(value);
  std::string words;
  for (const Json& one : value) words += (words.empty() ? "" : " ") + csv_text(one);
  return words;
}

std::string csv(const Grid& grid) {
  std::string text;
  const auto line = [&](const TableCell& group, const std::vector<TableCell>& cells) {
    std::vector<std::string> values;
    if (!grid.group_head.empty()) values.push_back(group.text());
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (i != grid.bars) values.push_back(cells[i].text());
    text += csv_line(values);
  };
  line(grid.group_head, grid.heads);
  for (const Grid::Row& row : grid.rows) line(row.group, row.cells);
  return text;
}

}  // namespace lgabench::document

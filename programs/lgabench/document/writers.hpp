// From a document to what people read. A writer sets text and draws; it knows no method, no scenario and no number.
#pragma once
#include <string>

#include <lgabench/core/files.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/document/document.hpp>

namespace lgabench::document {

/// A document for a terminal, in columns, without colour; logs are named with the run's directory before them.
std::string terminal(const Document& document, const fs::path& run);
/// What of a section belongs in a terminal; and a table as it stands there.
std::string terminal(const Section& section);
std::string terminal(const Grid& grid);

/// report.md. Charts are named as RUN/figures/FILE.svg.
std::string markdown(const Document& document);
/// A section without its title, each block after an empty line.
std::string markdown(const Section& section);

/// A table for a paper: a tabular with the rules of the package booktabs. Pure ASCII; a character that LaTeX has no
/// command for here becomes "?".
std::string latex(const Grid& grid);
/// A table as CSV. A text that begins like a formula (=, +, -, @) gets an apostrophe in front.
std::string csv(const Grid& grid);
/// A line of a CSV file; and a JSON value as text for it: "" for null, a list's elements with spaces between.
std::string csv_line(const std::vector<std::string>& values);
std::string csv_text(const Json& value);

/// One page with everything inside it, from the installed page/ (template, style sheet, what all pages do), and the
/// `data` that page/SCRIPT shows; a style sheet of the script's name adds to the common one. Scripts add interaction
/// only. @throws InputError where page/ is missing.
std::string html(const Document& document, const Json& data, const std::string& script = "episodes.js");
/// Text as it may stand in an element or a quoted attribute.
std::string escaped(const std::string& text);

/// What a page without episodes shows on a click: nothing.
inline Json no_episodes() { return {{"titles", Json::array()}}; }

/// Writes a document's report.md, report.html (`data`: as html() takes it), figures/ and tables/ into the directory.
/// Figures and tables that are there of another report are removed.
void write_document(const fs::path& directory, const Document& document, const Json& data = no_episodes());

}  // namespace lgabench::document

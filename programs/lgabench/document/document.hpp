// A report as a value: sections of text, tables and figures. Every number in it was computed before; the writers
// (writers.hpp) only set it.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <lgabench/document/chart.hpp>

namespace lgabench::document {

/// Who shows a part, as a set of bits: not everything that belongs on a page belongs in a terminal.
using Media = unsigned;
constexpr Media in_terminal = 1, in_markdown = 2, on_page = 4, reading = in_markdown | on_page,
                everywhere = reading | in_terminal;

enum class Emphasis {
  none,
  strong,
  published,
  code,
  detail,
  better,
  worse,
  missed
};  // published: a value of the paper's

/// A piece of text.
struct Span {
  Span(std::string words, Emphasis how = Emphasis::none) : text(std::move(words)), emphasis(how) {}
  Span(const char* words) : text(words) {}
  /// A number or what stands around it, with the JSON pointer to its place: into claims.json where it begins with
  /// /claims, else into summary.json; "" for a number that stands in neither.
  static Span number(std::string text, std::string pointer = "", Emphasis how = Emphasis::none);

  /// Words that lead to a page.
  static Span link(std::string words, std::string url);

  std::string text, pointer, url{};
  std::string title{};  // what a page says of it under the pointer
  Emphasis emphasis = Emphasis::none;
  bool numeric = false;  // the program's own, and needs no escape in Markdown
};
using Spans = std::vector<Span>;

/// Counts side by side as one bar; `kind` names its colour on the page.
struct BarPart {
  std::string kind, name;
  int count = 0;
};

/// Colours that page/page.css has for failures, as classes f0, f1 and so on: one for each of failure_words().
constexpr std::ptrdiff_t failure_colours = 16;

struct TableCell {
  TableCell() = default;
  TableCell(const char* words) : spans{words} {}
  TableCell(std::string words) : spans{Span(std::move(words))} {}
  TableCell(Span span) : spans{std::move(span)} {}
  TableCell(Spans all) : spans(std::move(all)) {}
  std::string text() const;  // of the spans, as they are

  Spans spans;
  std::optional<statistics::MethodStyle> style;  // of the method that the cell names: the page shows its mark
  std::optional<std::size_t> episodes;           // of a row of summary.json: the page shows its episodes on a click
  std::string outcome;                           // of these episodes: a failure's words; "" for all
  std::optional<double> rate;                    // shown as a bar behind the number
  std::vector<BarPart> bar;
  int bar_of = 0;                // the bar's whole width
  std::vector<std::string> log;  // lines, folded
  std::string link{};            // where a page leads from it
};

/// A table. Its rows have a cell for each head; rows with equal `group` belong together, which is a column of its own
/// (`group_head`) but in a terminal.
struct Grid {
  struct Row {
    TableCell group;
    std::vector<TableCell> cells;
    bool reference = false;  // set apart from the rows above
    bool more = false;       // a page shows it only when asked for all rows
  };
  std::string name;  // of its files: letters, digits, "_" and "-"
  std::string caption, group_head;
  std::vector<TableCell> heads;
  std::string align;                  // of each column, the group's first: l or r, as in LaTeX
  std::optional<std::size_t> bars{};  // the head of a column of bars, which the page alone has
  std::vector<Row> rows;

  /// `align` without the column of bars.
  std::string text_align() const;
};

/// Appends a cell to the grid's last row. The first row's cells bring their columns' heads and alignment, l or r.
void put(Grid& grid, TableCell head, char align, TableCell cell);

struct Heading {
  std::string text;
};
struct Paragraph {
  Spans spans;
};
struct List {
  std::vector<Spans> items;
};
/// Names and their values, shown as code unless they are `prose`.
struct Facts {
  std::vector<std::pair<std::string, std::string>> items;
  bool prose = false;
};
/// Charts side by side; those with a `file` lie in RUN/figures as well.
struct Charts {
  std::vector<Chart> charts;
};
/// A row of pictures with their captions.
struct PictureRow {
  std::vector<std::pair<std::string, std::string>> pictures;  // caption, PNG in base64
  std::string caption;
};

struct Block {
  Media in = reading;
  std::variant<Heading, Paragraph, List, Facts, Grid, Charts, PictureRow> content;
  std::string folded{};  // not empty: the page shows this line, and the rest on a click
  std::string lead{};    // what Markdown says above it, where a page has the caption or `folded`
};

struct Section {
  std::string id, title;
  Media in = everywhere;
  std::vector<Block> blocks{};

  template <typename Content>
  void add(Media media, Content content, std::string folded = "", std::string lead = "") {
    Block& block = blocks.emplace_back();
    block.in = media;
    block.content.emplace<Content>(std::move(content));
    block.folded = std::move(folded);
    block.lead = std::move(lead);
  }
  /// The section in few words, which stand alone where there is little room.
  template <typename Content>
  void add_brief(Content content) {
    add(in_terminal, std::move(content));
  }
  /// What only a page has room for.
  template <typename Content>
  void add_detail(Content content, std::string folded = "") {
    add(on_page, std::move(content), std::move(folded));
  }
};

/// What a reader must know before the numbers.
struct Note {
  enum Kind { setting, note, error, source } kind;
  std::string text;
  std::string log{};  // of an error, relative to the run
};

/// An arm of the test: its id, title, what its scenes are, and one of them.
struct ArmLine {
  std::string name, title, text;
  std::string png;  // in base64; "" where there is none
};

struct Document {
  std::string suite, title;
  Spans headline{};  // the result, in a sentence
  std::vector<Note> notes;
  std::vector<Section> sections;
  std::string question{};       // that the suite asks; "" where none is known
  std::vector<ArmLine> arms{};  // what the columns of arms are
  Spans setting{};              // what all rows share
  std::string description{};    // a sentence for a link's preview; "": a page has none

  /// Every table that has files of its own, in order; every chart that has.
  std::vector<const Grid*> grids() const;
  std::vector<const Chart*> charts() const;
};

}  // namespace lgabench::document

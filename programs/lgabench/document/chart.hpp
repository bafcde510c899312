// The charts of a report, drawn by one engine onto SVG and PDF alike.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/statistics/names.hpp>

namespace lgabench::document {

/// A value with its interval. `row`: of summary.json, whose episodes the page shows on a click.
struct ChartPoint {
  double x = 0, y = 0, low = 0, high = 0;
  std::string label;  // "LGA at 20: 0.85 [0.64, 0.95]"
  std::optional<std::size_t> row{};
};

/// What belongs to one method, reference row, or curve of the paper's. A curve is a line of many points, none of them
/// marked but the last.
struct Series {
  enum Kind { measured, published, reference, curve } kind = measured;
  std::string name;
  statistics::MethodStyle style;
  bool joined = false;  // by a line; else a reference is a short level at each place
  std::vector<ChartPoint> points{};
};

/// Values over places along an axis: success, unless it says what.
struct Chart {
  struct Tick {
    double at = 0;
    std::string label;
  };
  std::string file;  // in RUN/figures, without its ending; "" for one that stands on the page alone
  std::string title, subtitle, axis, alternative;  // alternative: the text for those who do not see it
  std::string values;                              // what they are, beside them; "" says nothing
  double width = 640, height = 400;                // in points, without the legend
  double left = 0, right = 1;                      // of the axis
  double bottom = 0, top = 1;                      // of the values
  std::vector<Tick> ticks{}, levels{};  // along the axis; of the values, where five equal steps are not wanted
  std::vector<Series> series{};
  bool legend = true;
  bool rows = false;  // a row for each series, named beside it, its first point along the width: no ticks, no legend
  bool heat = false;  // a row for each series, a column for each tick, values from 0 to 1 as colours: no legend
};

/// The chart as an SVG element. `standalone`: as a file, with the name space that a page must not have.
std::string svg(const Chart& chart, bool standalone);
/// A PDF of one page. The same chart gives the same bytes. Text is set in Helvetica, which every reader of PDF has and
/// which is not embedded; characters outside Latin-1 become "?".
std::string pdf(const Chart& chart);
/// The mark of a style alone, as an SVG element 12 wide and high.
std::string svg_mark(const statistics::MethodStyle& style);

}  // namespace lgabench::document

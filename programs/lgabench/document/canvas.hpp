// What charts are drawn with: few enough primitives that a vector format takes a page.
#pragma once
#include <array>
#include <string>
#include <vector>

#include <lgabench/document/chart.hpp>

namespace lgabench::document {

/// Colours that a page turns in the dark; series: that of the group's method.
enum class Ink { none, ink, soft, rule, paper, series };

struct Pen {
  Ink stroke = Ink::none, fill = Ink::none;
  double width = 1;
  std::vector<double> dashes{};
};

/// m, l: one point; c: two controls and a point; z: none. In points, y downwards.
struct PathStep {
  char op;
  std::array<double, 6> at{};
};
using Path = std::vector<PathStep>;

enum class Anchor { start, middle, end };

class Canvas {
 public:
  virtual ~Canvas() = default;
  /// What follows until close() belongs to the series: its colour.
  virtual void open(const Series& series) = 0;
  /// What follows until close() is the entry of the series in the legend.
  virtual void open_entry(const Series& series) = 0;
  /// What follows until close() is the point.
  virtual void open(const ChartPoint& point, Series::Kind kind) = 0;
  virtual void close() = 0;
  virtual void path(const Path& path, const Pen& pen) = 0;
  /// `turned`: degrees clockwise about (x, y).
  virtual void text(const std::string& text, double x, double y, Anchor anchor, double size, bool bold, Ink ink,
                    double turned = 0) = 0;
};

/// Draws the chart, top left at (0, 0). Returns its height with the legend.
double draw(const Chart& chart, Canvas& canvas);

Path mark_path(const statistics::MethodStyle& style, double x, double y, double radius);
Pen mark_pen(const statistics::MethodStyle& style);

/// Width of a text in Helvetica; letters beyond ASCII count as an "n".
double text_width(const std::string& text, double size);

/// Unicode characters of a UTF-8 text; bytes that are none stand for themselves.
std::vector<char32_t> characters(const std::string& text);

}  // namespace lgabench::document

#include <lgabench/document/chart.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <lgabench/core/rounding.hpp>
#include <lgabench/document/canvas.hpp>

namespace lgabench::document {
namespace {

constexpr double left = 40, right = 14, small_text = 11, radius = 4.2;
constexpr double spare_width = 1.12;  // a browser without Helvetica sets a wider font
const Pen grid{Ink::rule};

// From 0, dark, to 1, pale: steps of a single-hue scale (ColorBrewer's OrRd), between which colours are mixed.
constexpr std::array<std::array<double, 3>, 5> heat_steps{
    {{127, 0, 0}, {215, 48, 31}, {252, 141, 89}, {253, 212, 158}, {255, 247, 236}}};
constexpr double slant = 20;       // degrees, of ticks that lack the room
constexpr double dark_below = .4;  // a value whose colour bears white text

std::string heat_colour(double value) {
  const double at = std::clamp(value, 0., 1.) * (heat_steps.size() - 1);
  const std::size_t step = std::min(static_cast<std::size_t>(at), heat_steps.size() - 2);
  std::string colour = "#";
  for (std::size_t c = 0; c < 3; ++c)
    colour +=
        fmt::format("{:02x}", std::lround(heat_steps[step][c] + (at - static_cast<double>(step)) *
                                                                    (heat_steps[step + 1][c] - heat_steps[step][c])));
  return colour;
}

// One chart on one canvas: where values lie.
class Drawing {
 public:
  Drawing(const Chart& chart, Canvas& canvas)
      : chart_(chart), canvas_(canvas), top_(chart.subtitle.empty() ? 30 : 44) {}

  double all() {
    const double fits = 13 * (chart_.width - 16) / (text_width(chart_.title, 13) * spare_width);
    canvas_.text(chart_.title, 8, 18, Anchor::start, std::min(13., fits), true, Ink::ink);
    if (!chart_.subtitle.empty()) canvas_.text(chart_.subtitle, 8, 33, Anchor::start, small_text, false, Ink::soft);
    if (chart_.rows) return rows();
    if (chart_.heat) return heat();
    axes();
    for (const Series::Kind kind : {Series::reference, Series::published, Series::curve, Series::measured})
      draw_all(kind);
    return chart_.legend ? legend() : chart_.height;
  }

 private:
  double x_of(double at) const {
    return left + (at - chart_.left) / (chart_.right - chart_.left) * (chart_.width - left - right);
  }
  double y_of(double value) const {
    return top_ + (chart_.top - value) / (chart_.top - chart_.bottom) * (chart_.height - top_ - bottom());
  }
  // Room for the ticks, and for the axis or ticks that are slanted.
  double bottom() const {
    if (!slanted()) return chart_.axis.empty() ? 26 : 46;
    double longest = 0;
    for (const Chart::Tick& tick : chart_.ticks) longest = std::max(longest, text_width(tick.label, small_text));
    return (chart_.axis.empty() ? 24 : 40) + longest * std::sin(slant * 3.14159265358979 / 180);
  }
  bool slanted() const {
    return std::any_of(chart_.ticks.begin(), chart_.ticks.end(),
                       [this](const Chart::Tick& tick) { return text_width(tick.label, small_text) > gap() - 8; });
  }
  // Points between two ticks.
  double gap() const {
    return chart_.ticks.size() < 2 ? chart_.width - left - right : x_of(chart_.ticks[1].at) - x_of(chart_.ticks[0].at);
  }
  int count(Series::Kind kind) const {
    return static_cast<int>(std::count_if(chart_.series.begin(), chart_.series.end(),
                                          [kind](const Series& series) { return series.kind == kind; }));
  }

  void axes() {
    std::vector<Chart::Tick> levels = chart_.levels;
    for (int tenth = 0; tenth <= 10 && chart_.levels.empty(); tenth += 2) {
      const double value = chart_.bottom + (chart_.top - chart_.bottom) * tenth / 10;
      levels.push_back({value, chart_.top == 1 ? fmt::format("{:.1f}", value) : fmt::format("{:g}", value)});
    }
    for (const Chart::Tick& level : levels) {
      const double y = y_of(level.at);
      canvas_.path({{'m', {left, y}}, {'l', {chart_.width - right, y}}}, grid);
      canvas_.text(level.label, left - 7, y + 4, Anchor::end, small_text, false, Ink::soft);
    }
    const double foot = chart_.height - bottom();
    for (const Chart::Tick& tick : chart_.ticks)
      canvas_.text(tick.label, x_of(tick.at), foot + 16, slanted() ? Anchor::end : Anchor::middle, small_text, false,
                   Ink::soft, slanted() ? -slant : 0);
    if (!chart_.values.empty())
      canvas_.text(chart_.values, 11, (top_ + foot) / 2, Anchor::middle, small_text, false, Ink::soft, -90);
    if (!chart_.axis.empty())
      canvas_.text(chart_.axis, (left + chart_.width - right) / 2, chart_.height - 8, Anchor::middle, small_text, false,
                   Ink::soft);
  }

  // A dot plot: methods in their order, then reference rows. Returns the height.
  double rows() {
    constexpr double row = 22, between = 12;
    double names = 0;
    for (const Series& series : chart_.series)
      names = std::max(names, spare_width * text_width(series.name, small_text) + 2 * between);
    const double begin = std::min(names, .45 * chart_.width), end = chart_.width - right - between;
    const auto x_of_value = [&](double value) {
      return begin + (value - chart_.bottom) / (chart_.top - chart_.bottom) * (end - begin);
    };
    const double foot = top_ + row * static_cast<double>(chart_.series.size());
    for (int tenth = 0; tenth <= 10; tenth += 2) {
      const double value = chart_.bottom + (chart_.top - chart_.bottom) * tenth / 10, x = x_of_value(value);
      canvas_.path({{'m', {x, top_}}, {'l', {x, foot}}}, grid);
      canvas_.text(fmt::format("{:.1f}", value), x, foot + 16, Anchor::middle, small_text, false, Ink::soft);
    }
    canvas_.text(chart_.axis, (begin + end) / 2, foot + 34, Anchor::middle, small_text, false, Ink::soft);
    double y = top_ + row / 2;
    for (const bool references : {false, true})
      for (const Series& series : chart_.series) {
        if ((series.kind == Series::reference) != references || series.points.empty()) continue;
        const ChartPoint& point = series.points.front();
        canvas_.open(series);
        canvas_.text(series.name, begin - between, y + 4, Anchor::end, small_text, false,
                     references ? Ink::soft : Ink::ink);
        canvas_.open(point, series.kind);
        const Ink ink = references ? Ink::soft : Ink::series;
        canvas_.path({{'m', {x_of_value(point.low), y}}, {'l', {x_of_value(point.high), y}}}, {ink, Ink::none, 1.3});
        canvas_.path(mark_path(series.style, x_of_value(point.y), y, references ? 3 : radius),
                     references ? Pen{Ink::soft, Ink::soft} : mark_pen(series.style));
        canvas_.close();
        canvas_.close();
        y += row;
      }
    return foot + 42;
  }

  // Numbers on their colours, columns' names slanted below them. Returns the height.
  double heat() {
    constexpr double row = 26, between = 12, turned = 35, degree = 3.14159265358979 / 180;
    double names = 0, heads = 0;
    for (const Series& series : chart_.series)
      names = std::max(names, spare_width * text_width(series.name, small_text) + 2 * between);
    for (const Chart::Tick& tick : chart_.ticks)
      heads = std::max(heads, spare_width * text_width(tick.label, small_text));
    const double begin = std::max(names, heads * std::cos(turned * degree) - 2 * between), end = chart_.width - right,
                 column = (end - begin) / static_cast<double>(chart_.ticks.size());
    const auto coloured = [&](const std::string& colour, const auto& draws) {
      Series shade;
      shade.style.colour = colour;
      canvas_.open(shade);
      draws();
      canvas_.close();
    };
    double y = top_;
    for (const Series& series : chart_.series) {
      canvas_.text(series.name, begin - between, y + row / 2 + 4, Anchor::end, small_text, false, Ink::ink);
      for (const ChartPoint& point : series.points) {
        const double x = begin + point.x * column;
        canvas_.open(point, series.kind);
        coloured(heat_colour(point.y), [&] {
          canvas_.path({{'m', {x + 1, y + 1}},
                        {'l', {x + column - 1, y + 1}},
                        {'l', {x + column - 1, y + row - 1}},
                        {'l', {x + 1, y + row - 1}},
                        {'z'}},
                       {Ink::none, Ink::series});
        });
        coloured(point.y < dark_below ? "#ffffff" : "#08090a", [&] {
          canvas_.text(fixed(point.y), x + column / 2, y + row / 2 + 4, Anchor::middle, small_text, false, Ink::series);
        });
        canvas_.close();
      }
      y += row;
    }
    for (const Chart::Tick& tick : chart_.ticks)
      canvas_.text(tick.label, begin + (tick.at + .5) * column + 4, y + 16, Anchor::end, small_text, false, Ink::soft,
                   -turned);
    y += 20 + heads * std::sin(turned * degree);
    canvas_.text(chart_.axis, (begin + end) / 2, y + 12, Anchor::middle, small_text, false, Ink::soft);
    return y + 22;
  }

  void draw_all(Series::Kind kind) {
    const double n = count(kind), apart = std::min(12., .8 * gap() / std::max(n, 1.));
    double place = -(n - 1) / 2;  // methods lie a little apart, so that no whisker hides another
    for (const Series& series : chart_.series) {
      if (series.kind != kind) continue;
      draw_one(series, kind != Series::measured ? 0 : place * (series.joined ? std::min(apart, 4.) : apart));
      ++place;
    }
  }

  void draw_one(const Series& series, double shift) {
    canvas_.open(series);
    Path line;
    for (const ChartPoint& point : series.points) {
      const double x = x_of(point.x) + shift, y = y_of(point.y);
      if (series.joined || series.kind != Series::reference) {
        line.push_back({line.empty() ? 'm' : 'l', {x, y}});
      } else {
        const double half = .44 * gap();
        line.push_back({'m', {x - half, y}});
        line.push_back({'l', {x + half, y}});
      }
    }
    if (series.joined || series.kind == Series::reference) canvas_.path(line, line_pen(series));
    if (series.kind == Series::curve && !series.points.empty()) {
      const ChartPoint& last = series.points.back();
      canvas_.path(mark_path(series.style, x_of(last.x), y_of(last.y), radius), mark_pen(series.style));
      return canvas_.close();
    }
    for (const ChartPoint& point : series.points) {
      const double x = x_of(point.x) + shift;
      canvas_.open(point, series.kind);
      if (series.kind == Series::reference) {
        canvas_.path(mark_path({}, x, y_of(point.y), 2.2), {Ink::soft, Ink::soft});
      } else {
        canvas_.path({{'m', {x, y_of(point.low)}}, {'l', {x, y_of(point.high)}}}, {Ink::series, Ink::none, 1.3});
        statistics::MethodStyle style = series.style;
        style.hollow = style.hollow || series.kind == Series::published;
        canvas_.path(mark_path(style, x, y_of(point.y), series.kind == Series::published ? 3 : radius),
                     mark_pen(style));
      }
      canvas_.close();
    }
    canvas_.close();
  }

  static Pen line_pen(const Series& series) {
    if (series.kind == Series::reference) return {Ink::soft, Ink::none, 1.2, series.style.dashes};
    if (series.kind == Series::published) return {Ink::series, Ink::none, 1.4, {6, 4}};
    return {Ink::series, Ink::none, 2};
  }

  // Below the chart, as many rows as it takes. Returns the height of both.
  double legend() {
    constexpr double sample = 26, row = 17, between = 16;
    double x = left, y = chart_.height + 10;
    const auto entry = [&](const Series& series, const std::string& name) {
      const double wide = sample + 6 + spare_width * text_width(name, small_text);
      if (x > left && x + wide > chart_.width - 4) {
        x = left;
        y += row;
      }
      canvas_.open_entry(series);
      canvas_.open(series);
      if (series.joined || series.kind == Series::reference)
        canvas_.path({{'m', {x, y}}, {'l', {x + sample, y}}}, line_pen(series));
      if (series.kind != Series::reference) {
        statistics::MethodStyle style = series.style;
        style.hollow = style.hollow || series.kind == Series::published;
        canvas_.path(mark_path(style, x + sample / 2, y, radius), mark_pen(style));
      }
      canvas_.close();
      canvas_.text(name, x + sample + 6, y + 4, Anchor::start, small_text, false, Ink::ink);
      canvas_.close();
      x += wide + between;
    };
    for (const Series& series : chart_.series)
      if (series.kind == Series::measured || series.kind == Series::curve) entry(series, series.name);
    for (const Series& series : chart_.series)
      if (series.kind == Series::reference) entry(series, series.name + " (reference)");
    for (const Series& series : chart_.series)
      if (series.kind == Series::published) {
        entry(series, "dashed: the paper's, with its error bars");
        break;
      }
    return y + row;
  }

  const Chart& chart_;
  Canvas& canvas_;
  double top_;
};

}  // namespace

double draw(const Chart& chart, Canvas& canvas) { return Drawing(chart, canvas).all(); }

}  // namespace lgabench::document

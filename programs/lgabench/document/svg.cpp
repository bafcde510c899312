// Charts as SVG. Colours are attributes, so that a file is complete; a page's style sheet overrides them by class.
#include <fmt/format.h>

#include <cmath>

#include <lgabench/document/canvas.hpp>
#include <lgabench/document/writers.hpp>

namespace lgabench::document {
namespace {

constexpr std::array<const char*, 6> css_colours{"none", "#1b1f24", "#59626d", "#d5dae0", "#ffffff", "currentColor"};
constexpr std::array<const char*, 6> names{"none", "ink", "soft", "rule", "paper", "series"};

std::string colour(Ink ink) { return css_colours[static_cast<std::size_t>(ink)]; }
std::string name(Ink ink) { return names[static_cast<std::size_t>(ink)]; }

// Without "-0.0".
std::string number(double value) { return fmt::format("{:.1f}", value == 0 || std::abs(value) < .05 ? 0. : value); }

class Svg : public Canvas {
 public:
  void open(const Series& series) override {
    const std::string& line_colour = series.style.colour;
    text_ += "<g class=\"series\"" + named(series);
    if (!series.style.reference())
      text_ += fmt::format(" color=\"{0}\" style=\"--c:{1}\"", line_colour,
                           line_colour == "#000000" ? "var(--ink,#000000)" : line_colour);
    text_ += '>';
  }
  void open_entry(const Series& series) override { text_ += fmt::format("<g class=\"entry\"{}>", named(series)); }
  void open(const ChartPoint& point, Series::Kind kind) override {
    text_ += point.row ? fmt::format("<g class=\"point\" tabindex=\"0\" role=\"button\" data-row=\"{}\"", *point.row)
                       : "<g class=\"point\" tabindex=\"0\" role=\"img\"";
    text_ +=
        fmt::format(" aria-label=\"{}{}\">", kind == Series::reference ? "reference row " : "", escaped(point.label));
  }
  void close() override { text_ += "</g>"; }
  void path(const Path& path, const Pen& pen) override {
    text_ += "<path d=\"";
    for (const PathStep& step : path) {
      text_ += step.op == 'z' ? 'z' : static_cast<char>(step.op - 'a' + 'A');
      const std::size_t numbers = step.op == 'z' ? 0 : step.op == 'c' ? 6 : 2;
      for (std::size_t i = 0; i < numbers; ++i) text_ += (i == 0 ? "" : " ") + number(step.at[i]);
    }
    text_ += fmt::format("\" class=\"s-{} f-{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"{:g}\"", name(pen.stroke),
                         name(pen.fill), colour(pen.fill), colour(pen.stroke), pen.width);
    if (!pen.dashes.empty()) text_ += fmt::format(" stroke-dasharray=\"{:g}\"", fmt::join(pen.dashes, " "));
    text_ += "/>";
  }
  void text(const std::string& words, double x, double y, Anchor anchor, double size, bool bold, Ink ink,
            double turned) override {
    constexpr std::array<const char*, 3> anchors{"start", "middle", "end"};
    text_ +=
        fmt::format("<text class=\"f-{}\" fill=\"{}\" font-size=\"{:g}\" text-anchor=\"{}\"{}", name(ink), colour(ink),
                    size, anchors[static_cast<std::size_t>(anchor)], bold ? " font-weight=\"600\"" : "");
    text_ += turned == 0 ? fmt::format(" x=\"{}\" y=\"{}\"", number(x), number(y))
                         : fmt::format(" transform=\"translate({} {}) rotate({:g})\"", number(x), number(y), turned);
    text_ += fmt::format(">{}</text>", escaped(words));
  }
  const std::string& drawn() const { return text_; }

 private:
  // What a page's script hides together: a row's curve, and the paper's of the same name. A mark alone has no name.
  static std::string named(const Series& series) {
    if (series.name.empty()) return "";
    return fmt::format(" data-series=\"{}\"{}", escaped(series.name),
                       series.kind == Series::published ? " data-published=\"\"" : "");
  }

  std::string text_;
};

}  // namespace

std::string svg(const Chart& chart, bool standalone) {
  Svg canvas;
  const double height = draw(chart, canvas);
  const std::string box =
      fmt::format("viewBox=\"0 0 {0:g} {1:.0f}\" width=\"{0:g}\" height=\"{1:.0f}\"", chart.width, height);
  return fmt::format(
      "<svg{} class=\"chart\" {} role=\"group\" aria-label=\"{}\" "
      "font-family=\"Helvetica,Arial,sans-serif\">{}{}</svg>",
      standalone ? " xmlns=\"http://www.w3.org/2000/svg\"" : "", box, escaped(chart.alternative),
      standalone ? "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>" : "", canvas.drawn());
}

std::string svg_mark(const statistics::MethodStyle& style) {
  Svg canvas;
  canvas.open(Series{Series::measured, "", style});
  canvas.path(mark_path(style, 6, 6, 4), mark_pen(style));
  canvas.close();
  return "<svg class=\"mark\" viewBox=\"0 0 12 12\" aria-hidden=\"true\">" + canvas.drawn() + "</svg>";
}

}  // namespace lgabench::document

#include <lgabench/document/canvas.hpp>

#include <cmath>

namespace lgabench::document {
namespace {

// Helvetica's widths of the characters from space to tilde, in thousandths of the size (Adobe's font metrics).
constexpr std::array<int, 95> widths{278,  278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278,
                                     556,  556, 556, 556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556,
                                     1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778,
                                     667,  778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556,
                                     333,  556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556,
                                     556,  556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584};

}  // namespace

std::vector<char32_t> characters(const std::string& text) {
  std::vector<char32_t> all;
  for (const char byte : text) {
    const auto code = static_cast<unsigned char>(byte);
    if ((code & 0xC0) != 0x80 || all.empty())
      all.push_back(code < 0xC0 ? code : code & (code < 0xE0 ? 0x1F : code < 0xF0 ? 0x0F : 0x07));
    else
      all.back() = all.back() << 6 | (code & 0x3F);
  }
  return all;
}

double text_width(const std::string& text, double size) {
  double thousandths = 0;
  for (const char32_t c : characters(text)) thousandths += c < ' ' || c > '~' ? 556 : widths[c - ' '];
  return thousandths * size / 1000;
}

Path mark_path(const statistics::MethodStyle& style, double x, double y, double radius) {
  if (style.sides == 0) {
    const double r = radius, k = .5523 * radius;  // a circle, to a thousandth, of four curves
    return {{'m', {x + r, y}},
            {'c', {x + r, y + k, x + k, y + r, x, y + r}},
            {'c', {x - k, y + r, x - r, y + k, x - r, y}},
            {'c', {x - r, y - k, x - k, y - r, x, y - r}},
            {'c', {x + k, y - r, x + r, y - k, x + r, y}},
            {'z'}};
  }
  constexpr double degree = 3.14159265358979 / 180;
  const double r = radius * (style.sides < 5 ? 1.25 : 1.1);  // so that marks look equally large
  Path path;
  for (int i = 0; i < style.sides; ++i) {
    const double angle = (style.turned + 360. * i / style.sides) * degree;
    path.push_back({i == 0 ? 'm' : 'l', {x + r * std::cos(angle), y + r * std::sin(angle)}});
  }
  path.push_back({'z'});
  return path;
}

Pen mark_pen(const statistics::MethodStyle& style) {
  return {Ink::series, style.hollow ? Ink::paper : Ink::series, style.hollow ? 1.6 : 1};
}

}  // namespace lgabench::document

// Charts as PDF: one page, no compression, no font, no date. Written here because the primitives of a chart are those
// of PDF, and because a library would bring its own fonts, and bytes that change with its version.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include <lgabench/document/canvas.hpp>

namespace lgabench::document {
namespace {

constexpr std::array<const char*, 6> rgb_colours{"#000000", "#1b1f24", "#59626d", "#d5dae0", "#ffffff", ""};

// "0.106 0.122 0.141"
std::string rgb(const std::string& colour) {
  const long code = std::strtol(colour.c_str() + 1, nullptr, 16);
  return fmt::format("{:.3f} {:.3f} {:.3f}", static_cast<double>(code >> 16) / 255,
                     static_cast<double>(code >> 8 & 255) / 255, static_cast<double>(code & 255) / 255);
}

// A string of PDF in the encoding WinAnsi, which is Latin-1 for all that a chart holds.
std::string pdf_string(const std::string& text) {
  std::string out = "(";
  for (char32_t c : characters(text)) {
    if (c == 0x2019) c = '\'';
    if (c == 0x2212 || c == 0x2013) c = 0x96;  // minus, en dash
    const bool known = (c >= ' ' && c <= '~') || c == 0x96 || (c >= 0xA0 && c <= 0xFF);
    if (!known) c = '?';
    if (c > '~')
      out += fmt::format("\\{:03o}", static_cast<unsigned>(c));
    else
      out += (c == '(' || c == ')' || c == '\\' ? "\\" : "") + std::string(1, static_cast<char>(c));
  }
  return out + ")";
}

class Pdf : public Canvas {
 public:
  void open(const Series& series) override { series_ = series.style.reference() ? "#59626d" : series.style.colour; }
  void open_entry(const Series&) override {}
  void open(const ChartPoint&, Series::Kind) override {}
  void close() override {}
  void path(const Path& path, const Pen& pen) override {
    if (pen.stroke != Ink::none) content_ += fmt::format("{} RG {:g} w ", rgb(colour(pen.stroke)), pen.width);
    if (pen.fill != Ink::none) content_ += fmt::format("{} rg ", rgb(colour(pen.fill)));
    content_ += fmt::format("[{:g}] 0 d\n", fmt::join(pen.dashes, " "));
    for (const PathStep& step : path) {
      const std::size_t numbers = step.op == 'z' ? 0 : step.op == 'c' ? 6 : 2;
      for (std::size_t i = 0; i < numbers; ++i) content_ += fmt::format("{:.2f} ", step.at[i]);
      content_ += step.op == 'z' ? "h\n" : fmt::format("{}\n", step.op);
    }
    content_ += pen.stroke == Ink::none ? "f\n" : pen.fill == Ink::none ? "S\n" : "B\n";
  }
  void text(const std::string& words, double x, double y, Anchor anchor, double size, bool bold, Ink ink,
            double turned) override {
    const double before = text_width(words, size) * (anchor == Anchor::start ? 0 : anchor == Anchor::middle ? .5 : 1);
    const double angle = turned * 3.14159265358979 / 180, c = std::cos(angle), s = std::sin(angle);
    // The page's y axis is turned over; text is turned back.
    content_ +=
        fmt::format("BT /{} {:g} Tf {} rg {:.4f} {:.4f} {:.4f} {:.4f} {:.2f} {:.2f} Tm {} Tj ET\n", bold ? "B" : "R",
                    size, rgb(colour(ink)), c, s, s, -c, x - before * c, y - before * s, pdf_string(words));
  }
  std::string file(double width, double height) const {
    const std::string content = fmt::format("1 0 0 -1 0 {:.0f} cm\n{}", height, content_);
    const auto font = [](const char* name) {
      return fmt::format("<< /Type /Font /Subtype /Type1 /BaseFont /{} /Encoding /WinAnsiEncoding >>", name);
    };
    const std::vector<std::string> objects{
        "<< /Type /Catalog /Pages 2 0 R >>",
        "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        fmt::format("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:g} {:.0f}] /Contents 4 0 R "
                    "/Resources << /Font << /R 5 0 R /B 6 0 R >> >> >>",
                    width, height),
        fmt::format("<< /Length {} >>\nstream\n{}endstream", content.size(), content),
        font("Helvetica"),
        font("Helvetica-Bold")};
    std::string file = "%PDF-1.4\n", table;
    for (std::size_t i = 0; i < objects.size(); ++i) {
      table += fmt::format("{:010} 00000 n \n", file.size());
      file += fmt::format("{} 0 obj\n{}\nendobj\n", i + 1, objects[i]);
    }
    const std::size_t start = file.size();
    return file + fmt::format(
                      "xref\n0 {0}\n0000000000 65535 f \n{1}trailer\n<< /Size {0} /Root 1 0 R >>\nstartxref\n{2}\n"
                      "%%EOF\n",
                      objects.size() + 1, table, start);
  }

 private:
  std::string colour(Ink ink) const {
    return ink == Ink::series ? series_ : rgb_colours[static_cast<std::size_t>(ink)];
  }

  std::string content_, series_ = "#000000";
};

}  // namespace

std::string pdf(const Chart& chart) {
  Pdf canvas;
  const double height = draw(chart, canvas);
  return canvas.file(chart.width, height);
}

}  // namespace lgabench::document

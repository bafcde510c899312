#include <lgabench/core/shown.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <lgabench/core/error.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench {
namespace {

void expect_line(const std::string& text) {
  constexpr std::size_t longest = 200;
  if (text.size() > longest || one_line(text) != text)
    throw MethodError(fmt::format("shown: expected captions and texts of one line, at most {} bytes", longest));
}

}  // namespace

Rgb mask_colour(double value) {
  if (value < 0) return {205, 60, 50};
  return value > 0 ? Rgb{245, 245, 245} : Rgb{32, 32, 32};
}

ShownPicture shown_mask(std::string name, PictureSize size, const float* values) {
  ShownPicture picture{std::move(name), "", size, {}};
  for (std::size_t i = 0; i < size.pixels(); ++i) {
    const Rgb colour = mask_colour(values[i]);
    picture.rgb.insert(picture.rgb.end(), colour.begin(), colour.end());
  }
  return picture;
}

ShownPicture shown_colours(std::string name, PictureSize size, const float* values) {
  ShownPicture picture{std::move(name), "", size, {}};
  for (std::size_t i = 0; i < 3 * size.pixels(); ++i)
    picture.rgb.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(values[i], 0.f, 1.f))));
  return picture;
}

void expect_shown(const Shown& shown) {
  constexpr std::size_t most = 8, most_bytes = 1 << 20;
  constexpr int longest = 1024;
  std::size_t bytes = 0;
  for (const auto& [name, note, size, rgb] : shown.pictures) {
    expect_line(name);
    expect_line(note);
    if (size.rows < 1 || size.columns < 1 || std::max(size.rows, size.columns) > longest ||
        rgb.size() != 3 * size.pixels())
      throw MethodError(fmt::format(
          "shown: a picture of {} x {} with {} bytes: expected 1 to {} rows and columns, and 3 bytes a pixel",
          size.rows, size.columns, rgb.size(), longest));
    bytes += rgb.size();
  }
  if (shown.pictures.size() > most || shown.texts.size() > most || shown.unread.size() > most || bytes > most_bytes)
    throw MethodError(
        fmt::format("shown: expected at most {} pictures, {} texts and {} bytes of pictures", most, most, most_bytes));
  for (const auto* list : {&shown.texts, &shown.unread}) std::for_each(list->begin(), list->end(), expect_line);
}

}  // namespace lgabench

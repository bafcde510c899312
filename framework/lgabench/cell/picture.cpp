#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>

#include <lgabench/cell/picture.hpp>
#include <lgabench/core/error.hpp>

namespace lgabench {

Rgb pixel_colour(const Observation& seen, std::size_t i) {
  return {seen.rgb[3 * i], seen.rgb[3 * i + 1], seen.rgb[3 * i + 2]};
}

// Steps of the golden section around the colour circle.
Rgb id_colour(std::uint8_t id) {
  if (id == 0) return mask_colour(false);
  const double hue = 6 * std::fmod(0.618034 * id, 1.0);
  const auto channel = [hue](double peak) {
    const double distance = std::abs(std::remainder(hue - peak, 6.0));
    return static_cast<std::uint8_t>(60 + 180 * std::clamp(2 - distance, 0.0, 1.0));
  };
  return {channel(0), channel(2), channel(4)};
}

Picture::Picture(int width, int height)
    : width_(width), height_(height), rgb_(3 * static_cast<std::size_t>(width * height), 255) {}

void Picture::paste(int left, int top, int columns, int rows, int zoom,
                    const std::function<Rgb(int column, int row)>& colour) {
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const Rgb c = colour(column, row);
      for (int y = top + row * zoom; y < top + (row + 1) * zoom; ++y)
        for (int x = left + column * zoom; x < left + (column + 1) * zoom; ++x)
          std::copy(c.begin(), c.end(), rgb_.begin() + 3 * (y * width_ + x));
    }
}

void Picture::dot(double x, double y, double radius, const Rgb& colour) {
  const auto from = [radius](double middle) { return std::max(0, static_cast<int>(middle - radius)); };
  const auto to = [radius](double middle, int size) { return std::min(size - 1, static_cast<int>(middle + radius)); };
  for (int row = from(y); row <= to(y, height_); ++row)
    for (int column = from(x); column <= to(x, width_); ++column)
      if (std::hypot(column + .5 - x, row + .5 - y) < radius)
        std::copy(colour.begin(), colour.end(), rgb_.begin() + 3 * (row * width_ + column));
}

Rgb Picture::at(int x, int y) const {
  const auto i = static_cast<std::size_t>(3 * (y * width_ + x));
  return {rgb_[i], rgb_[i + 1], rgb_[i + 2]};
}

std::string Picture::png() const {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width_);
  image.height = static_cast<png_uint_32>(height_);
  image.format = PNG_FORMAT_RGB;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb_.data(), 0, nullptr))
    throw Error(fmt::format("libpng: {}", image.message));
  bytes.resize(size);
  return bytes;
}

std::string Picture::png(std::size_t most_bytes) const {
  std::string bytes = png();
  for (int dropped = 1; bytes.size() > most_bytes && dropped <= 4; ++dropped) {
    Picture coarse = *this;
    for (std::uint8_t& value : coarse.rgb_) value = static_cast<std::uint8_t>(value >> dropped << dropped);
    bytes = coarse.png();
  }
  return bytes;
}

}  // namespace lgabench

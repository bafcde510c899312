#include <fmt/format.h>
#include <png.h>

#include <algorithm>

#include <lgabench/cli/picture.hpp>
#include <lgabench/core/error.hpp>

namespace lgabench::cli {

Rgb pixel_colour(const Observation& seen, std::size_t i) {
  return {seen.rgb[3 * i], seen.rgb[3 * i + 1], seen.rgb[3 * i + 2]};
}

Rgb mask_colour(bool kept) { return kept ? Rgb{245, 245, 245} : Rgb{32, 32, 32}; }

Picture::Picture(int width, int height)
    : width_(width), height_(height), rgb_(3 * static_cast<std::size_t>(width * height), 255) {}

void Picture::paste(int left, int top, int columns, int rows, int zoom,
                    const std::function<Rgb(int column, int row)>& colour) {
  for (int y = 0; y < rows * zoom; ++y)
    for (int x = 0; x < columns * zoom; ++x) {
      const Rgb c = colour(x / zoom, y / zoom);
      std::copy(c.begin(), c.end(), rgb_.begin() + 3 * ((top + y) * width_ + left + x));
    }
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

}  // namespace lgabench::cli

#include <lgabench/cli/gif.hpp>

#include <fmt/format.h>
#include <gif_lib.h>

#include <cmath>
#include <memory>

#include <lgabench/core/error.hpp>

namespace lgabench::cli {
namespace {

void expect(int result, int error) {
  if (result == GIF_ERROR) throw Error(fmt::format("giflib: {}", GifErrorString(error)));
}

using Palette = std::unique_ptr<ColorMapObject, decltype(&GifFreeMapObject)>;

constexpr int unchanged = 255;  // the palette's last index: the pixel of the frame before shows through

// All frames at once, so that no colour flickers. Fills `indices`, a byte a pixel.
Palette quantized(const std::vector<Frame>& frames, std::vector<GifByteType>& indices) {
  std::vector<GifByteType> red, green, blue;
  for (const Frame& frame : frames) {
    const auto& rgb = frame.picture.rgb();
    for (std::size_t i = 0; i < rgb.size(); i += 3) {
      red.push_back(rgb[i]);
      green.push_back(rgb[i + 1]);
      blue.push_back(rgb[i + 2]);
    }
  }
  int colours = unchanged;
  Palette palette(GifMakeMapObject(unchanged + 1, nullptr), &GifFreeMapObject);
  if (!palette) throw Error("giflib: out of memory");
  indices.resize(red.size());
  const auto width = static_cast<unsigned>(frames.front().picture.width());
  expect(GifQuantizeBuffer(width, static_cast<unsigned>(red.size()) / width, &colours, red.data(), green.data(),
                           blue.data(), indices.data(), palette->Colors),
         E_GIF_ERR_NOT_ENOUGH_MEM);
  return palette;
}

int append(GifFileType* file, const GifByteType* bytes, int size) {
  static_cast<std::string*>(file->UserData)
      ->append(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  return size;
}

void repeat_for_ever(GifFileType* file) {
  const unsigned char forever[] = {1, 0, 0};
  expect(EGifPutExtensionLeader(file, APPLICATION_EXT_FUNC_CODE), file->Error);
  expect(EGifPutExtensionBlock(file, 11, "NETSCAPE2.0"), file->Error);
  expect(EGifPutExtensionBlock(file, sizeof forever, forever), file->Error);
  expect(EGifPutExtensionTrailer(file), file->Error);
}

void put_frame(GifFileType* file, GifByteType* indices, int width, int height, double seconds) {
  GraphicsControlBlock control{};
  control.DisposalMode = DISPOSE_DO_NOT;
  control.DelayTime = static_cast<int>(std::lround(100 * seconds));
  control.TransparentColor = unchanged;
  GifByteType bytes[4];
  const std::size_t size = EGifGCBToExtension(&control, bytes);
  expect(EGifPutExtension(file, GRAPHICS_EXT_FUNC_CODE, static_cast<int>(size), bytes), file->Error);
  expect(EGifPutImageDesc(file, 0, 0, width, height, false, nullptr), file->Error);
  expect(EGifPutLine(file, indices, width * height), file->Error);
}

}  // namespace

std::string gif(const std::vector<Frame>& frames) {
  std::vector<GifByteType> indices;
  const Palette palette = quantized(frames, indices);
  const int width = frames.front().picture.width(), height = frames.front().picture.height();
  const auto size = static_cast<std::size_t>(width * height);
  for (std::size_t i = indices.size() - 1; i >= size; --i)
    if (indices[i] == indices[i - size])
      indices[i] = unchanged;  // from the end, so that the one before is not yet marked
  std::string bytes;
  int error = 0;
  GifFileType* const file = EGifOpen(&bytes, append, &error);
  if (!file) throw Error(fmt::format("giflib: {}", GifErrorString(error)));
  try {
    EGifSetGifVersion(file, true);
    expect(EGifPutScreenDesc(file, width, height, 8, 0, palette.get()), file->Error);
    repeat_for_ever(file);
    for (std::size_t i = 0; i < frames.size(); ++i)
      put_frame(file, indices.data() + i * size, width, height, frames[i].seconds);
  } catch (...) {
    EGifCloseFile(file, &error);
    throw;
  }
  expect(EGifCloseFile(file, &error), error);
  return bytes;
}

}  // namespace lgabench::cli

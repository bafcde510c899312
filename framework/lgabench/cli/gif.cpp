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

// All frames at once, so that no colour flickers. Fills `indices`, a byte a pixel.
Palette quantized(const std::vector<Picture>& frames, std::vector<GifByteType>& indices) {
  std::vector<GifByteType> red, green, blue;
  for (const Picture& frame : frames)
    for (std::size_t i = 0; i < frame.rgb().size(); i += 3) {
      red.push_back(frame.rgb()[i]);
      green.push_back(frame.rgb()[i + 1]);
      blue.push_back(frame.rgb()[i + 2]);
    }
  int colours = 256;
  Palette palette(GifMakeMapObject(colours, nullptr), &GifFreeMapObject);
  if (!palette) throw Error("giflib: out of memory");
  indices.resize(red.size());
  const auto width = static_cast<unsigned>(frames.front().width());
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
  control.DelayTime = static_cast<int>(std::lround(100 * seconds));
  control.TransparentColor = NO_TRANSPARENT_COLOR;
  GifByteType bytes[4];
  const std::size_t size = EGifGCBToExtension(&control, bytes);
  expect(EGifPutExtension(file, GRAPHICS_EXT_FUNC_CODE, static_cast<int>(size), bytes), file->Error);
  expect(EGifPutImageDesc(file, 0, 0, width, height, false, nullptr), file->Error);
  expect(EGifPutLine(file, indices, width * height), file->Error);
}

}  // namespace

std::string gif(const std::vector<Picture>& frames, double frame_s) {
  std::vector<GifByteType> indices;
  const Palette palette = quantized(frames, indices);
  const int width = frames.front().width(), height = frames.front().height();
  std::string bytes;
  int error = 0;
  GifFileType* const file = EGifOpen(&bytes, append, &error);
  if (!file) throw Error(fmt::format("giflib: {}", GifErrorString(error)));
  try {
    EGifSetGifVersion(file, true);
    expect(EGifPutScreenDesc(file, width, height, 8, 0, palette.get()), file->Error);
    repeat_for_ever(file);
    constexpr double last_s = 2;
    for (std::size_t i = 0; i < frames.size(); ++i)
      put_frame(file, indices.data() + i * static_cast<std::size_t>(width * height), width, height,
                i + 1 < frames.size() ? frame_s : last_s);
  } catch (...) {
    EGifCloseFile(file, &error);
    throw;
  }
  expect(EGifCloseFile(file, &error), error);
  return bytes;
}

}  // namespace lgabench::cli

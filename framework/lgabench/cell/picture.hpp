// A picture in memory, made of enlarged pieces, and its PNG bytes.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <lgabench/core/observation.hpp>
#include <lgabench/core/shown.hpp>

namespace lgabench {

/// How pixel `i` of a picture is shown.
Rgb pixel_colour(const Observation& seen, std::size_t i);
/// How an object's id is shown: far hues for near ids, black for none.
Rgb id_colour(std::uint8_t id);

class Picture {
 public:
  /// White, in pixels.
  Picture(int width, int height);

  /// Draws columns x rows squares of `zoom` pixels each, the first at (left, top). @pre They fit.
  void paste(int left, int top, int columns, int rows, int zoom, const std::function<Rgb(int column, int row)>& colour);

  /// Fills the pixels whose centres are nearer than `radius` to (x, y), as far as they are in the picture.
  void dot(double x, double y, double radius, const Rgb& colour);

  int width() const { return width_; }
  int height() const { return height_; }
  /// @pre In the picture.
  Rgb at(int x, int y) const;
  /// Row by row, three bytes a pixel.
  const std::vector<std::uint8_t>& rgb() const { return rgb_; }

  /// @throws Error if libpng cannot write it.
  std::string png() const;
  /// A PNG of at most `most_bytes`, where that needs no more than half of each colour's bits to be dropped.
  std::string png(std::size_t most_bytes) const;

 private:
  int width_, height_;
  std::vector<std::uint8_t> rgb_;
};

}  // namespace lgabench

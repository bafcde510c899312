// The 83 textures as procedural pictures.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace lgabench::common {

using Rgb = std::array<std::uint8_t, 3>;

/// A square, tileable picture; `scale_m` is the length on an object that one tile covers.
struct Texture {
  static constexpr int size = 128;
  std::string name;
  double scale_m = 0.1;
  std::vector<Rgb> pixels;  // size x size, row-major

  /// Colour at a point of the object's surface, given in metres on the plane that faces the surface: u to the right,
  /// v down, the picture's centre at (0, 0), repeated without end (nearest pixel). u and v below a kilometre.
  Rgb at(double u_m, double v_m) const { return pixels[static_cast<unsigned>(texel(v_m) * size + texel(u_m))]; }

  /// The column of at()'s pixel for u_m, its row for v_m.
  int texel(double metres) const {
    static_assert((size & (size - 1)) == 0, "the mask below wraps by a power of two");
    const double texels = metres / scale_m * size;
    const double towards_zero = static_cast<int>(texels);  // std::floor() is a call, where a loop takes several at once
    return (static_cast<int>(towards_zero - (towards_zero > texels ? 1. : 0.)) + size / 2) & (size - 1);
  }
};

/// The texture of that name; made at the first call, lives as long as the program. Any thread.
/// Names: a colour, "C and C stripe", "C and C polka dot", "C swirl" or "C paisley", each possibly after "dark", which
/// darkens every colour that follows; or a material (brick, tiles, wooden, granite, plastic, polka dot, checkerboard,
/// tiger, magma, rainbow). Colours and "dark" (HSV value - .3) as in docs/gallery.md.
/// @throws InputError for any other name.
const Texture& texture(const std::string& name);

}  // namespace lgabench::common

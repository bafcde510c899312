// How each texture looks: a colour for every point of a tile.
#pragma once
#include <functional>
#include <string>

#include <common/textures.hpp>

namespace lgabench::common {

/// Colour at (u, v) in [0, 1) x [0, 1), u to the right, v down; continues seamlessly into the neighbouring tiles.
using Painter = std::function<Rgb(double u, double v)>;

struct Pattern {
  double scale_m = 0.1;  // length of a tile on an object; a pixel of the top view is 3.9 mm
  Painter paint;
};

Pattern plain(Rgb colour);
Pattern stripe(Rgb first, Rgb second);
Pattern polka_dot(Rgb ground, Rgb dots);
Pattern swirl(Rgb colour);    // a two-armed spiral of the colour and white
Pattern paisley(Rgb colour);  // white-rimmed teardrops on the colour

/// brick, tiles, ... rainbow; without a painter for any other name.
Pattern material(const std::string& name);

}  // namespace lgabench::common

// Repainting takes objects out of a picture, or makes them look otherwise, beside what a goal mask keeps. It changes
// colours; ids and instances stay, so that an observation can be repainted again.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/core/method.hpp>
#include <lgabench/core/random.hpp>

namespace lgabench {

/// Values of Observation::ids: instance ids; 0 is background.
using Ids = std::vector<std::uint8_t>;

/// Ids of the instances that a goal mask with these arguments leaves out, in the order of the instance table.
Ids unselected(const Observation& observation, const Selection& selection, Instances instances = Instances::all);

/// Red, green, blue.
using Colour = std::array<std::uint8_t, 3>;

/// What pictures show where nothing stands: rows x columns x 3.
struct Background {
  std::vector<std::uint8_t> rgb;
};
/// The background of these demonstrations. Its colour at a pixel is that of more than half of the steps in which
/// neither an object nor a shadow is there, or any of theirs where no colour has a majority. Where there is no such
/// step, it is the most frequent colour of the other pixels.
/// @throws InputError for pictures of several sizes, or none.
Background usual_background(const std::vector<Demonstration>& demonstrations);
/// The background's most frequent colour: the table's, if the picture shows little else.
Colour most_frequent_colour(const Background& background);

/// Paints another random colour at each pixel.
struct Noise {
  RandomStream& stream;
};
/// Paints a random pattern on each id: plain, stripes, checks, dots or a gradient of two random colours, in the pixels'
/// light.
struct RandomTextures {
  RandomStream& stream;
};

/// Paints the pixels of `which` with the background, or one colour. If the observation has Observation::shadows, their
/// shadows are taken away too, except where another object throws one: a level surface then has its colour in the
/// light, to within 1 of 255. These shadows also leave Observation::shadows, so that a second repaint() changes
/// nothing.
/// @throws InputError for a background of another size.
Observation repaint(Observation seen, const Ids& which, const Background& how);
Observation repaint(Observation seen, const Ids& which, const Colour& how);
/// Paints the pixels of `which`, and those in their shadows that show no object.
Observation repaint(Observation seen, const Ids& which, const Noise& how);
/// Paints the pixels of `which`. Their shadows stay, since the objects stay.
Observation repaint(Observation seen, const Ids& which, const RandomTextures& how);

}  // namespace lgabench

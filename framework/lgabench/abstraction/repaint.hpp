// Repainting: what is taken out of a picture, or made to look otherwise, beside what a goal mask keeps. Colours change;
// ids and instances stay, so that one observation can be repainted again.
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

/// Ids of the instances that a goal mask of these leaves out, in the order of the instance table.
Ids unselected(const Observation& observation, const Selection& selection, Instances instances = Instances::all);

/// Red, green, blue.
using Colour = std::array<std::uint8_t, 3>;

/// What pictures show where nothing stands: rows x columns x 3.
struct Background {
  std::vector<std::uint8_t> rgb;
};
/// What more than half of the steps show at a pixel, of those in which neither an object nor a shadow is there (any of
/// them where no colour has the majority); where that is never so, the most frequent of the colours found.
/// @throws InputError for pictures of several sizes, or none.
Background usual_background(const std::vector<Demonstration>& demonstrations);
/// Its most frequent colour: the table's, where the picture shows little else.
Colour most_frequent_colour(const Background& background);

/// Another random colour at each pixel.
struct Noise {
  RandomStream& stream;
};
/// A random pattern for each id, plain, stripes, checks, dots or a gradient of two random colours, in the pixels'
/// light.
struct RandomTextures {
  RandomStream& stream;
};

/// Paints the pixels of `which` with the background, or one colour, and takes away their shadows, where the observation
/// has Observation::shadows and nothing else throws one there: a level surface has its colour in the light to within 1
/// of 255. Shadows that were taken away are none of the observation's any more: a second time changes nothing.
/// @throws InputError for a background of another size.
Observation repaint(Observation seen, const Ids& which, const Background& how);
Observation repaint(Observation seen, const Ids& which, const Colour& how);
/// Paints the pixels of `which`, and what is no object in their shadows.
Observation repaint(Observation seen, const Ids& which, const Noise& how);
/// Paints the pixels of `which`; their shadows stay, as they themselves do.
Observation repaint(Observation seen, const Ids& which, const RandomTextures& how);

}  // namespace lgabench

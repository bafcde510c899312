// Pictures in a row, as one animation.
#pragma once
#include <string>
#include <vector>

#include <lgabench/cell/picture.hpp>

namespace lgabench::cli {

struct Frame {
  Picture picture;
  double seconds;
};

/// The bytes of a GIF that shows the frames one after another and begins again. All share one palette of 255 colours,
/// and each holds the pixels that changed. @pre At least one frame, all of one size. @throws Error if giflib fails.
std::string gif(const std::vector<Frame>& frames);

}  // namespace lgabench::cli

// Pictures in a row, as one animation.
#pragma once
#include <string>
#include <vector>

#include <lgabench/cell/picture.hpp>

namespace lgabench::cli {

/// The bytes of a GIF that shows `frames` for `frame_s` each, the last one for two seconds, and begins again. All
/// frames share one palette of 256 colours. @pre At least one frame, all of one size. @throws Error if giflib fails.
std::string gif(const std::vector<Picture>& frames, double frame_s);

}  // namespace lgabench::cli

// What a policy read of a scene, as pictures for people: a report's page shows them beside the scene.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <lgabench/core/observation.hpp>

namespace lgabench {

/// A report's page shows every page_step-th row and column of a picture.
constexpr int page_step(PictureSize picture) { return picture.columns < 512 ? 1 : picture.columns / 256; }

using Rgb = std::array<std::uint8_t, 3>;

/// The colour of a mask's number: white above 0, red below 0, where something is to be avoided, and black at 0.
Rgb mask_colour(double value);

struct ShownPicture {
  std::string name, note;  // for a caption: "goal mask"; "", or how it is read
  PictureSize size;
  std::vector<std::uint8_t> rgb;  // rows x columns x 3
};

/// A picture of a mask's rows x columns numbers, in mask_colour(). `values` is not kept.
ShownPicture shown_mask(std::string name, PictureSize size, const float* values);
/// A picture of rows x columns x 3 numbers, clipped to 0 to 1.
ShownPicture shown_colours(std::string name, PictureSize size, const float* values);

struct Shown {
  std::vector<ShownPicture> pictures;
  std::vector<std::string> texts;   // read beside them as a sentence embedding, in words for a caption
  std::vector<std::string> unread;  // of the method's inputs, what this policy leaves out

  bool empty() const { return pictures.empty() && texts.empty() && unread.empty(); }
};

/// Expects at most 8 pictures of 1 to 1024 rows and columns and of 1 MiB together, which fit their sizes, at most 8
/// texts of each kind, and lines of at most 200 bytes. @throws MethodError
void expect_shown(const Shown& shown);

}  // namespace lgabench

// What a policy sees, and all that it may see.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lgabench {

/// One textualized object (paper, section 3.1: s -> phi). `id` is its value in Observation::ids; ids and the order
/// of the table are permuted for each scene, so neither says which object is the target.
struct Instance {
  std::uint8_t id = 0;
  std::string object_type, texture;
  int pixels = 0;  // visible now; 0 if hidden
};

/// An object's names alone.
struct Named {
  std::string object_type, texture;
};
inline bool operator==(const Named& a, const Named& b) {
  return a.object_type == b.object_type && a.texture == b.texture;
}

/// Rows of a picture, from the top, and its columns, from the left.
struct PictureSize {
  int rows = 0, columns = 0;
  std::size_t pixels() const { return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns); }
};
inline bool operator==(PictureSize a, PictureSize b) { return a.rows == b.rows && a.columns == b.columns; }
inline bool operator!=(PictureSize a, PictureSize b) { return !(a == b); }

/// The camera's picture, row-major, and its textualization. An environment's pictures have one size
/// (EnvironmentType::picture_size()); a method may make others for its own use.
struct Observation {
  PictureSize size;
  std::vector<std::uint8_t> rgb;  // rows x columns x 3
  std::vector<std::uint8_t> ids;  // rows x columns; 0 where there is no object
  std::vector<Instance> instances;
  /// rows x columns. Bit k says that the object in row k of `instances` keeps light from what the pixel shows, whatever
  /// else does so too. Empty unless a method asks for it (Needs::shadows). repaint() takes shadows away by it.
  std::vector<std::uint16_t> shadows = {};
  /// What the picture need not show, such as where the agent is: numbers of EnvironmentType::state_of(). Empty where
  /// the task has none.
  std::vector<double> state = {};
  /// In episodes of several steps: what was brought so far, in order. An environment gives true names, a policy gets
  /// those that it was told when it took them.
  std::vector<Named> brought = {};
};

/// Brightness of a colour in an object's shadow, in 1/256 of its brightness in the light.
constexpr int shadow_brightness = 141;
/// How many instances `shadows` can tell apart.
constexpr std::size_t most_shadows = 16;

}  // namespace lgabench

#include <lgabench/learning/shown_input.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include <lgabench/core/contains.hpp>
#include <lgabench/learning/heat_map.hpp>

namespace lgabench {
namespace {

using Picture = PolicyInputs::Picture;
using Text = PolicyInputs::Text;

std::string name_of(Picture picture, const PolicyInputs& inputs) {
  if (picture == Picture::rgb) return "picture";
  if (picture == Picture::mask) return "goal mask";
  if (picture == Picture::instances) return "instances";
  return inputs.left_out.empty() ? "all objects" : fmt::format("all objects but the {}", inputs.left_out);
}

const char* name_of(Text text) { return text == Text::selection ? "φ̂ in words" : "the command's words"; }

std::string note_of(Picture picture, PolicyKind policy, const std::vector<float>& values) {
  std::vector<std::string> notes;
  if (std::any_of(values.begin(), values.end(), [](float value) { return value < 0; }))
    notes.emplace_back("red: to be avoided");
  if (policy == PolicyKind::centroid) notes.emplace_back("the policy takes the middle of what is white");
  if (policy == PolicyKind::heat_map && picture == Picture::rgb)
    notes.emplace_back("the policy takes what differs from the usual one");
  if (policy == PolicyKind::heat_map && picture != Picture::rgb)
    notes.push_back(
        fmt::format("the policy takes its share of {} × {} cells", HeatMap::rgb_size.rows, HeatMap::rgb_size.columns));
  return fmt::format("{}", fmt::join(notes, "; "));
}

}  // namespace

Shown shown_input(const PolicyInputs& offered, const PolicyInputs& inputs, PolicyKind policy, const Samples& read) {
  Shown shown;
  for (const Picture picture : offered.pictures)
    if (!contains(inputs.pictures, picture)) shown.unread.push_back(name_of(picture, offered));
  if (offered.text != Text::none)
    (inputs.text == Text::none ? shown.unread : shown.texts).emplace_back(name_of(offered.text));
  for (std::size_t i = 0; i < inputs.pictures.size(); ++i) {
    const auto& [size, channels] = read.shape.pictures[i];
    const auto draw = channels == 1 ? shown_mask : shown_colours;
    ShownPicture picture = draw(name_of(inputs.pictures[i], inputs), size, read.picture(i, 0));
    picture.note = note_of(inputs.pictures[i], policy, read.pictures[i]);
    shown.pictures.push_back(std::move(picture));
  }
  return shown;
}

}  // namespace lgabench

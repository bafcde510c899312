#include <lgabench/learning/shown_input.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/learning/featurizer.hpp>
#include <lgabench/learning/heat_map.hpp>
#include <lgabench/learning/policies.hpp>

namespace lgabench {
namespace {

using Picture = PolicyInputs::Picture;
using Text = PolicyInputs::Text;

Picture picture_from(const JsonReader& word) {
  if (word.string() == "mask") return Picture::mask;
  if (word.string() == "rgb") return Picture::rgb;
  if (word.string() == "segmentation") return Picture::segmentation;
  word.fail("mask, rgb or segmentation");
}

PolicyInputs inputs_from(const JsonReader& input) {
  PolicyInputs inputs;
  for (const JsonReader& word : input.at("pictures").elements()) inputs.pictures.push_back(picture_from(word));
  if (input.has("text")) inputs.text = input.at("text").string() == "selection" ? Text::selection : Text::utterance;
  if (input.has("left_out")) inputs.left_out = input.at("left_out").string();
  if (input.at("instances").string() == "first") inputs.instances = Instances::first;
  inputs.signed_mask = input.at("mask").string() == "signed";
  return inputs;
}

std::string name_of(Picture picture, const PolicyInputs& inputs) {
  if (picture == Picture::rgb) return "picture";
  if (picture == Picture::mask) return "goal mask";
  return inputs.left_out.empty() ? "all objects" : fmt::format("all objects but the {}", inputs.left_out);
}

const char* name_of(Text text) { return text == Text::selection ? "φ̂ in words" : "the command's words"; }

std::string note_of(Picture picture, const std::string& policy, const std::vector<float>& values) {
  std::string note;
  if (std::any_of(values.begin(), values.end(), [](float value) { return value < 0; })) note = "; red: to be avoided";
  if (policy == "centroid") note += "; the policy takes the middle of what is white";
  if (policy == "heat_map" && picture == Picture::rgb) note += "; the policy takes what differs from the usual one";
  if (policy == "heat_map" && picture != Picture::rgb)
    note +=
        fmt::format("; the policy takes its share of {} × {} cells", HeatMap::rgb_size.rows, HeatMap::rgb_size.columns);
  return note;
}

}  // namespace

ShownInput shown_input(const JsonReader& input, const Observation& observation, const Selection& selection,
                       const ActionSpace& actions) {
  const PolicyInputs offered = inputs_from(input);
  const std::string policy = input.at("policy").string();
  PolicyInputs read = inputs_of(read_policy_kind(input.at("policy")), offered, observation.size);
  ShownInput shown;
  for (const Picture picture : offered.pictures)
    if (std::find(read.pictures.begin(), read.pictures.end(), picture) == read.pictures.end())
      shown.unread.push_back(name_of(picture, offered));
  if (offered.text != Text::none)
    (read.text == Text::none ? shown.unread : shown.texts).emplace_back(name_of(offered.text));

  read.text = Text::none;  // what a sentence encoder makes of it is nothing to look at
  Featurizer featurizer(read, actions);
  Samples row(featurizer.shape(), 1);
  featurizer.write(observation, {"", selection}, Phase::test, row, 0);
  for (std::size_t i = 0; i < read.pictures.size(); ++i)
    shown.pictures.push_back({name_of(read.pictures[i], read), note_of(read.pictures[i], policy, row.pictures[i]),
                              row.shape.pictures[i].size, row.shape.pictures[i].channels, std::move(row.pictures[i])});
  return shown;
}

}  // namespace lgabench

void lgabench_shown_input(const lgabench::JsonReader& input, const lgabench::Observation& observation,
                          const lgabench::Selection& selection, const lgabench::ActionSpace& actions,
                          lgabench::ShownInput& shown) {
  shown = lgabench::shown_input(input, observation, selection, actions);
}

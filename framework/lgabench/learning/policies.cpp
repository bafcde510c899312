#include <lgabench/learning/policies.hpp>

#include <algorithm>

#include <lgabench/learning/centroid_policy.hpp>
#include <lgabench/learning/heat_map.hpp>
#include <lgabench/learning/network.hpp>
#include <lgabench/learning/scaled.hpp>

namespace lgabench {
namespace {

using Picture = PolicyInputs::Picture;

std::unique_ptr<Learner> regression(const SampleShape& rows, const Json& options, std::uint64_t seed) {
  const auto [architecture, spot, loss] = read_network_options(options);
  NetworkShape shape{
      {}, rows.text, architecture, static_cast<int>(rows.actions.size()), spot, static_cast<int>(rows.state.size())};
  for (const SampleShape::Picture& picture : rows.pictures) {
    if (!(picture.size == input_size)) throw InputError("inputs: expected pictures of 36 x 72 for policy=regression");
    shape.channels.push_back(picture.channels);
  }
  auto network = std::make_unique<Network>(shape, seed, loss);
  if (spot) return std::make_unique<ScaledLearner>(std::move(network), rows.actions);
  return network;
}

// The first mask alone, as it is seen.
PolicyInputs one_mask(PolicyInputs inputs, PictureSize native) {
  const auto mask = std::find_if(inputs.pictures.begin(), inputs.pictures.end(),
                                 [](Picture picture) { return picture != Picture::rgb; });
  if (mask == inputs.pictures.end()) throw InputError("options: /policy: centroid needs a mask among the inputs");
  inputs.pictures = {*mask};
  inputs.text = PolicyInputs::Text::none;
  inputs.signed_mask = true;
  inputs.mask_size = native;
  return inputs;
}

// All of them, at the sizes that it sees.
PolicyInputs places(PolicyInputs inputs, PictureSize native) {
  if (inputs.pictures.empty()) throw InputError("options: /policy: heat_map needs a picture among the inputs");
  inputs.signed_mask = true;
  inputs.mask_size = native;
  inputs.rgb_size = HeatMap::rgb_size;
  return inputs;
}

}  // namespace

PolicyInputs inputs_of(PolicyKind policy, PolicyInputs inputs, PictureSize native) {
  switch (policy) {
    case PolicyKind::centroid:
      return one_mask(std::move(inputs), native);
    case PolicyKind::heat_map:
      return places(std::move(inputs), native);
    case PolicyKind::regression:
      break;
  }
  return inputs;
}

std::unique_ptr<Learner> make_learner(PolicyKind policy, const SampleShape& shape, const Json& options,
                                      std::uint64_t seed) {
  switch (policy) {
    case PolicyKind::centroid:
      return std::make_unique<CentroidRule>(shape);
    case PolicyKind::heat_map:
      return std::make_unique<HeatMap>(shape, seed, options.value("copy_penalty", 0.));
    case PolicyKind::regression:
      break;
  }
  return regression(shape, options, seed);
}

}  // namespace lgabench

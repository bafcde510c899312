#include <lgabench/learning/policies.hpp>

#include <algorithm>

#include <lgabench/learning/centroid_policy.hpp>
#include <lgabench/learning/heat_map.hpp>
#include <lgabench/learning/network.hpp>
#include <lgabench/learning/scaled.hpp>

namespace lgabench {
namespace {

using Picture = PolicyInputs::Picture;

Architecture architecture_of(const JsonReader& network) {
  return named<Architecture>(network, {{"text", Architecture::text},
                                       {"released", Architecture::released},
                                       {"plain", Architecture::plain},
                                       {"spot", Architecture::plain}});
}

std::unique_ptr<Learner> regression(const SampleShape& rows, const JsonReader& options, std::uint64_t seed) {
  const Architecture architecture = architecture_of(options.at("network"));
  const bool spot = options.at("network").string() == "spot";
  const Loss loss = named<Loss>(options.at("loss"), {{"norm", Loss::norm}, {"squared", Loss::squared}});
  NetworkShape shape{{}, rows.text, architecture, static_cast<int>(rows.actions.size()), spot};
  for (const SampleShape::Picture& picture : rows.pictures) {
    if (!(picture.size == input_size)) throw InputError("inputs: expected pictures of 36 x 72 for policy=regression");
    shape.channels.push_back(picture.channels);
  }
  auto network = std::make_unique<Network>(shape, seed, loss);
  if (spot) return std::make_unique<ScaledLearner>(std::move(network), rows.actions);
  return network;
}

std::unique_ptr<Learner> centroid(const SampleShape& rows, const JsonReader&, std::uint64_t) {
  return std::make_unique<CentroidRule>(rows);
}

PolicyInputs as_they_are(PolicyInputs inputs, PictureSize) { return inputs; }

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

std::unique_ptr<Learner> heat_map(const SampleShape& rows, const JsonReader&, std::uint64_t seed) {
  return std::make_unique<HeatMap>(rows, seed);
}

// All of them, at the sizes that it sees.
PolicyInputs places(PolicyInputs inputs, PictureSize native) {
  if (inputs.pictures.empty()) throw InputError("options: /policy: heat_map needs a picture among the inputs");
  inputs.signed_mask = true;
  inputs.mask_size = native;
  inputs.rgb_size = HeatMap::rgb_size;
  return inputs;
}

struct Choice {
  PolicyInputs (*inputs)(PolicyInputs, PictureSize native);
  std::unique_ptr<Learner> (*make)(const SampleShape&, const JsonReader& options, std::uint64_t seed);
};

Choice choice(const std::string& policy) {
  static const std::vector<std::pair<std::string, Choice>> choices{
      {"regression", {as_they_are, regression}}, {"centroid", {one_mask, centroid}}, {"heat_map", {places, heat_map}}};
  const Json name = policy;
  return named(JsonReader(name, "options", "/policy"), choices);
}

}  // namespace

PolicyInputs inputs_of(const std::string& policy, PolicyInputs inputs, PictureSize native) {
  return choice(policy).inputs(std::move(inputs), native);
}

std::unique_ptr<Learner> make_learner(const std::string& policy, const SampleShape& shape, const JsonReader& options,
                                      std::uint64_t seed) {
  return choice(policy).make(shape, options, seed);
}

}  // namespace lgabench

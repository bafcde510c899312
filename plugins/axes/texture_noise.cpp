// Surfaces look otherwise than their labels say: hues turned, each object's one way or the other, and speckle. Where a
// truth names textures no hue is turned by more than 20 degrees, beyond which red would be orange.
#include <axes/pixels.hpp>
#include <lgabench/core/perturbations.hpp>

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace lgabench::perturbations {
namespace {

bool names_textures(const Scenario& scenario) {
  const std::size_t all = scenario.space.textures.size();
  return std::any_of(scenario.commands.begin(), scenario.commands.end(), [all](const ScenarioCommand& command) {
    const Meaning& target = command.truth.target;
    const auto some = [all](const FeatureSet& set) { return set.textures.size() < all; };
    return std::any_of(target.sets.begin(), target.sets.end(), some) ||
           (command.truth.second && some(*command.truth.second));
  });
}

}  // namespace

PerturbationAxis texture_noise() {
  PerturbationAxis axis{"texture_noise",
                        {"10 degrees of hue, speckle 2 %", "20 degrees, 5 %", "40 degrees, 10 %", "80 degrees, 20 %"},
                        {EpisodePart::rgb}};
  axis.perceive = [](Observation seen, const Scenario& scenario, int level, RandomStream stream) {
    constexpr std::array hue{10., 20., 40., 80.}, speckle{.02, .05, .1, .2};
    constexpr double most_where_named = 20, full_circle = 256;
    const auto at = static_cast<std::size_t>(level - 1);
    const double degrees = names_textures(scenario) ? std::min(hue.at(at), most_where_named) : hue.at(at);
    std::array<int, 256> turn{};
    for (int& one : turn) one = static_cast<int>(std::lround((stream.coin() ? 1 : -1) * degrees / 360 * full_circle));
    cv::Mat rgb = rgb_of(seen), hsv, turned;
    cv::cvtColor(rgb, hsv, cv::COLOR_RGB2HSV_FULL);
    for (std::size_t i = 0; i < seen.ids.size(); ++i)
      hsv.data[3 * i] = static_cast<std::uint8_t>(hsv.data[3 * i] + turn[seen.ids[i]]);  // round the circle
    cv::cvtColor(hsv, turned, cv::COLOR_HSV2RGB_FULL);
    for (std::size_t i = 0; i < seen.ids.size(); ++i) {
      const double noisy = 1 + speckle.at(at) * stream.gaussian();  // for every pixel: the next has its own
      if (seen.ids[i] == 0) continue;
      for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) seen.rgb[c] = to_byte(turned.data[c] * noisy);
    }
    return seen;
  };
  return axis;
}

}  // namespace lgabench::perturbations

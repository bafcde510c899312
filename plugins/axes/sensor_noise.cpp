// A worse camera: a blurred picture, and Gaussian noise on it.
#include <axes/pixels.hpp>
#include <lgabench/core/perturbations.hpp>

#include <opencv2/imgproc.hpp>

namespace lgabench::perturbations {

PerturbationAxis sensor_noise() {
  PerturbationAxis axis{"sensor_noise",
                        {"noise 2 %, blur of half a pixel", "5 %, 1 pixel", "10 %, 2 pixels", "20 %, 4 pixels"},
                        {EpisodePart::rgb}};
  axis.perceive = [](Observation seen, const Scenario&, int level, RandomStream stream) {
    constexpr std::array noise{.02, .05, .1, .2}, blur{.5, 1., 2., 4.};  // blur: of a picture of 256 columns
    const auto at = static_cast<std::size_t>(level - 1);
    cv::Mat rgb = rgb_of(seen);
    cv::GaussianBlur(rgb, rgb, cv::Size(), in_pixels(seen, blur.at(at)));  // of bytes: exact on every processor
    for (std::uint8_t& value : seen.rgb) value = to_byte(value + 255 * noise.at(at) * stream.gaussian());
    return seen;
  };
  return axis;
}

}  // namespace lgabench::perturbations

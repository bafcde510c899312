// A worse segmenter: borders that are too wide and too narrow by turns, objects that are missed, wrong labels.
#include <axes/pixels.hpp>
#include <lgabench/core/perturbations.hpp>

#include <algorithm>
#include <cmath>

#include <lgabench/abstraction/textualization.hpp>
#include <opencv2/imgproc.hpp>

namespace lgabench::perturbations {
namespace {

constexpr int fewest_pixels = 9;

cv::Mat disc(int radius) {
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(2 * radius + 1, 2 * radius + 1));
}

// Over what is no object.
void widen(cv::Mat& ids, std::uint8_t id, int by) {
  cv::Mat wide;
  cv::dilate(ids == id, wide, disc(by));
  ids.setTo(id, wide & (ids == 0));
}

// As far as so many pixels stay.
void narrow(cv::Mat& ids, std::uint8_t id, int by) {
  const cv::Mat before = ids == id;
  for (int radius = by; radius > 0; --radius) {
    cv::Mat left;
    cv::erode(before, left, disc(radius), cv::Point(-1, -1), 1, cv::BORDER_CONSTANT, cv::Scalar(255));
    if (cv::countNonZero(left) < fewest_pixels) continue;
    ids.setTo(0, before & ~left);
    return;
  }
}

}  // namespace

PerturbationAxis segmentation() {
  PerturbationAxis axis{"segmentation",
                        {"borders of 1 pixel; 5 % missed, 5 % mislabelled", "2 pixels; 10 %, 10 %",
                         "4 pixels; 20 %, 20 %", "8 pixels; 40 %, 40 %"},
                        {EpisodePart::ids},
                        {EpisodePart::instances}};
  axis.perceive = [](Observation seen, const Scenario& scenario, int level, RandomStream stream) {
    constexpr std::array border{1., 2., 4., 8.}, wrong{.05, .1, .2, .4};  // of a picture of 256 columns
    const auto at = static_cast<std::size_t>(level - 1);
    const int pixels = std::max(1, static_cast<int>(std::lround(in_pixels(seen, border.at(at)))));
    cv::Mat ids = ids_of(seen);
    bool wider = stream.coin();
    for (const Instance& instance : seen.instances) {
      wider ? widen(ids, instance.id, pixels) : narrow(ids, instance.id, pixels);
      wider = !wider;
    }
    seen = imperfect_textualization(std::move(seen), scenario.space, {wrong.at(at), wrong.at(at)}, stream);
    for (Instance& instance : seen.instances)
      instance.pixels = static_cast<int>(std::count(seen.ids.begin(), seen.ids.end(), instance.id));
    return seen;
  };
  return axis;
}

}  // namespace lgabench::perturbations

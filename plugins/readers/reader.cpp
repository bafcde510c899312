#include <readers/reader.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/error.hpp>
#include <readers/features.hpp>

#include <opencv2/imgproc.hpp>

namespace lgabench::seeing {
namespace {

constexpr std::string_view first_line = "lgabench reader 1\n";

const std::string& most_voted(const Forest& forest, const std::vector<float>& row, const std::vector<bool>& known) {
  const std::vector<int> votes = forest.votes(row);
  std::size_t best = votes.size();
  for (std::size_t i = 0; i < votes.size(); ++i)
    if (known[i] && (best == votes.size() || votes[i] > votes[best])) best = i;
  return forest.classes()[best];
}

std::vector<bool> known(const Forest& forest, const std::vector<std::string>& names, const char* what) {
  std::vector<bool> all;
  for (const std::string& name : forest.classes()) all.push_back(contains(names, name));
  if (!contains(all, true)) throw InputError(fmt::format("reader: it learned no {} of this feature space", what));
  return all;
}

// Of each pixel: how far its colour is from the empty place's, in the light or in an object's shadow.
cv::Mat differences(const Observation& seen, const Observation& empty) {
  cv::Mat far(seen.size.rows, seen.size.columns, CV_8U);
  for (std::size_t i = 0; i < seen.size.pixels(); ++i) {
    int lit = 0, shaded = 0;
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      lit = std::max(lit, std::abs(seen.rgb[c] - empty.rgb[c]));
      shaded = std::max(shaded, std::abs(seen.rgb[c] - empty.rgb[c] * shadow_brightness / 256));
    }
    far.data[i] = static_cast<std::uint8_t>(std::min(lit, shaded));
  }
  return far;
}

}  // namespace

std::string Model::bytes() const {
  std::string bytes(first_line);
  object_types.save(bytes);
  textures.save(bytes);
  return bytes;
}

Model Model::of(std::string_view bytes) {
  if (bytes.substr(0, first_line.size()) != first_line) throw InputError("reader: a file of another version");
  bytes.remove_prefix(first_line.size());
  Model model;
  model.object_types = Forest::load(bytes);
  model.textures = Forest::load(bytes);
  return model;
}

std::array<double, 3> colour_of_table(const Observation& seen) {
  std::array<std::array<int, 256>, 3> counts{};
  int all = 0;
  for (std::size_t i = 0; i < seen.ids.size(); ++i) {
    if (seen.ids[i]) continue;
    ++all;
    for (std::size_t c = 0; c < 3; ++c) ++counts[c][seen.rgb[3 * i + c]];
  }
  std::array<double, 3> medians{};
  for (std::size_t c = 0; c < 3; ++c) {
    std::size_t value = 0;
    for (int sum = counts[c][0]; value < 255 && 2 * sum < all;) sum += counts[c][++value];
    medians[c] = std::max(1., static_cast<double>(value));
  }
  return medians;
}

Observation balanced(Observation seen, const std::array<double, 3>& usual) {
  const std::array<double, 3> now = colour_of_table(seen);
  std::array<std::array<std::uint8_t, 256>, 3> as{};
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t value = 0; value < 256; ++value)
      as[c][value] =
          static_cast<std::uint8_t>(std::min(255L, std::lround(static_cast<double>(value) * usual[c] / now[c])));
  for (std::size_t i = 0; i < seen.rgb.size(); ++i) seen.rgb[i] = as[i % 3][seen.rgb[i]];
  return seen;
}

Observation segments_by_difference(Observation seen, const Observation& empty, bool balances, RandomStream random) {
  constexpr int nearest = 10, fewest_pixels = 25, most = 255;
  seen.instances.clear();
  seen.shadows.clear();
  std::fill(seen.ids.begin(), seen.ids.end(), std::uint8_t{0});
  cv::Mat far = differences(balances ? balanced(seen, colour_of_table(empty)) : seen, empty);
  cv::Mat things = far > nearest, labels, statistics, middles;
  cv::morphologyEx(things, things, cv::MORPH_CLOSE, cv::Mat::ones(3, 3, CV_8U));
  const int count = cv::connectedComponentsWithStats(things, labels, statistics, middles, 8, CV_32S);
  std::vector<int> kept;
  for (int label = 1; label < count; ++label)
    if (statistics.at<int>(label, cv::CC_STAT_AREA) >= fewest_pixels && static_cast<int>(kept.size()) < most)
      kept.push_back(label);
  const std::vector<int> order = random.permutation(static_cast<int>(kept.size()));
  std::vector<std::uint8_t> id_of(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < kept.size(); ++i)
    id_of[static_cast<std::size_t>(kept[i])] = static_cast<std::uint8_t>(order[i] + 1);
  for (std::size_t i = 0; i < seen.ids.size(); ++i)
    seen.ids[i] = id_of[static_cast<std::size_t>(labels.at<int>(static_cast<int>(i)))];
  return seen;
}

Reader::Reader(Model model, const FeatureSpace& space)
    : model_(std::move(model)),
      types_(known(model_.object_types, space.object_types, "object type")),
      textures_(known(model_.textures, space.textures, "texture")) {}

std::vector<Instance> Reader::names(const Observation& seen) const {
  std::array<int, 256> pixels{};
  for (const std::uint8_t id : seen.ids) ++pixels[id];
  const Picture picture(seen);
  std::vector<Instance> all;
  for (std::size_t id = 1; id < pixels.size(); ++id) {
    if (pixels[id] == 0) continue;
    const auto at = static_cast<std::uint8_t>(id);
    all.push_back({at, most_voted(model_.object_types, shape_features(picture, at), types_),
                   most_voted(model_.textures, surface_features(picture, at), textures_), pixels[id]});
  }
  return all;
}

}  // namespace lgabench::seeing

#include <readers/features.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <lgabench/core/geometry.hpp>

#include <opencv2/imgproc.hpp>

namespace lgabench::seeing {
namespace {

using Features = std::vector<float>;

void add(Features& all, double value) { all.push_back(static_cast<float>(value)); }

// The values at these shares of the sorted list.
void add_quantiles(Features& all, std::vector<int>& values, int count) {
  std::sort(values.begin(), values.end());
  for (int i = 0; i < count; ++i) {
    const double at = values.empty() ? 0 : static_cast<double>(values.size() - 1) * (i + .5) / count;
    add(all, values.empty() ? 0 : values[static_cast<std::size_t>(std::lround(at))]);
  }
}

void add_shares(Features& all, const std::vector<double>& counts) {
  double sum = 0;
  for (const double count : counts) sum += count;
  for (const double count : counts) add(all, sum > 0 ? count / sum : 0);
}

// Of the largest outline, as a share of its mean: strengths of the waves in its distance from the middle.
void add_waves(Features& all, const std::vector<cv::Point>& outline, cv::Point2d middle) {
  constexpr int rays = 48, waves = 14;
  std::array<double, rays> reach{};
  for (const cv::Point& p : outline) {
    const double x = p.x - middle.x, y = p.y - middle.y;
    const double turn = (std::atan2(y, x) + pi) / (2 * pi) * rays;
    double& far = reach[static_cast<std::size_t>(turn) % rays];
    far = std::max(far, std::sqrt(x * x + y * y));
  }
  for (std::size_t i = 0; i < rays; ++i)
    if (reach[i] == 0) reach[i] = std::max(reach[(i + rays - 1) % rays], reach[(i + 1) % rays]);
  double mean = 0;
  for (const double r : reach) mean += r / rays;
  for (int wave = 1; wave <= waves; ++wave) {
    double real = 0, imaginary = 0;
    for (int i = 0; i < rays; ++i) {
      const double turn = 2 * pi * wave * i / rays, r = reach[static_cast<std::size_t>(i)];
      real += r * std::cos(turn);
      imaginary += r * std::sin(turn);
    }
    add(all, mean > 0 ? std::sqrt(real * real + imaginary * imaginary) / (rays * mean) : 0);
  }
}

// How much of the table beside the segment, so many pixels towards the lower right, is in the shade.
void add_shadow(Features& all, const Picture& picture, const cv::Mat& mask, cv::Point corner) {
  constexpr double right = .8, down = .6;  // where the usual light's shadows fall
  for (const int pixels : {2, 4, 6, 8, 10, 12, 14, 17, 20}) {
    const int dx = static_cast<int>(std::lround(right * pixels)), dy = static_cast<int>(std::lround(down * pixels));
    const int last_row = std::min(mask.rows, picture.ids.rows - corner.y - dy),
              last_column = std::min(mask.cols, picture.ids.cols - corner.x - dx);
    int beside = 0, dark = 0;
    for (int row = 0; row < last_row; ++row) {
      const auto* const in = mask.ptr<std::uint8_t>(row);
      const auto* const ids = picture.ids.ptr<std::uint8_t>(corner.y + row + dy) + corner.x + dx;
      const auto* const lab = picture.lab.ptr<cv::Vec3b>(corner.y + row + dy) + corner.x + dx;
      for (int column = 0; column < last_column; ++column) {
        if (!in[column] || ids[column]) continue;
        ++beside;
        dark += lab[column][0] > .4 * picture.lightness && lab[column][0] < .8 * picture.lightness;
      }
    }
    add(all, beside > 0 ? static_cast<double>(dark) / beside : -1);
  }
}

cv::Mat inside(const cv::Mat& mask) {
  constexpr int fewest = 24;
  cv::Mat within;
  cv::erode(mask, within, cv::Mat::ones(3, 3, CV_8U), cv::Point(-1, -1), 1, cv::BORDER_CONSTANT, cv::Scalar(255));
  return cv::countNonZero(within) < fewest ? mask : within;
}

}  // namespace

Picture::Picture(const Observation& seen)
    : rgb(seen.size.rows, seen.size.columns, CV_8UC3, const_cast<std::uint8_t*>(seen.rgb.data())),
      ids(seen.size.rows, seen.size.columns, CV_8U, const_cast<std::uint8_t*>(seen.ids.data())) {
  [[maybe_unused]] static const bool once = (cv::setNumThreads(0), true);  // other cells have the other cores
  cv::cvtColor(rgb, lab, cv::COLOR_RGB2Lab);
  cv::Mat lightness_of;
  cv::extractChannel(lab, lightness_of, 0);
  cv::Sobel(lightness_of, gx, CV_16S, 1, 0);
  cv::Sobel(lightness_of, gy, CV_16S, 0, 1);
  std::array<int, 256> counts{};
  std::array<cv::Point, 256> low, high;
  low.fill({ids.cols, ids.rows});
  high.fill({-1, -1});
  int all = 0;
  for (int row = 0; row < ids.rows; ++row) {
    const auto* const of = ids.ptr<std::uint8_t>(row);
    const auto* const colours = lab.ptr<cv::Vec3b>(row);
    for (int column = 0; column < ids.cols; ++column) {
      if (const std::uint8_t id = of[column]) {
        low[id] = {std::min(low[id].x, column), std::min(low[id].y, row)};
        high[id] = {std::max(high[id].x, column), row};
      } else {
        ++counts[colours[column][0]];
        ++all;
      }
    }
  }
  for (std::size_t id = 1; id < around.size(); ++id)
    if (high[id].x >= 0)
      around[id] = cv::Rect(low[id] - cv::Point(1, 1), high[id] + cv::Point(2, 2)) & cv::Rect({}, ids.size());
  int sum = 0, middle = 0;
  while (middle < 255 && 2 * (sum += counts[static_cast<std::size_t>(middle)]) < all) ++middle;
  lightness = std::max(1, middle);
}

std::vector<float> shape_features(const Picture& picture, std::uint8_t id) {
  const cv::Rect around = picture.around[id];
  if (around.empty()) return {};
  const cv::Mat mask = picture.ids(around) == id;
  const double area = cv::countNonZero(mask);
  Features all;
  add(all, area);
  const cv::Moments moments = cv::moments(mask, true);
  std::array<double, 7> hu{};
  cv::HuMoments(moments, hu.data());
  for (const double h : hu) add(all, std::copysign(std::log10(std::abs(h) + 1e-12) + 12, h));
  std::vector<std::vector<cv::Point>> outlines;
  std::vector<cv::Vec4i> tree;
  cv::findContours(mask, outlines, tree, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
  std::size_t largest = 0;
  double holes = 0, in_holes = 0, most = -1;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    const double of = cv::contourArea(outlines[i]);
    if (tree[i][3] >= 0) {
      holes += of > 2;
      in_holes += of;
      continue;
    }
    if (of > most) {
      most = of;
      largest = i;
    }
  }
  const std::vector<cv::Point>& outline = outlines[largest];
  std::vector<cv::Point> hull;
  cv::convexHull(outline, hull);
  const double hull_area = std::max(1., cv::contourArea(hull)), length = cv::arcLength(outline, true);
  const cv::RotatedRect box = cv::minAreaRect(outline);
  const double longer = std::max(box.size.width, box.size.height) + 1,
               shorter = std::min(box.size.width, box.size.height) + 1;
  cv::Point2f round_middle;
  float radius = 0;
  cv::minEnclosingCircle(outline, round_middle, radius);
  for (const double value :
       {holes, in_holes, in_holes / area, most / hull_area, area / hull_area, longer, shorter, shorter / longer,
        area / (longer * shorter), length, length * length / area, static_cast<double>(radius),
        area / (pi * radius * radius + 1), length / cv::arcLength(hull, true)})
    add(all, value);
  for (const double within : {.02, .04, .07}) {
    std::vector<cv::Point> corners;
    cv::approxPolyDP(outline, corners, within * length, true);
    add(all, static_cast<double>(corners.size()));
  }
  cv::Mat distance;
  cv::distanceTransform(mask, distance, cv::DIST_L1, 3, CV_8U);
  double widest = 0;
  cv::minMaxLoc(distance, nullptr, &widest);
  add(all, widest);
  const cv::Point2d middle{moments.m10 / moments.m00, moments.m01 / moments.m00};
  add(all, std::hypot(middle.x - round_middle.x, middle.y - round_middle.y) / (radius + 1));
  add_waves(all, outline, middle);
  add_shadow(all, picture, mask, around.tl());
  return all;
}

std::vector<float> surface_features(const Picture& picture, std::uint8_t id) {
  const cv::Rect around = picture.around[id];
  if (around.empty()) return {};
  const cv::Mat within = inside(picture.ids(around) == id), lab_of = picture.lab(around), gx_of = picture.gx(around),
                gy_of = picture.gy(around);
  constexpr int by_l = 6, by_ab = 8, directions = 8;
  std::vector<double> colours(by_l * by_ab * by_ab), turns(directions), neighbours(9), equal(9);
  std::array<std::vector<int>, 3> channels;
  std::vector<int> edges;
  double xx = 0, yy = 0, xy = 0;
  for (int row = 0; row < within.rows; ++row)
    for (int column = 0; column < within.cols; ++column) {
      if (!within.at<std::uint8_t>(row, column)) continue;
      const cv::Vec3b& lab = lab_of.at<cv::Vec3b>(row, column);
      const auto bin = [](int value) { return std::clamp((value - 128 + 80) / 20, 0, by_ab - 1); };
      colours[static_cast<std::size_t>((lab[0] * by_l / 256 * by_ab + bin(lab[1])) * by_ab + bin(lab[2]))] += 1;
      for (int c = 0; c < 3; ++c) channels[static_cast<std::size_t>(c)].push_back(lab[c]);
      const int gx = gx_of.at<std::int16_t>(row, column), gy = gy_of.at<std::int16_t>(row, column);
      const double strength = std::sqrt(gx * gx + gy * gy);
      edges.push_back(static_cast<int>(strength));
      xx += gx * gx;
      yy += gy * gy;
      xy += gx * gy;
      const double turn = (std::atan2(gy, gx) + pi) / pi * directions;  // opposite directions are one
      turns[static_cast<std::size_t>(turn) % directions] += strength;
      // How many of eight neighbours two pixels away are lighter, and how many alike.
      int lighter = 0, alike = 0;
      for (int dy = -2; dy <= 2; dy += 2)
        for (int dx = -2; dx <= 2; dx += 2) {
          const int y = row + dy, x = column + dx;
          if ((dx == 0 && dy == 0) || y < 0 || x < 0 || y >= within.rows || x >= within.cols) continue;
          if (!within.at<std::uint8_t>(y, x)) continue;
          const int difference = lab_of.at<cv::Vec3b>(y, x)[0] - lab[0];
          lighter += difference > 6;
          alike += std::abs(difference) <= 6;
        }
      neighbours[static_cast<std::size_t>(lighter)] += 1;
      equal[static_cast<std::size_t>(alike)] += 1;
    }
  Features all;
  add_shares(all, colours);
  for (std::vector<int>& channel : channels) add_quantiles(all, channel, 9);
  add_quantiles(all, edges, 6);
  add(all, xx + yy > 0 ? std::sqrt((xx - yy) * (xx - yy) + 4 * xy * xy) / (xx + yy) : 0);
  std::rotate(turns.begin(), std::max_element(turns.begin(), turns.end()), turns.end());
  add_shares(all, turns);
  add_shares(all, neighbours);
  add_shares(all, equal);
  return all;
}

}  // namespace lgabench::seeing

// Numbers that describe one segment of a picture: its shape and its shadow, and what its surface looks like.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include <lgabench/core/observation.hpp>

#include <opencv2/core.hpp>

namespace lgabench::seeing {

/// A picture as OpenCV sees it, and what all of its segments share. Refers to the observation.
struct Picture {
  explicit Picture(const Observation& seen);

  cv::Mat rgb, ids;                  // rows x columns x 3 and rows x columns, 8 bits
  cv::Mat lab;                       // likewise, 8 bits
  cv::Mat gx, gy;                    // derivatives of the lightness along columns and rows, 16 bits
  double lightness = 0;              // in lab, the median over what belongs to no segment
  std::array<cv::Rect, 256> around;  // each segment, with a pixel on each side where the picture has one
};

/// The features of segment `id`, empty where it has no pixel. Shape: size, moments, outline, holes, and how far its
/// shadow reaches on the table, which tells high from flat from straight above. Surface: colours and their quantiles,
/// edges, directions. Both are computed in integers or element by element in doubles: the same on every processor.
std::vector<float> shape_features(const Picture& picture, std::uint8_t id);
std::vector<float> surface_features(const Picture& picture, std::uint8_t id);

}  // namespace lgabench::seeing

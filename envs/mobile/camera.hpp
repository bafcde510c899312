// A perspective camera: where it shows what.
#pragma once
#include <cmath>

#include <common/light.hpp>
#include <lgabench/core/observation.hpp>

namespace lgabench::mobile {

/// Without distortion, square pixels. A value.
class Camera {
 public:
  /// Looks along `yaw_rad` (0: +x), `pitch_rad` below the horizon. `across_rad`: the horizontal field of view.
  Camera(Vec3 eye_m, double yaw_rad, double pitch_rad, double across_rad, PictureSize picture)
      : eye(eye_m),
        size(picture),
        forward{std::cos(pitch_rad) * std::cos(yaw_rad), std::cos(pitch_rad) * std::sin(yaw_rad), -std::sin(pitch_rad)},
        right{std::sin(yaw_rad), -std::cos(yaw_rad), 0},
        down(common::cross(forward, right)),
        focal_px(picture.columns / 2. / std::tan(across_rad / 2)) {}

  /// Metres along the optical axis.
  double depth(Vec3 point) const { return common::dot(point - eye, forward); }
  /// In pixels: x its row, y its column, whole numbers at pixels' centres. @pre depth(point) > 0
  Vec2 at(Vec3 point) const {
    const Vec3 way = point - eye;
    const double scale = focal_px / common::dot(way, forward);
    return {size.rows / 2. - .5 + scale * common::dot(way, down),
            size.columns / 2. - .5 + scale * common::dot(way, right)};
  }
  /// The way from the eye to a metre's depth at this pixel's centre.
  Vec3 ray(int row, int column) const {
    return forward + (row + .5 - size.rows / 2.) / focal_px * down +
           (column + .5 - size.columns / 2.) / focal_px * right;
  }

  const Vec3 eye;
  const PictureSize size;

 private:
  const Vec3 forward, right, down;  // unit vectors
  const double focal_px;
};

/// The robot's, at its start.
inline const Camera& front_camera() {
  static const Camera camera({0, 0, 1.6}, 0, pi / 4, 55 * pi / 180, {480, 640});
  return camera;
}

}  // namespace lgabench::mobile

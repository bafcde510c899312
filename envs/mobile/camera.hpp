// A perspective camera: where it shows what.
#pragma once
#include <cmath>

#include <common/light.hpp>
#include <lgabench/core/observation.hpp>
#include <lgabench/core/view.hpp>

namespace lgabench::mobile {

/// Without distortion, square pixels.
class Camera {
 public:
  /// Looks along `yaw_rad` (0: +x), `pitch_rad` below the horizon. `across_rad`: the horizontal field of view, which
  /// `zoom` narrows.
  Camera(Vec3 eye_m, double yaw_rad, double pitch_rad, double across_rad, PictureSize picture, double zoom = 1)
      : eye(eye_m),
        size(picture),
        forward{std::cos(pitch_rad) * std::cos(yaw_rad), std::cos(pitch_rad) * std::sin(yaw_rad), -std::sin(pitch_rad)},
        right{std::sin(yaw_rad), -std::cos(yaw_rad), 0},
        down(common::cross(forward, right)),
        focal_px(zoom * (picture.columns / 2. / std::tan(across_rad / 2))),
        yaw(yaw_rad),
        pitch(pitch_rad),
        across(across_rad) {}

  /// The camera in that view; in the usual one this camera, to the bit.
  Camera in(const View& view) const {
    return {eye + view.shift_m.x * right + view.shift_m.y * down,
            yaw + view.turn_rad.x,
            pitch + view.turn_rad.y,
            across,
            size,
            view.zoom};
  }

  /// Metres along the optical axis.
  double depth(Vec3 point) const { return common::dot(point - eye, forward); }
  /// Where the point is seen, in pixels: x is its row, y its column, whole numbers at pixels' centres. @pre
  /// depth(point) > 0
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

  Vec3 eye;
  PictureSize size;

 private:
  Vec3 forward, right, down;  // unit vectors
  double focal_px, yaw, pitch, across;
};

/// The robot's, at its start.
inline const Camera& front_camera() {
  static const Camera camera({0, 0, 1.6}, 0, pi / 4, 55 * pi / 180, {480, 640});
  return camera;
}

}  // namespace lgabench::mobile

#include <lgabench/learning/places.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lgabench {
namespace {

constexpr int rows = native_size.rows, columns = native_size.columns;
constexpr std::size_t pixels = std::size_t{rows} * columns;

bool is_target(const float* mask, int row, int column) {
  return row >= 0 && row < rows && column >= 0 && column < columns && mask[row * columns + column] > 0;
}

bool within_target(const float* mask, int row, int column, int margin) {
  for (int r = row - margin; r <= row + margin; ++r)
    for (int c = column - margin; c <= column + margin; ++c)
      if (!is_target(mask, r, c)) return false;
  return true;
}

// A sum of points, for their mean.
struct Centroid {
  Vec2 sum;
  int count = 0;
  void add(Vec2 point) {
    sum = sum + point;
    ++count;
  }
  Vec2 mean() const { return 1.0 / count * sum; }
};

}  // namespace

Vec2 middle_of(PictureSize size, int row, int column) {
  return {Workspace::x_min + (row + .5) / size.rows * (Workspace::x_max - Workspace::x_min),
          Workspace::y_min + (column + .5) / size.columns * (Workspace::y_max - Workspace::y_min)};
}

bool on_target(const float* mask, Vec2 point) {
  const auto index = [](double from, double to, double value, int count) {
    return static_cast<int>(std::floor((value - from) / (to - from) * count));
  };
  return is_target(mask, index(Workspace::x_min, Workspace::x_max, point.x, rows),
                   index(Workspace::y_min, Workspace::y_max, point.y, columns));
}

Vec2 onto_target(const float* mask, Vec2 point) {
  const Vec2 half_pixel = .5 * (middle_of(native_size, 1, 1) - middle_of(native_size, 0, 0));
  for (const int margin : {2, 0}) {
    Vec2 nearest = point;
    double least = std::numeric_limits<double>::infinity();
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c) {
        if (!within_target(mask, r, c, margin)) continue;
        const Vec2 away = middle_of(native_size, r, c) - point;
        if (std::abs(away.x) <= half_pixel.x && std::abs(away.y) <= half_pixel.y) return point;
        if (norm(away) < least) {
          least = norm(away);
          nearest = middle_of(native_size, r, c);
        }
      }
    if (std::isfinite(least)) return nearest;
  }
  return point;
}

std::optional<Vec2> avoided_in(const float* mask) {
  Centroid avoided;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      if (mask[r * columns + c] < 0) avoided.add(middle_of(native_size, r, c));
  if (avoided.count == 0) return std::nullopt;
  return avoided.mean();
}

struct Eye::Piece {
  int id = 0;
  Centroid middles{};
  double rank = std::numeric_limits<double>::infinity();  // the least is chosen
};

Eye::Eye() : piece_of_(pixels), alone_(pixels) { pending_.reserve(pixels); }

std::optional<Vec2> Eye::taken(const float* mask, const Vec2* pose0) {
  std::fill(piece_of_.begin(), piece_of_.end(), 0);
  Piece best;
  int pieces = 0;
  for (int pixel = 0; pixel < rows * columns; ++pixel) {
    if (mask[pixel] <= 0 || piece_of_[static_cast<std::size_t>(pixel)] != 0) continue;
    const Piece piece = fill(mask, pixel, ++pieces, pose0);
    if (piece.rank < best.rank) best = piece;
  }
  if (best.id == 0) return std::nullopt;
  std::transform(piece_of_.begin(), piece_of_.end(), alone_.begin(), [&](int id) { return id == best.id ? 1.f : 0.f; });
  return onto_target(alone_.data(), best.middles.mean());
}

// Numbers the pixels that hang together with this one, over edges and corners.
Eye::Piece Eye::fill(const float* mask, int pixel, int id, const Vec2* pose0) {
  Piece piece;
  piece.id = id;
  double nearest = std::numeric_limits<double>::infinity();
  const auto reach = [&](int r, int c) {
    if (!is_target(mask, r, c)) return;
    int& of_pixel = piece_of_[static_cast<std::size_t>(r * columns + c)];
    if (of_pixel != 0) return;
    of_pixel = id;
    pending_.push_back(r * columns + c);
    const Vec2 middle = middle_of(native_size, r, c);
    piece.middles.add(middle);
    if (pose0) nearest = std::min(nearest, norm(*pose0 - middle));
  };
  reach(pixel / columns, pixel % columns);
  while (!pending_.empty()) {
    const int r = pending_.back() / columns, c = pending_.back() % columns;
    pending_.pop_back();
    for (int y = r - 1; y <= r + 1; ++y)
      for (int x = c - 1; x <= c + 1; ++x) reach(y, x);
  }
  piece.rank = pose0 ? nearest : -piece.middles.count;
  return piece;
}

}  // namespace lgabench

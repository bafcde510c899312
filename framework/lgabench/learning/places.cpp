#include <lgabench/learning/places.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

bool within_target(const FieldMask& mask, int row, int column, int margin) {
  for (int r = row - margin; r <= row + margin; ++r)
    for (int c = column - margin; c <= column + margin; ++c)
      if (!mask.is_target(r, c)) return false;
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

Field::Field(const ActionSpace& actions) {
  if (actions.places.empty()) throw InputError("actions: expected a place in the picture among their numbers");
  const ActionNumber &down = actions.numbers[actions.places[0].down],
                     &across = actions.numbers[actions.places[0].across];
  x_low = down.low;
  x_high = down.high;
  y_low = across.low;
  y_high = across.high;
}

Vec2 Field::middle_of(PictureSize picture, int row, int column) const {
  return {x_low + (row + .5) / picture.rows * (x_high - x_low),
          y_low + (column + .5) / picture.columns * (y_high - y_low)};
}

bool FieldMask::on_target(Vec2 point) const {
  const auto index = [](double from, double to, double value, int count) {
    return static_cast<int>(std::floor((value - from) / (to - from) * count));
  };
  return is_target(index(field.x_low, field.x_high, point.x, size.rows),
                   index(field.y_low, field.y_high, point.y, size.columns));
}

Vec2 FieldMask::onto_target(Vec2 point) const {
  const Vec2 half_pixel = .5 * (middle_of(1, 1) - middle_of(0, 0));
  for (const int margin : {2, 0}) {
    Vec2 nearest = point;
    double least = std::numeric_limits<double>::infinity();
    for (int r = 0; r < size.rows; ++r)
      for (int c = 0; c < size.columns; ++c) {
        if (!within_target(*this, r, c, margin)) continue;
        const Vec2 away = middle_of(r, c) - point;
        if (std::abs(away.x) <= half_pixel.x && std::abs(away.y) <= half_pixel.y) return point;
        if (norm(away) < least) {
          least = norm(away);
          nearest = middle_of(r, c);
        }
      }
    if (std::isfinite(least)) return nearest;
  }
  return point;
}

std::optional<Vec2> FieldMask::avoided() const {
  Centroid avoided;
  for (int r = 0; r < size.rows; ++r)
    for (int c = 0; c < size.columns; ++c)
      if (pixels[r * size.columns + c] < 0) avoided.add(middle_of(r, c));
  if (avoided.count == 0) return std::nullopt;
  return avoided.mean();
}

struct Eye::Piece {
  int id = 0;
  Centroid middles{};
  double rank = std::numeric_limits<double>::infinity();  // the least is chosen
};

std::optional<Vec2> Eye::taken(const FieldMask& mask, const Vec2* begin) {
  piece_of_.assign(mask.size.pixels(), 0);
  pending_.reserve(mask.size.pixels());
  alone_.resize(mask.size.pixels());
  Piece best;
  int pieces = 0;
  for (int pixel = 0; pixel < static_cast<int>(piece_of_.size()); ++pixel) {
    if (mask.pixels[pixel] <= 0 || piece_of_[static_cast<std::size_t>(pixel)] != 0) continue;
    const Piece piece = fill(mask, pixel, ++pieces, begin);
    if (piece.rank < best.rank) best = piece;
  }
  if (best.id == 0) return std::nullopt;
  std::transform(piece_of_.begin(), piece_of_.end(), alone_.begin(), [&](int id) { return id == best.id ? 1.f : 0.f; });
  return FieldMask{alone_.data(), mask.size, mask.field}.onto_target(best.middles.mean());
}

// Numbers the pixels that hang together with this one, over edges and corners.
Eye::Piece Eye::fill(const FieldMask& mask, int pixel, int id, const Vec2* begin) {
  const int columns = mask.size.columns;
  Piece piece;
  piece.id = id;
  double nearest = std::numeric_limits<double>::infinity();
  const auto reach = [&](int r, int c) {
    if (!mask.is_target(r, c)) return;
    int& of_pixel = piece_of_[static_cast<std::size_t>(r * columns + c)];
    if (of_pixel != 0) return;
    of_pixel = id;
    pending_.push_back(r * columns + c);
    const Vec2 middle = mask.middle_of(r, c);
    piece.middles.add(middle);
    if (begin) nearest = std::min(nearest, norm(*begin - middle));
  };
  reach(pixel / columns, pixel % columns);
  while (!pending_.empty()) {
    const int r = pending_.back() / columns, c = pending_.back() % columns;
    pending_.pop_back();
    for (int y = r - 1; y <= r + 1; ++y)
      for (int x = c - 1; x <= c + 1; ++x) reach(y, x);
  }
  piece.rank = begin ? nearest : -piece.middles.count;
  return piece;
}

}  // namespace lgabench

#include <algorithm>
#include <cmath>

#include <lgabench/core/method.hpp>

namespace lgabench {
namespace {

constexpr double on_it = 2;  // pixels: as far as a drawn edge may be from the body's

// Every pixel of what can be taken: its middle, and whose it is.
struct Pixel {
  Vec2 middle;
  std::uint8_t id;
};

std::vector<Pixel> takeable(const Observation& seen) {
  std::vector<bool> listed(256, false);
  for (const Instance& instance : seen.instances) listed[instance.id] = !is_place(instance.object_type);
  std::vector<Pixel> pixels;
  const auto columns = static_cast<std::size_t>(seen.size.columns);
  for (std::size_t i = 0; i < seen.ids.size(); ++i)
    if (seen.ids[i] != 0 && listed[seen.ids[i]])
      pixels.push_back({{static_cast<double>(i % columns) + .5, static_cast<double>(i / columns) + .5}, seen.ids[i]});
  return pixels;
}

const Pixel& nearest_to(Vec2 point, const std::vector<Pixel>& pixels) {
  return *std::min_element(pixels.begin(), pixels.end(), [point](const Pixel& a, const Pixel& b) {
    return norm(a.middle - point) < norm(b.middle - point);
  });
}

}  // namespace

std::optional<std::uint8_t> taken(const Step& step, const ActionSpace& actions) {
  if (step.label.empty() || actions.places.empty()) return std::nullopt;
  const std::vector<Pixel> pixels = takeable(step.observation);
  if (pixels.empty()) return std::nullopt;
  const auto place = [&](std::size_t i) {
    return in_picture(actions, actions.places[i], step.label, step.observation.size);
  };
  const Vec2 from = place(0);
  const Pixel& nearest = nearest_to(from, pixels);
  if (norm(nearest.middle - from) <= on_it || actions.places.size() < 2) return nearest.id;
  const Vec2 way = place(1) - from;
  const int steps = static_cast<int>(std::ceil(norm(way)));
  for (int i = 1; i <= steps; ++i) {
    const Vec2 point = from + static_cast<double>(i) / steps * way;
    const Pixel& met = nearest_to(point, pixels);
    if (norm(met.middle - point) <= 1) return met.id;
  }
  return nearest.id;
}

std::optional<std::uint8_t> taken(const Demonstration& demonstration, const ActionSpace& actions) {
  return taken(demonstration.steps.at(0), actions);
}

}  // namespace lgabench

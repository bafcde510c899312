#include <lgabench/abstraction/repaint.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

namespace lgabench {
namespace {

std::uint32_t packed(const std::uint8_t* rgb) {
  return static_cast<std::uint32_t>(rgb[0] << 16 | rgb[1] << 8 | rgb[2]);
}
Colour unpacked(std::uint32_t colour) {
  return {static_cast<std::uint8_t>(colour >> 16), static_cast<std::uint8_t>(colour >> 8),
          static_cast<std::uint8_t>(colour)};
}

bool is_clear(const Observation& seen, std::size_t pixel) {
  return seen.ids[pixel] == 0 && (seen.shadows.empty() || seen.shadows[pixel] == 0);
}

template <class Colours>
std::uint32_t most_frequent(const Colours& colours) {
  std::map<std::uint32_t, int> counts;
  for (const std::uint32_t colour : colours) ++counts[colour];
  if (counts.empty()) return 0;
  return std::max_element(counts.begin(), counts.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

void expect_whole(const Observation& seen) {
  const std::size_t pixels = seen.size.pixels();
  if (seen.rgb.size() != 3 * pixels || seen.ids.size() != pixels ||
      (!seen.shadows.empty() && seen.shadows.size() != pixels))
    throw InputError(
        fmt::format("observation: expected rgb, ids and shadows of {} x {} pixels", seen.size.rows, seen.size.columns));
}

// The colour in the light of what has this one in a shadow.
const std::array<std::uint8_t, 256>& lit() {
  static const auto table = [] {
    std::array<std::uint8_t, 256> lighter;
    for (int dark = 0; dark < 256; ++dark)
      lighter[static_cast<std::size_t>(dark)] =
          static_cast<std::uint8_t>(std::min(255, (dark * 256 + shadow_brightness / 2) / shadow_brightness));
    return lighter;
  }();
  return table;
}

// Which pixels of a picture `which` covers, and which lie in its shadows.
class Cover {
 public:
  Cover(const Observation& seen, const Ids& which) : seen_(seen) {
    expect_whole(seen);
    for (const std::uint8_t id : which) covered_[id] = true;
    if (seen.shadows.empty()) return;
    for (std::size_t row = 0; row < std::min(seen.instances.size(), most_shadows); ++row)
      if (covered_[seen.instances[row].id]) bits_ |= static_cast<std::uint16_t>(1U << row);
  }

  /// Calls shown(pixel) where something of it is seen, shaded(pixel, alone) where it keeps the light from something
  /// else, alone or with others.
  template <class OfShown, class OfShaded>
  void visit(const OfShown& shown, const OfShaded& shaded) const {
    const std::size_t pixels = seen_.ids.size();
    for (std::size_t i = 0; i < pixels;) {
      if (i + 8 <= pixels && is_empty(i)) {  // as most of a picture is
        i += 8;
        continue;
      }
      for (const std::size_t end = std::min(i + 8, pixels); i < end; ++i)
        if (covered_[seen_.ids[i]])
          shown(i);
        else if (bits_ != 0 && (seen_.shadows[i] & bits_) != 0)
          shaded(i, (seen_.shadows[i] & ~bits_) == 0);
    }
  }

  /// Of its shadows.
  std::uint16_t bits() const { return bits_; }

 private:
  // Nothing is to be painted in these eight pixels.
  bool is_empty(std::size_t first) const {
    std::uint64_t ids = 0, shadows[2] = {0, 0};
    std::memcpy(&ids, &seen_.ids[first], sizeof ids);
    if (bits_ != 0) std::memcpy(shadows, &seen_.shadows[first], sizeof shadows);
    return !covered_[0] && ids == 0 && shadows[0] == 0 && shadows[1] == 0;
  }

  const Observation& seen_;
  std::array<bool, 256> covered_{};
  std::uint16_t bits_ = 0;
};

// Paints what `colour(pixel)` says, three bytes, and takes the shadows away.
template <class At>
Observation erased(Observation seen, const Ids& which, const At& colour) {
  std::uint8_t* const rgb = seen.rgb.data();
  std::uint16_t* const shadows = seen.shadows.data();
  const Cover cover(seen, which);
  cover.visit(
      [&](std::size_t pixel) {
        std::memcpy(rgb + 3 * pixel, colour(pixel), 3);
        if (shadows) shadows[pixel] = 0;
      },
      [&](std::size_t pixel, bool alone) {
        if (alone)
          for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) rgb[i] = lit()[rgb[i]];
        shadows[pixel] &= static_cast<std::uint16_t>(~cover.bits());
      });
  return seen;
}

Colour random_colour(RandomStream& stream) { return unpacked(stream.next() >> 8); }

// Arithmetic of doubles alone, so that another language makes the same bytes.
class Pattern {
 public:
  explicit Pattern(RandomStream& stream) : kind_(stream.below(5)) {
    one_ = random_colour(stream);
    other_ = random_colour(stream);
    const double scale = stream.uniform(1. / 24, 1. / 4);  // of a period in pixels
    down_ = scale * stream.uniform(-1, 1);
    across_ = scale * stream.uniform(-1, 1);
    first_ = stream.uniform();
    second_ = stream.uniform();
  }

  Colour at(int row, int column) const {
    const double u = row * down_ + column * across_ + first_, v = column * down_ - row * across_ + second_;
    const double of_u = u - std::floor(u), of_v = v - std::floor(v);  // within a period
    switch (kind_) {
      case 0:
        return one_;
      case 1:
        return of_u < .5 ? one_ : other_;
      case 2:
        return (of_u < .5) == (of_v < .5) ? one_ : other_;
      case 3:
        return (of_u - .5) * (of_u - .5) + (of_v - .5) * (of_v - .5) < .09 ? one_ : other_;
      default:
        break;
    }
    const double share = std::abs(2 * of_u - 1);
    Colour mixed;
    for (std::size_t i = 0; i < mixed.size(); ++i)
      mixed[i] = static_cast<std::uint8_t>(std::floor(one_[i] + share * (other_[i] - one_[i]) + .5));
    return mixed;
  }

 private:
  std::uint32_t kind_;  // plain, stripes, checks, dots, a gradient
  Colour one_, other_;
  double down_, across_, first_, second_;
};

}  // namespace

Ids unselected(const Observation& observation, const Selection& selection, Instances instances) {
  const std::vector<std::uint8_t> mask = goal_mask(observation, selection, instances);
  std::array<bool, 256> kept{};
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask[i]) kept[observation.ids[i]] = true;
  Ids others;
  for (const Instance& instance : observation.instances)
    if (!kept[instance.id]) others.push_back(instance.id);
  return others;
}

Colour most_frequent_colour(const Background& background) {
  std::vector<std::uint32_t> colours;
  for (std::size_t i = 0; i + 2 < background.rgb.size(); i += 3) colours.push_back(packed(&background.rgb[i]));
  return unpacked(most_frequent(colours));
}

// A majority vote in one pass (Boyer and Moore 1991).
Background usual_background(const std::vector<Demonstration>& demonstrations) {
  std::vector<std::uint32_t> candidates;
  std::vector<int> lead;
  std::vector<bool> known;
  for (const Demonstration& demonstration : demonstrations)
    for_each_step(demonstration, [&](const Step& step) {
      const Observation& seen = step.observation;
      expect_whole(seen);
      const std::size_t pixels = seen.ids.size();
      if (known.empty()) {
        candidates.resize(pixels);
        lead.resize(pixels);
        known.resize(pixels);
      }
      if (known.size() != pixels) throw InputError("demonstrations: expected pictures of one size");
      for (std::size_t i = 0; i < pixels; ++i) {
        if (!is_clear(seen, i)) continue;
        const std::uint32_t colour = packed(&seen.rgb[3 * i]);
        if (lead[i] == 0) candidates[i] = colour;
        lead[i] += colour == candidates[i] ? 1 : -1;
        known[i] = true;
      }
    });
  if (known.empty()) throw InputError("demonstrations: expected a picture, got none");
  std::vector<std::uint32_t> found;
  for (std::size_t i = 0; i < known.size(); ++i)
    if (known[i]) found.push_back(candidates[i]);
  const std::uint32_t usual = most_frequent(found);
  Background background;
  background.rgb.reserve(3 * known.size());
  for (std::size_t i = 0; i < known.size(); ++i)
    for (const std::uint8_t value : unpacked(known[i] ? candidates[i] : usual)) background.rgb.push_back(value);
  return background;
}

Observation repaint(Observation seen, const Ids& which, const Background& how) {
  if (how.rgb.size() != seen.rgb.size()) throw InputError("repaint: expected a background of the picture's size");
  return erased(std::move(seen), which, [&how](std::size_t pixel) { return &how.rgb[3 * pixel]; });
}

Observation repaint(Observation seen, const Ids& which, const Colour& how) {
  return erased(std::move(seen), which, [&how](std::size_t) { return how.data(); });
}

Observation repaint(Observation seen, const Ids& which, const Noise& how) {
  const auto paint = [&](std::size_t pixel) {
    const Colour colour = random_colour(how.stream);
    std::copy(colour.begin(), colour.end(), &seen.rgb[3 * pixel]);
  };
  Cover(seen, which).visit(paint, [&](std::size_t pixel, bool) {
    if (seen.ids[pixel] == 0) paint(pixel);
  });
  return seen;
}

Observation repaint(Observation seen, const Ids& which, const RandomTextures& how) {
  std::map<std::uint8_t, Pattern> patterns;
  for (const std::uint8_t id : which) patterns.emplace(id, how.stream);
  Cover(seen, which)
      .visit(
          [&](std::size_t pixel) {
            const int row = static_cast<int>(pixel) / seen.size.columns,
                      column = static_cast<int>(pixel) % seen.size.columns;
            const Colour colour = patterns.at(seen.ids[pixel]).at(row, column);
            const bool dark = !seen.shadows.empty() && seen.shadows[pixel] != 0;
            for (std::size_t i = 0; i < 3; ++i)
              seen.rgb[3 * pixel + i] =
                  dark ? static_cast<std::uint8_t>((colour[i] * shadow_brightness + 128) >> 8) : colour[i];
          },
          [](std::size_t, bool) {});
  return seen;
}

}  // namespace lgabench

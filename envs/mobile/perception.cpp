#include <mobile/perception.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include <mobile/tables.hpp>

namespace lgabench::mobile {
namespace {

constexpr double merge_probability = .1, most_missed = .5, missed_pixels = 40;
constexpr int border_pixels = 2;

// Rows and columns, the last ones included.
struct Box {
  int top, bottom, left, right;
};

// Calls visit(a, b) for each two pixels of the box that are neighbours, by edges.
template <typename Visit>
void for_each_neighbours(PictureSize size, const Box& box, const Visit& visit) {
  const auto at = [&](int row, int column) { return static_cast<std::size_t>(row * size.columns + column); };
  for (int row = box.top; row <= box.bottom; ++row)
    for (int column = box.left; column <= box.right; ++column) {
      if (column < box.right) visit(at(row, column), at(row, column + 1));
      if (row < box.bottom) visit(at(row, column), at(row + 1, column));
    }
}

// Ids of pairs that touch, the lower first.
std::set<std::pair<std::uint8_t, std::uint8_t>> touching(const Observation& seen) {
  std::set<std::pair<std::uint8_t, std::uint8_t>> pairs;
  for_each_neighbours(seen.size, {0, seen.size.rows - 1, 0, seen.size.columns - 1}, [&](std::size_t a, std::size_t b) {
    const std::uint8_t i = seen.ids[a], k = seen.ids[b];
    if (i != k && i != 0 && k != 0) pairs.insert(std::minmax(i, k));
  });
  return pairs;
}

// The segment's, with `margin` pixels more on every side, as far as the picture goes.
Box box_of(const Observation& seen, std::uint8_t id, int margin) {
  Box box{seen.size.rows, -1, seen.size.columns, -1};
  for (int row = 0; row < seen.size.rows; ++row) {
    const auto first = seen.ids.begin() + std::ptrdiff_t{row} * seen.size.columns, end = first + seen.size.columns;
    const auto found = std::find(first, end, id);
    if (found == end) continue;
    int last = seen.size.columns - 1;
    while (first[last] != id) --last;
    box = {std::min(box.top, row), row, std::min(box.left, static_cast<int>(found - first)), std::max(box.right, last)};
  }
  return {std::max(box.top - margin, 0), std::min(box.bottom + margin, seen.size.rows - 1),
          std::max(box.left - margin, 0), std::min(box.right + margin, seen.size.columns - 1)};
}

// Moves the segment's border by so many pixels: outwards over what is no object, or inwards.
void move_border(Observation& seen, std::uint8_t id, int by) {
  const Box box = box_of(seen, id, std::abs(by));
  std::vector<std::size_t> changed;
  for (int i = 0; i < std::abs(by); ++i) {
    changed.clear();
    for_each_neighbours(seen.size, box, [&](std::size_t a, std::size_t b) {
      if ((seen.ids[a] == id) == (seen.ids[b] == id)) return;
      const std::size_t inside = seen.ids[a] == id ? a : b, outside = inside == a ? b : a;
      if (by < 0)
        changed.push_back(inside);
      else if (seen.ids[outside] == 0)
        changed.push_back(outside);
    });
    for (const std::size_t pixel : changed) seen.ids[pixel] = by > 0 ? id : 0;
  }
}

void merge_touching(Observation& seen, RandomStream& stream) {
  std::array<std::uint8_t, 256> becomes;
  std::iota(becomes.begin(), becomes.end(), 0);
  std::array<int, 256> pixels{};
  for (const Instance& instance : seen.instances) pixels[instance.id] = instance.pixels;
  for (const auto& [a, b] : touching(seen)) {
    if (stream.uniform() >= merge_probability || becomes[a] == becomes[b]) continue;
    const bool larger_a = pixels[becomes[a]] >= pixels[becomes[b]];
    const std::uint8_t kept = becomes[larger_a ? a : b], gone = becomes[larger_a ? b : a];
    std::replace(becomes.begin(), becomes.end(), gone, kept);
    pixels[kept] += pixels[gone];
  }
  for (std::uint8_t& id : seen.ids) id = becomes[id];
  auto& table = seen.instances;
  table.erase(std::remove_if(table.begin(), table.end(), [&](const Instance& i) { return becomes[i.id] != i.id; }),
              table.end());
  for (Instance& instance : table) instance.pixels = pixels[instance.id];
}

using Confusions = std::map<std::string, std::vector<std::string>>;

// Draws the same numbers whether it errs or not.
void confuse(std::string& word, double error, const Confusions& confusions, const char* else_said,
             RandomStream& stream) {
  const bool wrong = stream.uniform() < error;
  const double which = stream.uniform();
  if (!wrong) return;
  const auto known = confusions.find(word);
  const std::size_t others = known == confusions.end() ? 0 : known->second.size();
  const auto chosen = static_cast<std::size_t>(which * static_cast<double>(others + 1));
  word = chosen < others ? known->second[chosen] : else_said;
}

// Calls caption(instance, stream) for each segment, which says what it is.
template <typename Caption>
Observation segmented(Observation seen, RandomStream& stream, const Caption& caption) {
  merge_touching(seen, stream);
  std::array<bool, 256> missed{};
  for (Instance& instance : seen.instances) {
    const double p = std::min(most_missed, missed_pixels / std::max(instance.pixels, 1));
    missed[instance.id] = stream.uniform() < p;
    const int border = static_cast<int>(stream.below(2 * border_pixels + 1)) - border_pixels;
    caption(instance, stream);
    move_border(seen, instance.id, border);
  }
  auto& table = seen.instances;
  table.erase(std::remove_if(table.begin(), table.end(), [&](const Instance& i) { return missed[i.id]; }), table.end());
  std::array<int, 256> pixels{};
  for (std::uint8_t& id : seen.ids) {
    if (missed[id]) id = 0;
    ++pixels[id];
  }
  for (Instance& instance : table) instance.pixels = pixels[instance.id];
  return seen;
}

// Of each segment, the share of its border that lies on another one.
std::array<double, 256> covered(const Observation& seen) {
  std::array<double, 256> border{}, on_another{};
  for_each_neighbours(seen.size, {0, seen.size.rows - 1, 0, seen.size.columns - 1}, [&](std::size_t a, std::size_t b) {
    const std::uint8_t i = seen.ids[a], k = seen.ids[b];
    if (i == k) return;
    for (const std::uint8_t id : {i, k}) {
      ++border[id];
      on_another[id] += i != 0 && k != 0;
    }
  });
  for (std::size_t id = 0; id < border.size(); ++id) border[id] = border[id] > 0 ? on_another[id] / border[id] : 0;
  return border;
}

// Dim light, and the colour of a lamp: what the whole picture is multiplied by.
struct Exposure {
  double gain, cast;  // cast: 1 the warmest, -1 the coldest

  explicit Exposure(RandomStream& stream) : gain(stream.uniform(.45, 1)), cast(stream.uniform(-1, 1)) {}
  double dim() const { return (1 - gain) / .55; }
  void apply(std::vector<std::uint8_t>& rgb) const {
    constexpr double tint = .2;
    const std::array<double, 3> factors{gain * (1 + tint * cast), gain, gain * (1 - tint * cast)};
    for (std::size_t i = 0; i < rgb.size(); ++i)
      rgb[i] = static_cast<std::uint8_t>(std::min(std::lround(rgb[i] * factors[i % 3]), 255L));
  }
};

}  // namespace

Observation perceive(Observation seen, double caption_error, RandomStream stream) {
  return segmented(std::move(seen), stream, [&](Instance& instance, RandomStream& random) {
    confuse(instance.object_type, caption_error, confusions(), an_object, random);
  });
}

Observation perceive_in_bad_light(Observation seen, double caption_error, RandomStream stream) {
  constexpr double small_pixels = 400, most = .9;
  const Exposure exposure(stream);
  exposure.apply(seen.rgb);
  const std::array<double, 256> hidden = covered(seen);
  return segmented(std::move(seen), stream, [&](Instance& instance, RandomStream& random) {
    const double small = std::min(1., small_pixels / std::max(instance.pixels, 1)), partly = hidden[instance.id];
    confuse(instance.object_type, std::min(most, caption_error * (1 + small + 4 * partly)), fetch_confusions(),
            an_object, random);
    const std::string said = instance.texture;
    confuse(instance.texture, std::min(most, caption_error * (exposure.dim() + std::abs(exposure.cast) + small)),
            texture_confusions(), said.c_str(), random);
  });
}

}  // namespace lgabench::mobile

#include <mobile/perception.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <set>

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

// Draws the same numbers whether it errs or not.
void caption(Instance& instance, double error, RandomStream& stream) {
  const bool wrong = stream.uniform() < error;
  const double which = stream.uniform();
  if (!wrong) return;
  const auto known = confusions().find(instance.object_type);
  const std::size_t others = known == confusions().end() ? 0 : known->second.size();
  const auto chosen = static_cast<std::size_t>(which * static_cast<double>(others + 1));
  instance.object_type = chosen < others ? known->second[chosen] : an_object;
}

}  // namespace

Observation perceive(Observation seen, double caption_error, RandomStream stream) {
  merge_touching(seen, stream);
  std::array<bool, 256> missed{};
  for (Instance& instance : seen.instances) {
    const double p = std::min(most_missed, missed_pixels / std::max(instance.pixels, 1));
    missed[instance.id] = stream.uniform() < p;
    const int border = static_cast<int>(stream.below(2 * border_pixels + 1)) - border_pixels;
    caption(instance, caption_error, stream);
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

}  // namespace lgabench::mobile

#include <common/patterns.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

#include <lgabench/core/geometry.hpp>

namespace lgabench::common {
namespace {

constexpr Rgb white{255, 255, 255}, black{20, 20, 20};

// --- colours

Rgb mixed(Rgb a, Rgb b, double share_of_b) {
  const double t = std::clamp(share_of_b, 0.0, 1.0);
  Rgb c{};
  for (std::size_t i = 0; i < 3; ++i) c[i] = static_cast<std::uint8_t>(std::lround(a[i] + t * (b[i] - a[i])));
  return c;
}

Rgb brightened(Rgb colour, double factor) {
  for (std::uint8_t& c : colour) c = static_cast<std::uint8_t>(std::clamp(std::lround(c * factor), 0L, 255L));
  return colour;
}

// --- noise and distances on the torus, so that every tile continues in the next

// Uniform in [0, 1), a function of its arguments alone (SplitMix64's mixer).
double noise_at(std::uint32_t seed, int x, int y) {
  std::uint64_t h = (std::uint64_t{seed} << 40) ^ (static_cast<std::uint64_t>(x) << 20) ^ static_cast<std::uint64_t>(y);
  h += 0x9e3779b97f4a7c15ULL;
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ULL;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>((h ^ (h >> 31)) >> 11) * 0x1p-53;
}

// Value noise in [0, 1) on a lattice of cells_u x cells_v; repeats after a tile.
double value_noise(std::uint32_t seed, double u, double v, int cells_u, int cells_v) {
  const double x = u * cells_u, y = v * cells_v, x0 = std::floor(x), y0 = std::floor(y);
  const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
  const auto wrapped = [](double i, int n) { return (static_cast<int>(i) % n + n) % n; };
  const int ax = wrapped(x0, cells_u), bx = wrapped(x0 + 1, cells_u);
  const int ay = wrapped(y0, cells_v), by = wrapped(y0 + 1, cells_v);
  const double tx = smooth(x - x0), ty = smooth(y - y0);
  const double top = noise_at(seed, ax, ay) + tx * (noise_at(seed, bx, ay) - noise_at(seed, ax, ay));
  const double bottom = noise_at(seed, ax, by) + tx * (noise_at(seed, bx, by) - noise_at(seed, ax, by));
  return top + ty * (bottom - top);
}

// Three octaves of value noise, in [0, 1).
double fractal_noise(std::uint32_t seed, double u, double v, int cells_u, int cells_v) {
  return (4 * value_noise(seed, u, v, cells_u, cells_v) + 2 * value_noise(seed + 1, u, v, 2 * cells_u, 2 * cells_v) +
          value_noise(seed + 2, u, v, 4 * cells_u, 4 * cells_v)) /
         7;
}

// Fractional part, also of negative numbers.
double fraction(double x) { return x - std::floor(x); }

// From b to a the short way round the tile.
Vec2 offset(Vec2 a, Vec2 b) {
  const auto shortest = [](double d) { return d < -0.5 ? d + 1 : d < 0.5 ? d : d - 1; };  // |d| is below 1.5
  return {shortest(a.x - b.x), shortest(a.y - b.y)};
}

// A grid of cells x cells: where in its cell a point lies (0..1 each), and which cell it is.
struct Cell {
  double u, v;
  int column, row;
};
Cell cell_of(double u, double v, int columns, int rows) {
  const double x = u * columns, y = v * rows;
  return {fraction(x), fraction(y), static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y))};
}

// --- materials

// Running bond: four courses of two bricks, each brick with a tone of its own.
Rgb brick(double u, double v) {
  const int row = cell_of(u, v, 1, 4).row;
  const Cell c = cell_of(fraction(u + 0.25 * (row % 2)), v, 2, 4);
  const double mortar_u = 0.035, mortar_v = 0.07;
  if (c.u < mortar_u || c.u > 1 - mortar_u || c.v < mortar_v || c.v > 1 - mortar_v) return {206, 198, 184};
  return brightened({168, 70, 48}, 0.8 + 0.3 * noise_at(11, c.column, row) + 0.2 * fractal_noise(12, u, v, 12, 12));
}

// Glazed square tiles: grout, a light bevel up left, a dark one down right.
Rgb tiles(double u, double v) {
  const Cell c = cell_of(u, v, 4, 4);
  const double edge = std::min({c.u, c.v, 1 - c.u, 1 - c.v});
  if (edge < 0.07) return {92, 98, 104};
  const double tone = 0.94 + 0.08 * noise_at(21, c.column, c.row);
  if (edge < 0.15) return brightened({164, 208, 222}, tone * (std::min(c.u, c.v) == edge ? 1.12 : 0.8));
  return brightened({164, 208, 222}, tone);
}

// Long grain: rings stretched along u and bent by slow noise, each darkening towards its end.
Rgb wooden(double u, double v) {
  const double bend = 1.8 * value_noise(31, u, v, 2, 3) + 0.4 * value_noise(32, u, v, 4, 8);
  const double ring = fraction(5 * v + bend);
  const double late = ring < 0.85 ? ring * ring / 0.72 : (1 - ring) / 0.15;
  const double fibre = value_noise(34, u, v, 6, 64);
  return brightened(mixed({200, 150, 92}, {122, 76, 38}, late), 0.88 + 0.2 * fibre);
}

// Speckles of four minerals.
Rgb granite(double u, double v) {
  const double grain = 0.65 * value_noise(41, u, v, 22, 22) + 0.35 * value_noise(42, u, v, 48, 48);
  const double flake = value_noise(43, u, v, 20, 20);
  if (flake > 0.8) return {38, 36, 40};
  if (flake < 0.17) return {226, 222, 216};
  return mixed({84, 84, 90}, {176, 170, 168}, 2.4 * (grain - 0.3));
}

// A moulded toy brick: glossy studs with a highlight up left and a shadow down right.
Rgb plastic(double u, double v) {
  const Rgb body{206, 28, 122};
  const Cell c = cell_of(u, v, 4, 4);
  const double x = c.u - 0.5, y = c.v - 0.5, r = std::sqrt(x * x + y * y);
  if (r < 0.32) {
    const double gleam = std::sqrt((x + 0.12) * (x + 0.12) + (y + 0.12) * (y + 0.12));
    return gleam < 0.09 ? white : mixed(mixed(body, white, 0.28), body, gleam / 0.4);
  }
  const double towards_light = -(x + y) / (r * std::sqrt(2.0));
  if (r < 0.38) return towards_light > 0 ? mixed(body, white, 0.5 * towards_light) : brightened(body, 0.55);
  return r < 0.48 && towards_light < -0.2 ? brightened(body, 0.68) : brightened(body, 0.88);
}

Rgb checkerboard(double u, double v) {
  const Cell c = cell_of(u, v, 8, 8);
  return (c.column + c.row) % 2 ? black : Rgb{245, 245, 245};
}

// Black strokes that run across, swell, break off and fork on orange fur.
Rgb tiger(double u, double v) {
  const double bend = 0.9 * fractal_noise(61, u, v, 3, 3) + 0.35 * std::sin(2 * pi * u);
  const double wave = std::sin(2 * pi * (6 * v + 1.4 * bend));
  const double swell = 1.9 * value_noise(64, u, v, 5, 8) - 0.65;
  const Rgb fur = mixed({238, 138, 38}, {250, 196, 110}, value_noise(65, u, v, 4, 24));
  return wave > 0.75 - swell ? Rgb{24, 18, 16} : fur;
}

// Dark crust in plates (Worley cells), glowing where two of them part.
Rgb magma(double u, double v) {
  constexpr int cells = 5;
  const double wu = fraction(u + 0.05 * value_noise(71, u, v, 8, 8)),
               wv = fraction(v + 0.05 * value_noise(72, u, v, 8, 8));
  const Cell c = cell_of(wu, wv, cells, cells);
  double nearest = 9, second = 9;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const int x = (c.column + dx + cells) % cells, y = (c.row + dy + cells) % cells;
      const double px = dx + noise_at(73, x, y) - c.u, py = dy + noise_at(74, x, y) - c.v;
      const double d = std::sqrt(px * px + py * py);
      second = std::min(second, std::max(nearest, d));
      nearest = std::min(nearest, d);
    }
  const double heat = 1 - (second - nearest) / 0.34;
  if (heat > 0.62) return mixed({255, 120, 10}, {255, 232, 90}, (heat - 0.62) / 0.38);
  if (heat > 0) return mixed({86, 14, 6}, {255, 120, 10}, heat / 0.62);
  return brightened({44, 18, 16}, 0.7 + 0.8 * fractal_noise(75, u, v, 10, 10));
}

Rgb rainbow(double, double v) {
  static constexpr std::array<Rgb, 7> bands{
      {{228, 40, 40}, {250, 140, 30}, {250, 225, 50}, {60, 180, 70}, {60, 170, 235}, {60, 70, 190}, {150, 60, 180}}};
  return bands[static_cast<std::size_t>(fraction(v) * 7)];
}

// Leftovers on porcelain: red and brown blots of changing size.
Rgb stained(double u, double v) {
  const double blot = fractal_noise(81, u, v, 4, 4) + .25 * value_noise(84, u, v, 12, 12);
  if (blot < .78) return {240, 240, 236};
  return mixed({186, 84, 40}, {92, 50, 24}, 5 * (blot - .78));
}

// A ripe banana's peel.
Rgb freckled(double u, double v) {
  const double spot = value_noise(85, u, v, 9, 9) + .35 * value_noise(86, u, v, 20, 20);
  return spot < .86 ? Rgb{237, 201, 72} : Rgb{104, 66, 24};
}

// --- shapes that are repeated

// Dots on a staggered lattice, two in each of n x n cells, of a radius given in cells.
bool in_dot(double u, double v, int n, double radius) {
  const Cell c = cell_of(u, v, n, n);
  for (const double centre : {0.25, 0.75}) {
    const double x = c.u - centre, y = c.v - centre;
    if (x * x + y * y < radius * radius) return true;
  }
  return false;
}

struct Circle {
  Vec2 centre;  // from the head's
  double radius;
};

// A curved teardrop, in tiles: a row of circles that shrink along an arc, from the head on; `up` is 1 for a tail that
// rises, -1 for the same turned by half a circle.
std::array<Circle, 24> teardrop(double up) {
  std::array<Circle, 24> circles;
  for (std::size_t i = 0; i < circles.size(); ++i) {
    const double t = static_cast<double>(i) / circles.size();  // 0 head .. 1 tip
    circles[i] = {{up * (0.05 + 0.18 * t * t) * t, up * (0.1 * t * t - 0.5) * t},
                  0.2 * (1 - t) * (1 - 0.15 * t) + 0.012};
  }
  return circles;
}

// How deep a point lies inside it, 0 outside.
double depth_in(const std::array<Circle, 24>& circles, Vec2 from_head) {
  double depth = 0;
  for (const auto& [centre, radius] : circles)
    // A square root only for circles that reach deeper than those before: this is most of what making textures takes.
    if (const Vec2 away = offset(from_head, centre); std::max(std::abs(away.x), std::abs(away.y)) < radius - depth)
      depth = std::max(depth, radius - norm(away));
  return depth;
}

}  // namespace

Pattern plain(Rgb colour) {
  return {0.1, [=](double, double) { return colour; }};
}

// Diagonal, so that the arms of a letter show both colours whichever way they run; 18 mm each.
Pattern stripe(Rgb first, Rgb second) {
  return {0.1, [=](double u, double v) { return fraction(2 * (u + v)) < 0.5 ? first : second; }};
}

// 14 mm across, 21 mm apart.
Pattern polka_dot(Rgb ground, Rgb dots) {
  return {0.09, [=](double u, double v) { return in_dot(u, v, 3, 0.235) ? dots : ground; }};
}

Pattern swirl(Rgb colour) {
  return {0.1, [=](double u, double v) {
            const double x = u - 0.5, y = v - 0.5, r = std::sqrt(x * x + y * y);
            if (r > 0.47) return colour;
            return fraction(std::atan2(y, x) / pi + 5.5 * r) < 0.5 ? white : colour;
          }};
}

Pattern paisley(Rgb colour) {
  return {0.12, [=](double u, double v) {
            static const auto rising = teardrop(1), falling = teardrop(-1);
            const double depth =
                std::max(depth_in(rising, offset({u, v}, {0.27, 0.4})), depth_in(falling, offset({u, v}, {0.75, 0.6})));
            if (depth > 0.15) return white;  // an eye in the head
            if (depth > 0.045) return brightened(colour, 0.5);
            if (depth > 0) return white;  // the rim
            for (const Vec2 dot : {Vec2{0.53, 0.22}, Vec2{0.02, 0.78}, Vec2{0.6, 0.02}})
              if (norm(offset({u, v}, dot)) < 0.045) return white;
            return colour;
          }};
}

Pattern material(const std::string& name) {
  static const std::map<std::string, Pattern> materials{
      {"brick", {0.12, brick}},
      {"tiles", {0.12, tiles}},
      {"wooden", {0.14, wooden}},
      {"granite", {0.12, granite}},
      {"plastic", {0.1, plastic}},
      {"polka dot", polka_dot({250, 250, 250}, {24, 24, 40})},
      {"checkerboard", {0.12, checkerboard}},
      {"tiger", {0.12, tiger}},
      {"magma", {0.14, magma}},
      {"rainbow", {0.105, rainbow}},
      {"white", plain({240, 240, 236})},
      {"white with food stains", {0.12, stained}},
      {"yellow with brown spots", {0.08, freckled}},
  };
  const auto found = materials.find(name);
  return found == materials.end() ? Pattern{} : found->second;
}

}  // namespace lgabench::common

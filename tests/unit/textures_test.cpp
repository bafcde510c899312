#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include <common/textures.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/feature_space.hpp>

namespace lgabench::common {
namespace {

constexpr int size = Texture::size;

const std::vector<std::string>& names() {
  static const FeatureSpace space = load_feature_space("tabletop");
  return space.textures;
}

// Mean over pixels and channels, 0..255.
double difference(const Texture& a, const Texture& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) sum += std::abs(a.pixels[i][c] - b.pixels[i][c]);
  return sum / (3.0 * size * size);
}

std::set<Rgb> colours(const std::string& name) {
  const auto& pixels = texture(name).pixels;
  return {pixels.begin(), pixels.end()};
}

TEST(Textures, EveryNameOfTheSpaceIsAPictureOfItsOwn) {
  ASSERT_EQ(names().size(), 83u);
  for (const std::string& a : names()) {
    EXPECT_EQ(texture(a).name, a);
    ASSERT_EQ(texture(a).pixels.size(), static_cast<std::size_t>(size * size)) << a;
    for (const std::string& b : names()) {
      if (a != b) {
        EXPECT_GT(difference(texture(a), texture(b)), 7) << a << " and " << b;
      }
    }
  }
}

TEST(Textures, TilesContinueInOneAnother) {
  for (const std::string& name : names()) {
    const Texture& t = texture(name);
    // Mean change from one column (row) of pixels to the next, round the tile: the seam must not stand out.
    for (const bool over_columns : {true, false}) {
      std::vector<double> changes(size);
      for (int i = 0; i < size; ++i)
        for (int j = 0; j < size; ++j) {
          const int next = (i + 1) % size;
          const Rgb here = t.pixels[static_cast<std::size_t>(over_columns ? j * size + i : i * size + j)];
          const Rgb there = t.pixels[static_cast<std::size_t>(over_columns ? j * size + next : next * size + j)];
          for (std::size_t c = 0; c < 3; ++c) changes[static_cast<std::size_t>(i)] += std::abs(here[c] - there[c]);
        }
      const double seam = changes.back();
      changes.pop_back();
      EXPECT_LE(seam, 1.1 * *std::max_element(changes.begin(), changes.end()))
          << name << (over_columns ? ": left to right" : ": top to bottom");
    }
  }
}

TEST(Textures, PlainColoursAreTheProtocols) {
  const std::vector<std::pair<std::string, Rgb>> expected{
      {"blue", {78, 121, 167}},   {"red", {255, 87, 89}},     {"green", {89, 169, 79}},
      {"orange", {242, 142, 43}}, {"yellow", {237, 201, 72}}, {"purple", {176, 122, 161}},
      {"pink", {255, 157, 167}},  {"cyan", {118, 183, 178}},  {"olive", {128, 128, 0}}};
  for (const auto& [name, rgb] : expected) {
    EXPECT_EQ(colours(name), std::set<Rgb>{rgb}) << name;
    // Dark: HSV value less .3, hue and saturation kept, within rounding.
    const std::set<Rgb> dark = colours("dark " + name);
    ASSERT_EQ(dark.size(), 1u) << name;
    const double value = *std::max_element(rgb.begin(), rgb.end()) / 255.0;
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR((*dark.begin())[c], rgb[c] * (value - 0.3) / value, 0.51) << name;
  }
}

TEST(Textures, TwoColoursShareAStripeAndAPolkaDot) {
  for (const std::string kind : {"stripe", "polka dot"})
    for (const std::string dark : {"", "dark "}) {
      const std::string name = dark + "yellow and purple " + kind;
      const Rgb first = *colours(dark + "yellow").begin(), second = *colours(dark + "purple").begin();
      EXPECT_EQ(colours(name), (std::set<Rgb>{first, second})) << name;  // both colours are dark
      const auto& pixels = texture(name).pixels;
      const double share =
          static_cast<double>(std::count(pixels.begin(), pixels.end(), second)) / static_cast<double>(pixels.size());
      EXPECT_NEAR(share, kind == "stripe" ? 0.5 : 0.35, 0.01) << name;
    }
}

TEST(Textures, NamedColourIsMostOfASwirlOrPaisley) {
  for (const std::string kind : {"swirl", "paisley"})
    for (const std::string colour : {"red", "yellow", "green", "blue", "purple"}) {
      const auto& pixels = texture(colour + " " + kind).pixels;
      const auto count = std::count(pixels.begin(), pixels.end(), *colours(colour).begin());
      EXPECT_GT(count, size * size / 2) << colour << " " << kind;
      EXPECT_LT(count, size * size * 4 / 5) << colour << " " << kind;
    }
}

TEST(Textures, PointsOfASurfaceFindTheirPixel) {
  const Texture& t = texture("rainbow");  // its rows differ
  const double pixel = t.scale_m / size;
  EXPECT_EQ(t.at(0.5 * pixel, 0.5 * pixel), t.pixels[size / 2 * size + size / 2]);
  EXPECT_EQ(t.at(-0.5 * pixel, -0.5 * pixel), t.pixels[(size / 2 - 1) * size + size / 2 - 1]);
  const Texture& bricks = texture("brick");
  for (const double u : {-0.043, 0.0, 0.0171})
    for (const double v : {-0.0292, 0.0101}) {
      EXPECT_EQ(bricks.at(u, v), bricks.at(u + 3 * bricks.scale_m, v - 2 * bricks.scale_m));
      const auto index = [&](double x) { return static_cast<int>(std::floor(x / bricks.scale_m * size)) + size / 2; };
      EXPECT_EQ(bricks.at(u, v), bricks.pixels[static_cast<std::size_t>(index(v) * size + index(u))]);
    }
}

TEST(Textures, UnknownNamesAreRefused) {
  for (const std::string name : {"", "dark", "mauve", "dark brick", "Red", "red ", " red", "red stripe",
                                 "red and stripe", "red and mauve stripe", "red and blue and green stripe",
                                 "red and blue swirl", "dark dark red", "swirl", "polka dots"})
    EXPECT_THROW(texture(name), InputError) << '"' << name << '"';
}

}  // namespace
}  // namespace lgabench::common

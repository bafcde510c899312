// Policies that keep spatial positions where an action leads to one of a few stations.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include <lgabench/core/random.hpp>
#include <lgabench/core/stations.hpp>
#include <lgabench/learning/centroid_policy.hpp>
#include <lgabench/learning/heat_map.hpp>
#include <lgabench/learning/training.hpp>

namespace lgabench {
namespace {

constexpr PictureSize seen_size{64, 128};

// Where to take hold in the picture, and one number that is the station's.
const ActionSpace& to_stations() {
  static const ActionSpace space{{{"u", "", 0, 1}, {"v", "", 0, 1}, {"x", "m", -3, 3}},
                                 {},
                                 {{1, 0}},
                                 {{2}, {{{.15, .2}, {-2}}, {{.15, .5}, {0}}, {{.15, .8}, {2}}}}};
  return space;
}

struct Quiet : TrainingLog {
  void epoch(int, long long, double) override {}
};

Samples rows_of(std::vector<SampleShape::Picture> pictures, int count) {
  return {{std::move(pictures), false, to_stations()}, count};
}

// A rectangle about a place of the picture; of one channel out of `channels`.
void paint(float* picture, PictureSize size, int channels, int channel, Vec2 at, int high, int wide, float value) {
  const int row = static_cast<int>(at.x * size.rows), column = static_cast<int>(at.y * size.columns);
  for (int r = row - high / 2; r < row + high - high / 2; ++r)
    for (int c = column - wide / 2; c < column + wide - wide / 2; ++c)
      picture[(r * size.columns + c) * channels + channel] = value;
}

Vec2 anywhere(RandomStream& random) { return {random.uniform(.5, .9), random.uniform(.1, .9)}; }
Vec2 at_station(int i) { return to_stations().stations.all[static_cast<std::size_t>(i)].seen; }

void set_label(Samples& samples, int row, Vec2 taken, int station) {
  const double x = to_stations().stations.all[static_cast<std::size_t>(station)].values[0];
  const Action label = as_stored(to_stations(), {taken.y, taken.x, x});
  std::copy(label.begin(), label.end(), samples.labels.begin() + row * std::ptrdiff_t{3});
}

// Draws a row, and returns the station that it asks for.
using Draw = std::function<int(Samples&, int row, RandomStream&)>;

// How many of 30 scenes a policy leads to the right station, taught with 8.
template <typename Policy>
int led_right(Policy& policy, std::vector<SampleShape::Picture> pictures, const Draw& draw) {
  RandomStream random("stations");
  Samples shown = rows_of(pictures, 8);
  for (int row = 0; row < shown.rows; ++row) draw(shown, row, random);
  Quiet log;
  train(policy, shown, {}, 5, log);
  int right = 0;
  for (int i = 0; i < 30; ++i) {
    Samples scene = rows_of(pictures, 1);
    const int station = draw(scene, 0, random);
    const std::vector<float>& action = policy.predict(scene);
    right += action[2] == to_stations().stations.all[static_cast<std::size_t>(station)].values[0];
  }
  return right;
}

// The mask tells the second set, which stands at one of the stations.
int told(Samples& samples, int row, RandomStream& random) {
  const Vec2 taken = anywhere(random);
  const int station = static_cast<int>(random.below(3));
  paint(samples.picture(0, row), seen_size, 1, 0, taken, 8, 8, 1);
  paint(samples.picture(0, row), seen_size, 1, 0, at_station(station) + Vec2{.02, .03}, 8, 8, -1);
  set_label(samples, row, taken, station);
  return station;
}

// A mask of anything: a tall thing and two flat ones stand at the stations.
int shaped(Samples& samples, int row, RandomStream& random) {
  const Vec2 taken = anywhere(random);
  const int station = static_cast<int>(random.below(3));
  paint(samples.picture(0, row), seen_size, 1, 0, taken, 8, 8, 1);
  for (int i = 0; i < 3; ++i)
    paint(samples.picture(0, row), seen_size, 1, 0, at_station(i), i == station ? 16 : 6, i == station ? 6 : 16, 1);
  set_label(samples, row, taken, station);
  return station;
}

// Colours alone: something white to take, and red, green and blue at the stations; red is asked for.
int coloured(Samples& samples, int row, RandomStream& random) {
  const Vec2 taken = anywhere(random);
  const std::vector<int> order = random.permutation(3);
  for (int channel = 0; channel < 3; ++channel) {
    paint(samples.picture(0, row), HeatMap::rgb_size, 3, channel, taken, 4, 4, 1);
    paint(samples.picture(0, row), HeatMap::rgb_size, 3, channel, at_station(order[static_cast<std::size_t>(channel)]),
          4, 6, 1);
  }
  set_label(samples, row, taken, order[0]);
  return order[0];
}

TEST(Stations, AreFoundByTheSecondSetOfAMask) {
  const std::vector<SampleShape::Picture> mask{{seen_size, 1}};
  HeatMap heat_map(rows_of(mask, 1).shape, 1);
  EXPECT_EQ(led_right(heat_map, mask, told), 30);
  CentroidRule centroid(rows_of(mask, 1).shape);
  EXPECT_EQ(led_right(centroid, mask, told), 30);

  // Where the second set is not seen, or nothing is, the action still leads to a station.
  Samples scenes = rows_of(mask, 2);
  paint(scenes.picture(0, 0), seen_size, 1, 0, {.7, .5}, 8, 8, 1);
  for (Learner* policy : {static_cast<Learner*>(&heat_map), static_cast<Learner*>(&centroid)}) {
    const std::vector<float>& actions = policy->predict(scenes);
    for (const int row : {0, 1}) {
      const float x = actions[static_cast<std::size_t>(3 * row + 2)];
      EXPECT_TRUE(x == -2 || x == 0 || x == 2) << x;
    }
    EXPECT_NEAR(actions[0], .5, .05);
    EXPECT_NEAR(actions[1], .7, .05);
  }
}

TEST(Stations, AreFoundByShapeAndByColour) {
  const std::vector<SampleShape::Picture> mask{{seen_size, 1}}, rgb{{HeatMap::rgb_size, 3}};
  HeatMap by_shape(rows_of(mask, 1).shape, 1), by_colour(rows_of(rgb, 1).shape, 1);
  EXPECT_GE(led_right(by_shape, mask, shaped), 24);
  EXPECT_GE(led_right(by_colour, rgb, coloured), 20);
}

TEST(Stations, AreNearestByPictureOrByNumbers) {
  const Stations& stations = to_stations().stations;
  EXPECT_EQ(nearest_station(stations, {.9, .6}), 1u);
  EXPECT_EQ(nearest_station(stations, {0, .7}), 2u);
  EXPECT_EQ(station_of(stations, {.1, .1, -1.1}), 0u);
  EXPECT_EQ(led_to(stations, 2, {.1, .2, -1}), (Action{.1, .2, 2}));
}

}  // namespace
}  // namespace lgabench

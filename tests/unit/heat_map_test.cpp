// The heat map's gradients, what it learns that a centroid cannot, and what it refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/core/action.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/learning/heat_map.hpp>
#include <lgabench/learning/heat_map_network.hpp>
#include <lgabench/learning/training.hpp>
#include <tabletop/two_poses.hpp>

#include "native_picture.hpp"

namespace lgabench {
namespace {

using tabletop::TwoPoses;

struct Silent : TrainingLog {
  void epoch(int, long long, double) override {}
};

void set_label(Samples& samples, int row, const TwoPoses& action) {
  const Action values = as_stored(tabletop::two_poses(), action);
  std::copy(values.begin(), values.end(), samples.labels.begin() + row * std::ptrdiff_t{12});
}

// A rectangle of a mask, from a corner on.
void paint(Samples& samples, int row, int top, int left, int height, int width, float value) {
  for (int r = top; r < top + height; ++r) std::fill_n(samples.picture(0, row) + r * columns + left, width, value);
}

TwoPoses predicted(HeatMap& policy, const Samples& samples) {
  const std::vector<float>& action = policy.predict(samples);
  return Action(action.begin(), action.end());
}

void train(HeatMap& policy, const Samples& samples) {
  Silent log;
  train(policy, samples, {}, 5, log);
}

const SampleShape one_mask{{{native_size, 1}}, false, tabletop::two_poses()},
    colours{{{HeatMap::rgb_size, 3}}, false, tabletop::two_poses()};

// A picture that is nowhere empty, but by numbers that no sum of these notices.
TEST(HeatMapNetwork, CopiesWhatAnEmptyPatchGivesToTheBit) {
  constexpr PictureSize padded = HeatMapNetwork::padded;
  HeatMapNetwork network(Field(tabletop::two_poses()), 2, false, 1, 1, *available_kernels().front());
  RandomStream random("empty patches");
  std::vector<float> values = network.parameters().values();
  for (float& value : values) value += static_cast<float>(.1 * random.gaussian());
  network.parameters().set(values);
  struct Object {
    int top, left, height, width;
  };
  const std::vector<float> wanted(HeatMapNetwork::cells, 1.f / HeatMapNetwork::cells);
  for (const Object& one : {Object{15, 30, 7, 7}, {4, 4, 1, 1}, {35, 67, 1, 1}, {10, 0, 3, 72}, {0, 0, 0, 0}}) {
    std::vector<float> empty(padded.pixels() * 2), full(empty.size(), 1e-30f);
    for (int y = one.top; y < one.top + one.height; ++y)
      for (int x = one.left; x < one.left + one.width; ++x) {
        const auto at = static_cast<std::size_t>(y * padded.columns + x) * 2;
        empty[at] = full[at] = static_cast<float>(random.uniform());
      }
    const auto learned = [&](const std::vector<float>& planes) {
      network.clear_gradients();
      const std::vector<float> map = network.map(planes.data(), nullptr, nullptr);
      network.teach(wanted, {}, 0, 1);
      return std::pair(map, network.parameters().gradients());
    };
    const auto [map, gradients] = learned(empty);
    const auto [full_map, full_gradients] = learned(full);
    EXPECT_EQ(map, full_map);
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      if (std::abs(full_gradients[i]) < 1e-20f)
        EXPECT_EQ(gradients[i], 0) << i;
      else
        EXPECT_EQ(gradients[i], full_gradients[i]) << i;
    }
  }
}

// Two demonstrations push one way, two the other, so that there are two groups.
TEST(HeatMap, HasTheGradientsOfFiniteDifferences) {
  Samples samples({{{native_size, 1}, {HeatMap::rgb_size, 3}}, true, tabletop::two_poses()}, 4);
  RandomStream random("heat map");
  for (int row = 0; row < samples.rows; ++row) {
    const int top = static_cast<int>(random.below(90)), left = 20 + static_cast<int>(random.below(180));
    paint(samples, row, top, left, 20, 30, 1);
    paint(samples, row, 100, 30 * row, 20, 20, -1);
    const Vec2 middle = place(top + 10, left + 10);
    set_label(samples, row, {{middle, {}}, {{middle.x, row % 2 ? -.45 : .45}, {}}});
  }
  for (float& value : samples.pictures[1]) value = static_cast<float>(random.uniform());
  for (float& value : samples.text) value = static_cast<float>(random.gaussian() / 20);

  HeatMap policy(samples.shape, 1);
  policy.begin(samples);
  std::vector<float> parameters = policy.parameters();
  // 5 planes: convolutions with their biases, the text's bias, the heat, two groups' scores and their biases.
  const std::vector<int> parts{25 * 5 * 16, 16, 9 * 256, 16, 9 * 256, 16, 384 * 16, 16, 64, 2};
  ASSERT_EQ(parameters.size(), static_cast<std::size_t>(std::accumulate(parts.begin(), parts.end(), 0)));
  for (float& p : parameters) p += static_cast<float>(.1 * random.gaussian());
  const std::vector<int> batch{2, 0, 3};
  const auto loss = [&](const std::vector<float>& at) {
    policy.set_parameters(at);
    return policy.backward(samples, batch);
  };
  loss(parameters);
  const std::vector<float> gradients = policy.gradients();
  std::size_t first = 0;
  for (const int count : parts) {
    std::vector<float> above = parameters, below = parameters;
    double expected = 0, length = 0;
    for (std::size_t i = first; i < first + static_cast<std::size_t>(count); ++i)
      length += double{gradients[i]} * gradients[i];
    length = std::sqrt(length);
    ASSERT_GT(length, 1e-4) << "parameters from " << first;
    // Along the gradient, where a wrong one shows most.
    const double step = 2e-3 / std::sqrt(count);
    for (std::size_t i = first; i < first + static_cast<std::size_t>(count); ++i) {
      const double along = gradients[i] / length * std::sqrt(count);
      above[i] += static_cast<float>(step * along);
      below[i] -= static_cast<float>(step * along);
      expected += gradients[i] * (double{above[i]} - below[i]);
    }
    EXPECT_NEAR((loss(above) - loss(below)) / expected, 1, .02) << "parameters from " << first;
    first += static_cast<std::size_t>(count);
  }
}

// A copy's map is drawn towards that of its original, as the cross entropy of the one to the other says.
TEST(HeatMapNetwork, APenaltyHasTheGradientsOfFiniteDifferences) {
  HeatMapNetwork network(Field(tabletop::two_poses()), 3, false, 1, 1, *available_kernels().front());
  RandomStream random("penalty");
  const auto picture = [&random] {
    Numbers planes(static_cast<std::size_t>(HeatMapNetwork::padded.pixels() * 3));
    for (std::size_t i = 0; i < HeatMapNetwork::padded.pixels() * 3; ++i)
      planes[i] = static_cast<float>(random.uniform());
    return planes;
  };
  const Numbers original = picture(), copy = picture();
  std::vector<float> parameters = network.parameters().values();
  for (float& p : parameters) p += static_cast<float>(.1 * random.gaussian());
  network.parameters().set(parameters);
  const std::vector<float> like = network.map(original, nullptr, nullptr);
  std::vector<float> wanted(HeatMapNetwork::cells);
  wanted[700] = 1;
  const auto loss = [&](const std::vector<float>& at, double penalty) {
    network.parameters().set(at);
    network.clear_gradients();
    network.map(copy, nullptr, nullptr);
    return network.teach(wanted, {}, 0, 1, like, penalty);
  };
  EXPECT_GT(loss(parameters, 2), loss(parameters, 0) + 1);
  loss(parameters, 2);
  const std::vector<float> gradients = network.parameters().gradients();
  double length = 0, expected = 0;
  for (const float g : gradients) length += double{g} * g;
  std::vector<float> above = parameters, below = parameters;
  for (std::size_t i = 0; i < gradients.size(); ++i) {
    const double step = 2e-3 * gradients[i] / std::sqrt(length);
    above[i] += static_cast<float>(step), below[i] -= static_cast<float>(step);
    expected += gradients[i] * (double{above[i]} - below[i]);
  }
  EXPECT_NEAR((loss(above, 2) - loss(below, 2)) / expected, 1, .02);
}

TEST(HeatMap, CopiesChangeWhatIsLearnedAndThePenaltyToo) {
  RandomStream random("copies");
  Samples samples(colours, 8);
  samples.unaltered = 4;
  for (int row = 0; row < samples.rows; ++row) {
    for (std::size_t i = 0; i < 32 * 64 * 3; ++i)
      samples.picture(0, row)[i] =
          row < 4 && i != 40u * static_cast<std::size_t>(row) ? .5f : static_cast<float>(random.uniform());
    const Vec2 at = place(20 + row % 4 * 20, 60);
    set_label(samples, row, {{at, {}}, {goal, {}}});
  }
  const auto learned = [&](double penalty) {
    HeatMap policy(colours, 3, penalty);
    train(policy, samples);
    return policy.parameters();
  };
  EXPECT_NE(learned(0), learned(1));
}

// The right end of a bar is taken: its middle would be .08 m beside that.
TEST(HeatMap, LearnsWhichPartOfTheTargetToTake) {
  RandomStream random("bars");
  const auto draw = [&random](Samples& samples, int row) {
    const int top = static_cast<int>(random.below(100)), left = static_cast<int>(random.below(200));
    std::fill_n(samples.picture(0, row), rows * columns, 0.f);
    paint(samples, row, top, left, 20, 48, 1);
    return place(top + 10, left + 42);
  };
  Samples samples(one_mask, 10), probe(one_mask, 1);
  for (int row = 0; row < samples.rows; ++row) {
    const Vec2 end = draw(samples, row);
    set_label(samples, row, {{end, {}}, {goal, {}}});
  }
  HeatMap policy(one_mask, 7);
  train(policy, samples);
  for (int trial = 0; trial < 10; ++trial) {
    const Vec2 end = draw(probe, 0);
    const TwoPoses action = predicted(policy, probe);
    EXPECT_LT(norm(action.pose0.position_m - end), .02) << trial;
    EXPECT_LT(norm(action.pose1.position_m - goal), .01) << trial;
  }
}

// What is red is taken, what is blue is not; the background is not 0.
TEST(HeatMap, LearnsFromColoursAlone) {
  RandomStream random("colours");
  const auto draw = [&random](Samples& samples, int row) {
    std::fill_n(samples.picture(0, row), 3 * 32 * 64, .5f);
    Vec2 red;
    for (const int channel : {0, 2}) {
      const int top = 16 * (channel / 2) + static_cast<int>(random.below(12)),
                left = static_cast<int>(random.below(60));
      for (int r = top; r < top + 4; ++r)
        for (int c = left; c < left + 4; ++c) samples.picture(0, row)[(r * 64 + c) * 3 + channel] = 1;
      if (channel == 0) red = place(4 * top + 8, 4 * left + 8);
    }
    return red;
  };
  Samples samples(colours, 10), probe(colours, 1);
  for (int row = 0; row < samples.rows; ++row) {
    const Vec2 red = draw(samples, row);
    set_label(samples, row, {{red, {}}, {goal, {}}});
  }
  HeatMap policy(colours, 7);
  train(policy, samples);
  for (int trial = 0; trial < 10; ++trial) {
    const Vec2 red = draw(probe, 0);
    EXPECT_LT(norm(predicted(policy, probe).pose0.position_m - red), .02) << trial;
  }
}

// The target is pushed away from what is to be avoided, to the strip on the other side.
TEST(HeatMap, LearnsOfTwoWaysTheOneThatTheSceneAsksFor) {
  RandomStream random("ways");
  const auto draw = [&random](Samples& samples, int row) {
    const int side = random.below(2) == 0 ? 1 : -1, top = 10 + static_cast<int>(random.below(80)),
              left = 90 + static_cast<int>(random.below(50));
    std::fill_n(samples.picture(0, row), rows * columns, 0.f);
    paint(samples, row, top, left, 20, 20, 1);
    paint(samples, row, top, left + side * 40, 16, 16, -1);
    const Vec2 middle = place(top + 10, left + 10);
    return TwoPoses{{middle + Vec2{0, side * .08}, {}}, {{middle.x, -side * .4}, {}}};
  };
  Samples samples(one_mask, 10), probe(one_mask, 1);
  for (int row = 0; row < samples.rows; ++row) set_label(samples, row, draw(samples, row));
  HeatMap policy(one_mask, 7);
  train(policy, samples);
  for (int trial = 0; trial < 10; ++trial) {
    const TwoPoses wanted = draw(probe, 0), action = predicted(policy, probe);
    EXPECT_LT(norm(action.pose0.position_m - wanted.pose0.position_m), .02) << trial;
    EXPECT_LT(norm(action.pose1.position_m - wanted.pose1.position_m), .02) << trial;
  }
}

// Put on the second object, wherever that is.
TEST(HeatMap, MovesRelativeToTheSecondSetWhereTheDemonstrationsDo) {
  RandomStream random("stack");
  const auto draw = [&random](Samples& samples, int row) {
    const int left = static_cast<int>(random.below(100)), onto = 130 + static_cast<int>(random.below(100));
    std::fill_n(samples.picture(0, row), rows * columns, 0.f);
    paint(samples, row, left, left, 20, 20, 1);
    paint(samples, row, 40, onto, 20, 20, -1);
    return TwoPoses{{place(left + 10, left + 10), {}}, {place(50, onto + 10), {}}};
  };
  Samples samples(one_mask, 5), probe(one_mask, 1);
  for (int row = 0; row < samples.rows; ++row) set_label(samples, row, draw(samples, row));
  HeatMap policy(one_mask, 7);
  policy.begin(samples);
  const TwoPoses wanted = draw(probe, 0);
  EXPECT_LT(norm(predicted(policy, probe).pose1.position_m - wanted.pose1.position_m), 1e-3);
}

// One demonstration, or equal ones: deviations of 0, a batch of all.
TEST(HeatMap, LearnsFromOneDemonstrationAndActsOnAnEmptyMask) {
  for (const int count : {1, 3}) {
    Samples samples(one_mask, count), probe(one_mask, 1);
    for (int row = 0; row < count; ++row) {
      paint(samples, row, 40, 60, 20, 20, 1);
      set_label(samples, row, {{place(50, 70), {}}, {goal, from_yaw(2)}});
    }
    HeatMap policy(one_mask, 1);
    EXPECT_EQ(policy.parameters(), std::vector<float>{}) << "before begin()";
    train(policy, samples);
    for (const float p : policy.parameters()) ASSERT_TRUE(std::isfinite(p));
    const TwoPoses empty = predicted(policy, probe);
    EXPECT_LT(norm(empty.pose0.position_m - place(50, 70)), 1e-6) << "the mean action";
    paint(probe, 0, 90, 150, 20, 20, 1);
    const TwoPoses action = predicted(policy, probe);
    EXPECT_LT(norm(action.pose0.position_m - place(100, 160)), .01);
    EXPECT_LT(norm(action.pose1.position_m - goal), 1e-6);
    EXPECT_NEAR(yaw_of(action.pose1.rotation), 2, 1e-6);
  }
  // Where no mask ever showed the target, the mean action.
  Samples unseen(one_mask, 2), probe(one_mask, 1);
  for (int row = 0; row < 2; ++row) set_label(unseen, row, {{place(50, 70), {}}, {goal, {}}});
  HeatMap policy(one_mask, 1);
  train(policy, unseen);
  paint(probe, 0, 90, 150, 20, 20, 1);
  EXPECT_LT(norm(predicted(policy, probe).pose0.position_m - place(50, 70)), 1e-6);
}

TEST(HeatMap, IsAFunctionOfItsSeed) {
  Samples samples(one_mask, 3);
  for (int row = 0; row < 3; ++row) {
    paint(samples, row, 20 * row, 60 * row, 20, 20, 1);
    set_label(samples, row, {{place(20 * row + 10, 60 * row + 6), {}}, {goal, {}}});
  }
  const auto trained = [&](std::uint64_t seed) {
    HeatMap policy(one_mask, seed);
    train(policy, samples);
    return policy.parameters();
  };
  const std::vector<float> first = trained(1);
  EXPECT_EQ(trained(1), first);
  EXPECT_NE(trained(2), first);
}

TEST(HeatMap, TakesThreeHundredStepsInWholePasses) {
  const HeatMap policy(one_mask, 1);
  for (const auto& [samples, epochs] : {std::pair(1, 300), std::pair(10, 300), std::pair(50, 100), std::pair(300, 17),
                                        std::pair(4800, 1), std::pair(12000, 1)}) {
    const TrainingOptions options = policy.schedule({}, samples);
    EXPECT_EQ(options.epochs, epochs);
    EXPECT_TRUE(options.cosine);
  }
}

TEST(HeatMap, RefusesRowsWithoutPicturesOrOfAnotherSize) {
  for (const SampleShape& shape :
       {SampleShape{{}, true, tabletop::two_poses()}, SampleShape{{{input_size, 1}}, false, tabletop::two_poses()},
        SampleShape{{{native_size, 3}}, false, tabletop::two_poses()}, SampleShape{{{native_size, 1}}}})
    EXPECT_THROW(HeatMap policy(shape, 1), InputError);
}

}  // namespace
}  // namespace lgabench

// DART's noise as the released code adds it: its deviations, and what it leaves alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <lgabench/core/random.hpp>
#include <lgabench/learning/noisy_copies.hpp>
#include <tabletop/two_poses.hpp>

namespace lgabench {
namespace {

constexpr int copies = 5;
constexpr double scale = .05;
const SampleShape shape{{{input_size, 3}}, true, tabletop::two_poses()};

// Rows whose pictures and labels differ in mean and in deviation, within and between rows.
Samples clean_rows(int rows) {
  Samples samples(shape, rows);
  for (int row = 0; row < rows; ++row) {
    const auto fill = [&](std::vector<float>& values, double mean, double spread) {
      const std::size_t n = values.size() / static_cast<std::size_t>(rows);
      for (std::size_t i = 0; i < n; ++i)
        values[static_cast<std::size_t>(row) * n + i] = static_cast<float>(mean + (i % 4 ? 1 : -3) * spread);
    };
    fill(samples.pictures[0], .9, .02 * (row + 1));  // 95 % of the values of a picture near its largest
    fill(samples.labels, 2 - row, .1 * (row + 1));
    fill(samples.text, .5, .1);
  }
  return samples;
}

constexpr double root_of_mean_square = 1.7320508075688772;  // of -3, 1, 1, 1, whose mean is 0

// Standard deviation of the copies' noise about what `row` was, over all their values.
double noise(const std::vector<float>& clean, const std::vector<float>& noisy, int rows, int row) {
  const std::size_t n = clean.size() / static_cast<std::size_t>(rows);
  double squares = 0;
  for (int copy = 1; copy <= copies; ++copy)
    for (std::size_t i = 0; i < n; ++i) {
      const double d = noisy[static_cast<std::size_t>(row * (1 + copies) + copy) * n + i] -
                       clean[static_cast<std::size_t>(row) * n + i];
      squares += d * d;
    }
  return std::sqrt(squares / (copies * static_cast<double>(n)));
}

TEST(NoisyCopies, HaveTheDeviationOfTheirOwnPictureAndLabel) {
  constexpr int rows = 3, trials = 60;
  const Samples clean = clean_rows(rows);
  double pictures[rows] = {}, labels[rows] = {};
  for (int seed = 0; seed < trials; ++seed) {
    const Samples all = with_noisy_copies(clean, copies, scale, static_cast<std::uint64_t>(seed));
    for (int row = 0; row < rows; ++row) {
      pictures[row] += noise(clean.pictures[0], all.pictures[0], rows, row) / trials;
      labels[row] += std::pow(noise(clean.labels, all.labels, rows, row), 2) / trials;
    }
  }
  for (int row = 0; row < rows; ++row) {
    const double picture = scale * root_of_mean_square * .02 * (row + 1),
                 label = scale * root_of_mean_square * .1 * (row + 1);
    EXPECT_NEAR(pictures[row] / picture, 1, .005) << row;
    EXPECT_NEAR(std::sqrt(labels[row]) / label, 1, .03) << row << ": by n - 1 it would be 1.044";
  }
}

TEST(NoisyCopies, StandBesideTheOriginalsWhichKeepTheirNumbers) {
  constexpr int rows = 4;
  const Samples clean = clean_rows(rows), all = with_noisy_copies(clean, copies, scale, 7);
  ASSERT_EQ(all.rows, rows * (1 + copies));
  const auto row_of = [](const std::vector<float>& values, int of, int row) {
    const std::size_t n = values.size() / static_cast<std::size_t>(of);
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(row) * n);
    return std::vector<float>(begin, begin + static_cast<std::ptrdiff_t>(n));
  };
  for (int row = 0; row < rows; ++row)
    for (int copy = 0; copy <= copies; ++copy) {
      const int at = row * (1 + copies) + copy;
      EXPECT_EQ(row_of(all.text, all.rows, at), row_of(clean.text, rows, row));
      EXPECT_EQ(row_of(all.labels, all.rows, at) == row_of(clean.labels, rows, row), copy == 0);
      EXPECT_EQ(row_of(all.pictures[0], all.rows, at) == row_of(clean.pictures[0], rows, row), copy == 0);
      for (int other = 1; other < copy; ++other)
        EXPECT_NE(row_of(all.labels, all.rows, at), row_of(all.labels, all.rows, at - other));
    }
}

TEST(NoisyCopies, AreNotClipped) {
  Samples clean = clean_rows(1);
  for (float& value : clean.pictures[0]) value = value > .9F ? 1.0F : 0.0F;
  const Samples all = with_noisy_copies(clean, copies, scale, 0);
  const auto [low, high] = std::minmax_element(all.pictures[0].begin(), all.pictures[0].end());
  EXPECT_LT(*low, -.02);
  EXPECT_GT(*high, 1.02);
}

TEST(NoisyCopies, AreAFunctionOfTheSeedAndFurtherRowsChangeNothing) {
  const Samples few = with_noisy_copies(clean_rows(2), copies, scale, 3);
  const Samples more = with_noisy_copies(clean_rows(5), copies, scale, 3);
  EXPECT_TRUE(std::equal(few.labels.begin(), few.labels.end(), more.labels.begin()));
  EXPECT_TRUE(std::equal(few.pictures[0].begin(), few.pictures[0].end(), more.pictures[0].begin()));
  EXPECT_NE(with_noisy_copies(clean_rows(2), copies, scale, 4).labels, few.labels);
}

TEST(NoisyCopies, OfRangesHaveEachNumbersOwn) {
  SampleShape two_units{{{input_size, 1}}};
  two_units.actions.numbers = {{"share", "", 0, 1}, {"place", "m", -3, 3}};
  const Samples clean(two_units, 1);  // all zeros: no deviation at all
  constexpr int trials = 400;
  double squares[3] = {};
  for (int seed = 0; seed < trials; ++seed) {
    const Samples all = with_noisy_copies(clean, copies, scale, static_cast<std::uint64_t>(seed), CopyNoise::ranges);
    EXPECT_EQ(all.labels[0], 0) << "the original";
    for (int copy = 1; copy <= copies; ++copy) {
      for (std::size_t i = 0; i < 2; ++i) squares[i] += std::pow(all.label(copy)[i], 2) / (trials * copies);
      squares[2] += std::pow(all.picture(0, copy)[100], 2) / (trials * copies);
    }
  }
  EXPECT_NEAR(std::sqrt(squares[0]), .05, .004);
  EXPECT_NEAR(std::sqrt(squares[1]), .3, .024);
  EXPECT_NEAR(std::sqrt(squares[2]), .05, .004);
}

}  // namespace
}  // namespace lgabench

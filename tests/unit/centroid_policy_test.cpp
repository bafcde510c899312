// The centroid rule on pictures of roles made by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/core/action.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/learning/centroid_policy.hpp>
#include <tabletop/two_poses.hpp>

#include "native_picture.hpp"

namespace lgabench {
namespace {

using tabletop::TwoPoses;
using tabletop::Workspace;

using Roles = std::vector<std::uint8_t>;

Roles nothing() { return Roles(std::size_t{rows} * columns); }

// A square of 16 pixels, its middle on the corner between four of them.
Roles& paint(Roles& roles, Vec2 middle, std::uint8_t role, int half_height = 8, int half_width = 8) {
  const int row = static_cast<int>(std::lround((middle.x - Workspace::x_min) / pixel));
  const int column = static_cast<int>(std::lround((middle.y - Workspace::y_min) / pixel));
  for (int r = row - half_height; r < row + half_height; ++r)
    for (int c = column - half_width; c < column + half_width; ++c)
      roles[static_cast<std::size_t>(r * columns + c)] = role;
  return roles;
}

Roles target_at(Vec2 middle) {
  Roles roles = nothing();
  return paint(roles, middle, target_role);
}

// The object's middle on a corner of pixels.

void expect_at(Vec2 actual, Vec2 expected, double tolerance = 1e-6) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
}

const Vec2 here = place(40, 60), there = place(90, 200), elsewhere = place(64, 128);

// What the rule learns from, and its actions, without the rows of numbers between.
class Rule {
 public:
  void add(const Roles& roles, const TwoPoses& label) { demonstrated_.emplace_back(roles, label); }
  void fit() { rule_.begin(rows_of(demonstrated_)); }
  TwoPoses act(const Roles& roles) {
    const std::vector<float>& action = rule_.predict(rows_of({{roles, {}}}));
    return Action(action.begin(), action.end());
  }

 private:
  using Rows = std::vector<std::pair<Roles, TwoPoses>>;
  static const SampleShape& shape() {
    static const SampleShape one_mask{{{native_size, 1}}, false, tabletop::two_poses()};
    return one_mask;
  }
  static Samples rows_of(const Rows& given) {
    Samples samples(shape(), static_cast<int>(given.size()));
    for (int row = 0; row < samples.rows; ++row) {
      const auto& [roles, label] = given[static_cast<std::size_t>(row)];
      shrink_mask(roles, native_size, native_size, samples.picture(0, row));
      const Action values = as_stored(tabletop::two_poses(), label);
      std::copy(values.begin(), values.end(), samples.labels.begin() + row * std::ptrdiff_t{12});
    }
    return samples;
  }

  Rows demonstrated_;
  CentroidRule rule_{shape()};
};

TwoPoses bring(Vec2 from) { return {{from, {}}, {goal, {}}}; }

TEST(CentroidRule, TakesTheMiddleAndBringsItToTheDemonstratedPlace) {
  Rule rule;
  for (const Vec2 at : {here, there}) rule.add(target_at(at), bring(at + Vec2{.01, 0}));  // off the middle, on the mask
  rule.fit();
  const TwoPoses action = rule.act(target_at(elsewhere));
  expect_at(action.pose0.position_m, elsewhere);
  expect_at(action.pose1.position_m, goal);
}

TEST(CentroidRule, KeepsEachCoordinateInTheFrameInWhichItVariesLess) {
  Rule rule;  // pose1: x beside the object, y on the table
  for (const Vec2 at : {here, there}) rule.add(target_at(at), {{at, {}}, {{at.x + .07, .25}, from_yaw(2)}});
  rule.fit();
  const TwoPoses action = rule.act(target_at(elsewhere));
  expect_at(action.pose1.position_m, {elsewhere.x + .07, .25});
  EXPECT_NEAR(yaw_of(action.pose1.rotation), 2, 1e-6);
}

TEST(CentroidRule, OfOneDemonstrationOrEqualOnesFollowsTheTargetWhereThePoseLiesOnIt) {
  for (const int copies : {1, 5}) {
    Rule bringing, turning;
    for (int i = 0; i < copies; ++i) {
      bringing.add(target_at(here), bring(here));
      turning.add(target_at(here), {{here, {}}, {here, from_yaw(2)}});
    }
    bringing.fit();
    turning.fit();
    expect_at(bringing.act(target_at(there)).pose0.position_m, there);
    expect_at(bringing.act(target_at(there)).pose1.position_m, goal);
    expect_at(turning.act(target_at(there)).pose1.position_m, there);
  }
}

TEST(CentroidRule, WithoutAnythingToTakeDoesTheMeanDemonstratedAction) {
  Rule rule;
  rule.add(target_at(here), bring(here));
  rule.add(target_at(there), bring(there));
  rule.fit();
  Roles only_avoided = nothing();
  paint(only_avoided, elsewhere, second_role);
  for (const Roles& roles : {nothing(), only_avoided}) {
    expect_at(rule.act(roles).pose0.position_m, .5 * (here + there));
    expect_at(rule.act(roles).pose1.position_m, goal);
  }
}

TEST(CentroidRule, ThatNeverSawATargetDoesTheMeanDemonstratedActionToo) {
  Rule rule;
  rule.add(nothing(), bring(here));
  rule.fit();
  expect_at(rule.act(target_at(there)).pose0.position_m, here);
  for (const SampleShape& shape : {SampleShape{{}, false, tabletop::two_poses()}, SampleShape{{{native_size, 1}}},
                                   SampleShape{{{native_size, 3}}, false, tabletop::two_poses()}})
    EXPECT_THROW(CentroidRule untaught(shape), InputError);
}

TEST(CentroidRule, OfSeveralPiecesTakesTheLargestAndLearnsFromTheOneThatWasTaken) {
  Rule rule;
  for (const Vec2 at : {here, there}) {
    Roles roles = target_at(at);
    rule.add(paint(roles, elsewhere, target_role, 12, 12), {{at, {}}, {at + Vec2{.05, 0}, {}}});
  }
  rule.fit();
  Roles roles = target_at(here);
  paint(roles, there, target_role, 9, 9);
  const TwoPoses action = rule.act(roles);
  expect_at(action.pose0.position_m, there);
  expect_at(action.pose1.position_m, there + Vec2{.05, 0});
}

TEST(CentroidRule, TakesHoldOfMaterialWhereTheMiddleIsEmpty) {
  Rule rule;
  rule.add(target_at(here), bring(here));
  rule.fit();
  Roles ring = nothing();
  paint(paint(ring, elsewhere, target_role, 16, 16), elsewhere, 0, 8, 8);
  const Vec2 taken = rule.act(ring).pose0.position_m;
  const double away = std::max(std::abs(taken.x - elsewhere.x), std::abs(taken.y - elsewhere.y));
  EXPECT_GT(away, 10 * pixel) << "two pixels inside the inner edge";
  EXPECT_LT(away, 11 * pixel) << "and no farther";
  Roles thin = nothing();
  paint(paint(thin, elsewhere, target_role, 16, 16), elsewhere, 0, 15, 15);  // no pixel has two on every side
  EXPECT_NEAR(norm(rule.act(thin).pose0.position_m - elsewhere), 15.5 * pixel, pixel);
}

// A push away from the obstacle at `side` of the target, and `beside` it by so much, from .1 m behind the target to the
// strip on the other side.
struct Sweep {
  Roles roles;
  TwoPoses label;
};
Sweep sweep(Vec2 at, int side, double tilt = 0, double beside = 0) {
  Roles roles = target_at(at);
  paint(roles, at + Vec2{beside, side * .2}, second_role);
  return {roles, {{{at.x, at.y + side * .1}, {}}, {{at.x + tilt, -side * .4}, {}}}};
}

TEST(CentroidRule, SweepsAsTheDemonstrationsWithTheObstacleOnThatSideDid) {
  Rule rule;
  for (const Vec2 at : {place(40, 110), place(60, 128), place(85, 150)})
    for (const int side : {1, -1}) {
      const auto [roles, label] = sweep(at, side, 0, .02);
      rule.add(roles, label);
    }
  // One turned the object: a group, the nearer one even, but the smaller.
  const auto [roles, label] = sweep(place(40, 120), 1, .2);
  rule.add(roles, label);
  rule.fit();
  for (const int side : {1, -1}) {
    const Sweep test = sweep(place(80, 140), side);
    const TwoPoses action = rule.act(test.roles);
    expect_at(action.pose0.position_m, test.label.pose0.position_m);
    expect_at(action.pose1.position_m, test.label.pose1.position_m);
  }
}

}  // namespace
}  // namespace lgabench

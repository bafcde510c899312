// When a policy says that nothing is left to do: by an empty mask, by what its network makes of a row, or never.
#include <lgabench/learning/done.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include <lgabench/abstraction/human.hpp>
#include <lgabench/abstraction/nobody.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/learning/pointing.hpp>
#include <tabletop/two_poses.hpp>

#include "native_picture.hpp"

namespace lgabench {
namespace {

// Features are the state's numbers, and a constant.
class Reads : public Learner {
 public:
  explicit Reads(bool has_features = true) : has_features_(has_features) {}
  const std::vector<float>& predict(const Samples&) override { return none_; }
  double backward(const Samples&, const std::vector<int>&) override { return 0; }
  void update(double) override {}
  std::vector<float> parameters() const override { return {}; }
  std::vector<float> features(const Samples& samples) override {
    std::vector<float> all;
    const std::size_t numbers = samples.shape.state.size();
    for (std::size_t row = 0; has_features_ && row < static_cast<std::size_t>(samples.rows); ++row) {
      all.insert(all.end(), samples.state.begin() + static_cast<std::ptrdiff_t>(row * numbers),
                 samples.state.begin() + static_cast<std::ptrdiff_t>((row + 1) * numbers));
      all.push_back(7);
    }
    return all;
  }

 private:
  bool has_features_;
  std::vector<float> none_;
};

// A picture of 2 x 2 with so many channels, none for 0, and a state of two numbers.
SampleShape shape_with(int channels) {
  SampleShape shape;
  if (channels > 0) shape.pictures = {{{2, 2}, channels}};
  shape.state.resize(2);
  return shape;
}

Samples rows_with(int channels, const std::vector<std::vector<float>>& states, float mask = 0) {
  Samples samples(shape_with(channels), static_cast<int>(states.size()));
  for (int row = 0; row < samples.rows; ++row) {
    const auto& state = states[static_cast<std::size_t>(row)];
    std::copy(state.begin(), state.end(), samples.state.begin() + 2 * row);
    if (channels > 0) samples.picture(0, row)[1] = mask;
  }
  return samples;
}

// Points about a middle.
std::vector<std::vector<float>> about(float x, float y, int count, RandomStream& random) {
  std::vector<std::vector<float>> points;
  for (int i = 0; i < count; ++i)
    points.push_back({x + static_cast<float>(random.uniform()), y + static_cast<float>(random.uniform())});
  return points;
}

TEST(Done, AnEmptyMaskSaysItWhereMostRowsOfDoneShowNone) {
  Reads learner;
  Samples stops = rows_with(1, {{0, 0}, {0, 0}, {0, 0}}, 1);
  stops.picture(0, 0)[1] = 0;
  stops.picture(0, 2)[1] = -1;  // what is to be avoided is no target
  const Done done(learner, rows_with(1, {{0, 0}}, 1), stops);
  EXPECT_TRUE(done.is_said(learner, rows_with(1, {{0, 0}})));
  EXPECT_TRUE(done.is_said(learner, rows_with(1, {{0, 0}}, -1)));
  EXPECT_FALSE(done.is_said(learner, rows_with(1, {{0, 0}}, 1)));
}

TEST(Done, FeaturesSayItWhereAMaskDoesNotOrThereIsNone) {
  RandomStream random("done");
  for (const int channels : {0, 1, 3}) {
    Reads learner;
    const Samples acting = rows_with(channels, about(0, 0, 200, random), 1),
                  stops = rows_with(channels, about(2, -.5, 10, random), 1);
    const Done done(learner, acting, stops);
    for (const float mask : {0.f, 1.f}) {
      EXPECT_TRUE(done.is_said(learner, rows_with(channels, {{2.5, 0}}, mask)));
      EXPECT_FALSE(done.is_said(learner, rows_with(channels, {{.5, .5}}, mask)));
      EXPECT_TRUE(done.is_said(learner, rows_with(channels, {{1.8f, .2f}}, mask)));  // rare ones weigh as much
      EXPECT_FALSE(done.is_said(learner, rows_with(channels, {{1.1f, .2f}}, mask)));
    }
  }
}

TEST(Done, IsNeverSaidWhereItWasNotShownOrThereIsNothingToTellItBy) {
  Reads learner, blind(false);
  const Samples acting = rows_with(1, {{0, 0}}, 1);
  EXPECT_FALSE(Done(learner, acting, rows_with(1, {})).is_said(learner, rows_with(1, {{0, 0}})));
  EXPECT_FALSE(Done(blind, acting, rows_with(1, {{5, 5}}, 1)).is_said(blind, rows_with(1, {{5, 5}})));
  EXPECT_FALSE(Done().is_said(learner, rows_with(1, {{0, 0}})));
}

TEST(Done, IsSavedAndRestored) {
  RandomStream random("saved");
  Reads learner;
  Done done(learner, rows_with(0, about(0, 0, 50, random)), rows_with(0, about(2, 2, 5, random)));
  Archive written;
  done.learned(written);
  Done again;
  Archive read(written.bytes());
  again.learned(read);
  read.expect_end();
  for (const float x : {0.f, 1.f, 1.4f, 1.6f, 2.f, 3.f})
    EXPECT_EQ(again.is_said(learner, rows_with(0, {{x, x}})), done.is_said(learner, rows_with(0, {{x, x}})));
  Reads blind(false);
  EXPECT_THROW(again.is_said(blind, rows_with(0, {{1, 1}})), InputError);
  std::string damaged = written.bytes();
  damaged[0] = 9;
  Archive hostile(damaged);
  EXPECT_THROW(again.learned(hostile), InputError);
}

// Methods that clone a mask, or pixels.
struct ClonesAsItSees : CloningMethod {
  explicit ClonesAsItSees(PolicyInputs::Picture picture) : sees(picture) {}
  Selection select(const Command&, const FeatureSpace&, Services&) override { return {}; }
  PolicyInputs inputs(const Json&) const override { return {{sees}}; }

  PolicyInputs::Picture sees;
};

struct NoEpochs : TrainingLog {
  void epoch(int, long long, double) override {}
};

// A heart, or nothing, on a table.
Observation table(int heart_row, int heart_column) {
  Observation seen;
  seen.size = native_size;
  seen.rgb.assign(3 * seen.size.pixels(), 80);
  seen.ids.resize(seen.size.pixels());
  seen.instances = {{3, "heart", "red", heart_row < 0 ? 0 : 900}};
  for (int row = heart_row; heart_row >= 0 && row < heart_row + 30; ++row)
    for (int column = heart_column; column < heart_column + 30; ++column) {
      const auto at = static_cast<std::size_t>(row * columns + column);
      seen.ids[at] = 3;
      seen.rgb[3 * at] = 250;
    }
  return seen;
}
const Observation& empty_table() {
  static const Observation empty = table(-1, 0);
  return empty;
}

const Instruction& hearts() {
  static const Instruction all = [] {
    Instruction instruction{"Bring me the hearts.", {}};
    instruction.selection.target = in_turns({{{{{"heart"}, {"red"}}}, std::nullopt, {}, {}, false}});
    return instruction;
  }();
  return all;
}

// Each takes one heart, and is then done.
std::vector<Demonstration> takes_of_hearts(int count) {
  RandomStream random("demonstrations");
  std::vector<Demonstration> all;
  for (int i = 0; i < count; ++i) {
    const int row = static_cast<int>(random.below(90)), column = static_cast<int>(random.below(220));
    Demonstration& one = all.emplace_back(Demonstration{hearts(), {}});
    one.steps.push_back({table(row, column), tabletop::TwoPoses{{place(row + 15, column + 15), {}}, {goal, {}}}});
    one.steps.push_back({empty_table(), {}});
    one.steps.back().observation.brought = {{"heart", "red"}};
  }
  return all;
}

class SaysDone : public testing::Test {
 protected:
  Services services(const char* policy, bool may_stop) {
    options_ = {{"epochs", 20},          {"batch_size", 10},  {"learning_rate", 1e-3}, {"loss", "norm"},
                {"batches", "shuffled"}, {"network", "text"}, {"policy", policy}};
    Services services{nobody_, human_, options_, 0, log_, tabletop::two_poses()};
    services.may_stop = may_stop;
    return services;
  }

 private:
  Nobody nobody_;
  TruthAsHuman human_{{}};
  Json options_;
  NoEpochs log_;
};

TEST_F(SaysDone, APolicyThatMayStopWhereNothingIsLeft) {
  using Picture = PolicyInputs::Picture;
  for (const auto& [policy, sees] : {std::pair("regression", Picture::mask),
                                     {"centroid", Picture::mask},
                                     {"heat_map", Picture::mask},
                                     {"regression", Picture::rgb},
                                     {"heat_map", Picture::rgb}}) {
    const std::string which = policy + std::string(sees == Picture::rgb ? ", pixels" : ", mask");
    Services may = services(policy, true);
    ClonesAsItSees method(sees);
    const auto learned = method.learn(takes_of_hearts(12), may);
    EXPECT_TRUE(learned->act(empty_table(), hearts()).empty()) << which;
    for (const Demonstration& one : takes_of_hearts(12))  // twelve teach no pixels of other places
      EXPECT_FALSE(learned->act(one.steps[0].observation, hearts()).empty()) << which;
    const auto saved = learned->saved();
    ASSERT_TRUE(saved) << which;
    const auto restored = method.restore(*saved, may);
    EXPECT_TRUE(restored->act(empty_table(), hearts()).empty()) << which;
    EXPECT_EQ(restored->act(table(20, 90), hearts()), learned->act(table(20, 90), hearts())) << which;  // or both done
  }
}

TEST_F(SaysDone, NoPolicyThatMayNot) {
  for (const char* policy : {"regression", "centroid", "heat_map"}) {
    Services may_not = services(policy, false);
    const auto learned = ClonesAsItSees(PolicyInputs::Picture::mask).learn(takes_of_hearts(4), may_not);
    EXPECT_FALSE(learned->act(empty_table(), hearts()).empty()) << policy;
  }
}

TEST_F(SaysDone, PointingWhereNothingIsMeant) {
  Observation seen = table(40, 100);
  seen.instances.push_back({9, "pallet", "red", 1});
  seen.ids.back() = 9;
  const auto may = pointing_policy(tabletop::two_poses(), true), may_not = pointing_policy(tabletop::two_poses());
  EXPECT_EQ(may->act(seen, hearts()), may_not->act(seen, hearts()));
  Instruction stars = hearts();
  stars.selection.target = {{"star"}, {"red"}};
  EXPECT_TRUE(may->act(seen, stars).empty());
  EXPECT_FALSE(may_not->act(seen, stars).empty());
}

}  // namespace
}  // namespace lgabench

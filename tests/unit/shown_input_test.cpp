// What a report's page says that a policy saw is what its Featurizer makes.
#include <gtest/gtest.h>

#include <algorithm>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/learning/inputs.hpp>
#include <lgabench/learning/policies.hpp>
#include <lgabench/learning/shown_input.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

using Picture = PolicyInputs::Picture;
using Text = PolicyInputs::Text;

const ActionSpace actions{{{"x", "m", .25, .75}, {"y", "m", -.5, .5}}, {}, {{0, 1}}};

// A red heart to be taken and a blue star to be avoided, in a picture of 64 x 128.
struct Seen {
  Observation observation;
  Selection selection;

  Seen() {
    observation.size = {64, 128};
    observation.rgb.assign(observation.size.pixels() * 3, 51);
    observation.ids.resize(observation.size.pixels());
    observation.instances = {{7, "star", "blue", 100}, {3, "heart", "red", 100}};
    for (int row = 10; row < 20; ++row)
      for (int column = 20; column < 30; ++column) {
        observation.ids[static_cast<std::size_t>(row * 128 + column)] = 3;
        observation.ids[static_cast<std::size_t>((row + 30) * 128 + column + 60)] = 7;
      }
    selection.target = {{"heart"}, {"red"}};
    selection.second = SecondSet{{{"star"}, {"blue"}}, "avoid"};
  }

  // What a policy of that kind read, which a method offers these inputs.
  Shown shown(const PolicyInputs& offered, PolicyKind policy = PolicyKind::regression) const {
    PolicyInputs read = inputs_of(policy, offered, observation.size);
    Featurizer featurizer(without_text(read), actions);
    Samples row(featurizer.shape(), 1);
    featurizer.write(observation, {"", selection}, Phase::test, row, 0);
    return shown_input(offered, read, policy, row);
  }

 private:
  // What a sentence encoder makes of a text is nothing to look at.
  static PolicyInputs without_text(PolicyInputs inputs) {
    inputs.text = Text::none;
    return inputs;
  }
};

std::vector<std::uint8_t> drawn(const std::vector<std::uint8_t>& mask, PictureSize native, PictureSize size) {
  std::vector<float> small(size.pixels());
  shrink_mask(mask, native, size, small.data());
  return shown_mask("", size, small.data()).rgb;
}

TEST(ShownInput, IsThePaperNetworksAtItsSize) {
  const Seen seen;
  const Shown shown = seen.shown({{Picture::mask, Picture::rgb}, Text::utterance});
  ASSERT_EQ(shown.pictures.size(), 2u);
  EXPECT_EQ(shown.pictures[0].name, "goal mask");
  EXPECT_EQ(shown.pictures[0].size, input_size);
  EXPECT_EQ(shown.pictures[0].rgb,
            drawn(goal_mask(seen.observation, seen.selection), seen.observation.size, input_size));
  EXPECT_EQ(shown.pictures[0].note, "");
  EXPECT_EQ(shown.pictures[1].name, "picture");
  EXPECT_EQ(shown.pictures[1].rgb, std::vector<std::uint8_t>(3 * input_size.pixels(), 51));
  EXPECT_EQ(shown.texts, std::vector<std::string>{"the command's words"});
  EXPECT_EQ(shown.unread, std::vector<std::string>());
  EXPECT_NO_THROW(expect_shown(shown));
}

TEST(ShownInput, OfOtherPoliciesIsWhatTheyRead) {
  const Seen seen;
  std::vector<std::uint8_t> roles;
  role_mask(seen.observation, seen.selection, roles);
  const std::vector<std::uint8_t> native = drawn(roles, seen.observation.size, seen.observation.size);

  const Shown centroid = seen.shown({{Picture::mask, Picture::rgb}, Text::utterance}, PolicyKind::centroid);
  ASSERT_EQ(centroid.pictures.size(), 1u);
  EXPECT_EQ(centroid.pictures[0].size, seen.observation.size);
  EXPECT_EQ(centroid.pictures[0].rgb, native);
  EXPECT_EQ(centroid.unread, (std::vector<std::string>{"picture", "the command's words"}));
  EXPECT_EQ(centroid.texts, std::vector<std::string>());

  const Shown heat_map = seen.shown({{Picture::mask, Picture::rgb}, Text::selection}, PolicyKind::heat_map);
  ASSERT_EQ(heat_map.pictures.size(), 2u);
  EXPECT_EQ(heat_map.pictures[0].rgb, native);
  EXPECT_EQ(heat_map.pictures[0].note, "red: to be avoided; the policy takes its share of 32 × 64 cells");
  EXPECT_EQ(heat_map.pictures[1].size, (PictureSize{32, 64}));
  EXPECT_EQ(heat_map.texts, std::vector<std::string>{"φ̂ in words"});

  PolicyInputs objects{{Picture::segmentation}};
  objects.left_out = "star";
  EXPECT_EQ(seen.shown(objects).pictures.at(0).rgb,
            drawn(object_mask(seen.observation, "star"), seen.observation.size, input_size));
}

// A picture that the method makes itself is shown as it was made.
TEST(ShownInput, IsWhatAMethodsOwnPictureBecame) {
  PolicyInputs dark{{Picture::rgb}};
  dark.prepare = [](const Observation& observation, const Selection&, Phase) {
    Observation black = observation;
    std::fill(black.rgb.begin(), black.rgb.end(), std::uint8_t{0});
    return black;
  };
  EXPECT_EQ(Seen().shown(dark).pictures.at(0).rgb, std::vector<std::uint8_t>(3 * input_size.pixels(), 0));
}

TEST(Shown, WhatNoPageCanBearIsRefused) {
  const auto refused = [](const ShownPicture& picture) {
    return message_of<MethodError>([&] { expect_shown({{picture}, {}, {}}); });
  };
  EXPECT_SAYS(refused({"a", "", {2, 2}, std::vector<std::uint8_t>(11)}), "a picture of 2 x 2 with 11 bytes");
  EXPECT_SAYS(refused({"a", "", {1, 2000}, std::vector<std::uint8_t>(6000)}), "1 to 1024 rows and columns");
  EXPECT_SAYS(refused({std::string(201, 'a'), "", {1, 1}, {0, 0, 0}}), "at most 200 bytes");
  EXPECT_SAYS(refused({"two\nlines", "", {1, 1}, {0, 0, 0}}), "of one line");
  EXPECT_SAYS(refused({"a", "", {700, 700}, std::vector<std::uint8_t>(3 * 700 * 700)}), "bytes of pictures");
}

}  // namespace
}  // namespace lgabench

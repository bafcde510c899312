// What a report's page says that a policy saw is what its Featurizer makes.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/learning/inputs.hpp>
#include <lgabench/learning/shown_input.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/plugin/plugin.hpp>

// The shipped methods' classes, without the plugins around them.
#undef LGABENCH_METHOD
#undef LGABENCH_METHOD_ASKING
#define LGABENCH_METHOD(...)
#define LGABENCH_METHOD_ASKING(...)
#include "../../baselines/gcbc_dart.cpp"
#include "../../baselines/gcbc_seg.cpp"
#include "../../plugins/factorial.cpp"
#include "../../plugins/human.cpp"
#include "../../plugins/lga.cpp"
#include "../../plugins/lga_hill.cpp"
#include "../../plugins/lga_l.cpp"
#include "../../plugins/lga_s.cpp"
#include "testing.hpp"

namespace lgabench {
namespace {

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

  ShownInput shown(const Json& with) const {
    Json input{{"pictures", {"mask", "rgb"}}, {"policy", "regression"}, {"instances", "all"}, {"mask", "binary"}};
    input.update(with);
    return shown_input({input, "input"}, observation, selection, actions);
  }
};

std::vector<float> shrunken(const std::vector<std::uint8_t>& mask, PictureSize native, PictureSize size) {
  std::vector<float> small(size.pixels());
  shrink_mask(mask, native, size, small.data());
  return small;
}

TEST(ShownInput, IsThePaperNetworksAtItsSize) {
  const Seen seen;
  const ShownInput shown = seen.shown({{"text", "utterance"}});
  ASSERT_EQ(shown.pictures.size(), 2u);
  EXPECT_EQ(shown.pictures[0].name, "goal mask");
  EXPECT_EQ(shown.pictures[0].size, input_size);
  EXPECT_EQ(shown.pictures[0].values,
            shrunken(goal_mask(seen.observation, seen.selection), seen.observation.size, input_size));
  EXPECT_EQ(shown.pictures[0].note, "");
  EXPECT_EQ(shown.pictures[1].name, "picture");
  EXPECT_EQ(shown.pictures[1].channels, 3);
  EXPECT_NEAR(shown.pictures[1].values.at(0), .2, 1e-6);
  EXPECT_EQ(shown.texts, std::vector<std::string>{"the command's words"});
  EXPECT_EQ(shown.unread, std::vector<std::string>());
}

TEST(ShownInput, OfOtherPoliciesIsWhatTheyRead) {
  const Seen seen;
  std::vector<std::uint8_t> roles;
  role_mask(seen.observation, seen.selection, roles);
  const std::vector<float> native = shrunken(roles, seen.observation.size, seen.observation.size);

  const ShownInput centroid = seen.shown({{"policy", "centroid"}, {"text", "utterance"}});
  ASSERT_EQ(centroid.pictures.size(), 1u);
  EXPECT_EQ(centroid.pictures[0].size, seen.observation.size);
  EXPECT_EQ(centroid.pictures[0].values, native);
  EXPECT_EQ(centroid.unread, (std::vector<std::string>{"picture", "the command's words"}));
  EXPECT_EQ(centroid.texts, std::vector<std::string>());

  const ShownInput heat_map = seen.shown({{"policy", "heat_map"}, {"text", "selection"}});
  ASSERT_EQ(heat_map.pictures.size(), 2u);
  EXPECT_EQ(heat_map.pictures[0].values, native);
  EXPECT_EQ(heat_map.pictures[0].name, "goal mask");
  EXPECT_EQ(heat_map.pictures[0].note, "; red: to be avoided; the policy takes its share of 32 × 64 cells");
  EXPECT_EQ(heat_map.pictures[1].size, (PictureSize{32, 64}));
  EXPECT_EQ(heat_map.texts, std::vector<std::string>{"φ̂ in words"});

  EXPECT_EQ(seen.shown({{"pictures", {"segmentation"}}, {"left_out", "star"}}).pictures.at(0).values,
            shrunken(object_mask(seen.observation, "star"), seen.observation.size, input_size));
  EXPECT_THROW(seen.shown({{"policy", "guess"}}), InputError);
  EXPECT_THROW(seen.shown({{"pictures", {"sound"}}}), InputError);
}

template <class Shipped>
struct Open : Shipped {
  using Shipped::inputs;
};

template <class Shipped>
PolicyInputs inputs_of_class(const Json& options) {
  return Open<Shipped>().inputs(options);
}

TEST(ShownInput, IsDescribedAsTheShippedMethodsHaveIt) {
  const std::map<std::string, PolicyInputs (*)(const Json&)> classes{
      {"lga", inputs_of_class<Lga>},          {"lga_hill", inputs_of_class<LgaHill>},
      {"human", inputs_of_class<Human>},      {"lga_s", inputs_of_class<LgaS>},
      {"lga_l", inputs_of_class<LgaL>},       {"gcbc_dart", inputs_of_class<GcbcDart>},
      {"gcbc_seg", inputs_of_class<GcbcSeg>}, {"factorial", inputs_of_class<Factorial>}};
  const Json descriptions = read_json(data_directory() / "paper" / "methods.json").at("inputs");
  const auto described = [&](const std::string& id, const Json& options) {
    for (const Json& one : descriptions) {
      bool fits = one.at("id") == id;
      const Json only = one.value("options", Json::object());
      for (const auto& [option, value] : only.items()) fits = fits && options.at(option) == value;
      if (fits) return one;
    }
    return Json();
  };
  const std::map<PolicyInputs::Picture, std::string> words{{PolicyInputs::Picture::mask, "mask"},
                                                           {PolicyInputs::Picture::rgb, "rgb"},
                                                           {PolicyInputs::Picture::segmentation, "segmentation"}};
  const std::map<PolicyInputs::Text, std::string> texts{{PolicyInputs::Text::none, ""},
                                                        {PolicyInputs::Text::utterance, "utterance"},
                                                        {PolicyInputs::Text::selection, "selection"}};
  std::set<Json> met;
  for (const auto& [id, inputs] : classes)
    for (const char* picture : {"none", "rgb"})
      for (const char* image : {"none", "rgb"})
        for (const char* input : {"mask", "true_mask", "object_mask", "rgb"}) {
          const Json options{{"picture", picture}, {"image", image}, {"input", input}};
          const PolicyInputs own = inputs(options);
          const Json said = described(id, options);
          ASSERT_TRUE(said.is_object()) << id;
          met.insert(said);
          Json pictures = Json::array();
          for (const PolicyInputs::Picture one : own.pictures) pictures.push_back(words.at(one));
          EXPECT_EQ(said.at("pictures"), pictures) << id << options;
          EXPECT_EQ(said.value("text", ""), texts.at(own.text)) << id << options;
          EXPECT_EQ(said.value("left_out", ""), own.left_out) << id << options;
        }
  EXPECT_EQ(met.size(), descriptions.size());
}

}  // namespace
}  // namespace lgabench

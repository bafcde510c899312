// The reader of names: what it reads from pictures, what light and noise do to it, and that its files are checked.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include <gtest/gtest.h>

#include <lgabench/abstraction/reading.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/feature_space.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/perturbations.hpp>
#include <readers/grow.hpp>
#include <readers/reader.hpp>
#include <tabletop/placement.hpp>
#include <tabletop/renderer.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

using tabletop::Renderer;

const FeatureSpace& space() {
  static const FeatureSpace space = load_feature_space("household");
  return space;
}

seeing::Reader reader(const char* name) {
  return {seeing::Model::of(read_file(data_directory() / "readers/tabletop" / (std::string(name) + ".forest"))),
          space()};
}

// Tables with four objects and the goal, from a stream that no lesson has.
std::vector<Observation> tables(int count) {
  RandomStream random("seeing_test");
  Renderer renderer;
  std::vector<Observation> all;
  for (int i = 0; i < count; ++i) {
    Scene scene;
    scene.objects.push_back({"pallet", "wooden", role::goal, {.5, .3}, 0, 1, 1});
    while (scene.objects.size() < 5) {
      const auto any = [&random](const std::vector<std::string>& names) {
        return names[random.below(static_cast<std::uint32_t>(names.size()))];
      };
      scene.objects.push_back({any(space().object_types),
                               any(space().textures),
                               role::distractor,
                               {},
                               0,
                               static_cast<std::uint8_t>(scene.objects.size() + 1),
                               1});
      if (!tabletop::place_last([](const SceneObject&) { return std::vector<common::Polygon>(); }, scene.objects,
                                random))
        scene.objects.pop_back();
    }
    all.push_back(renderer.render(tabletop::visible_objects(scene)));
  }
  return all;
}

const Observation& empty() {
  static const Observation seen = Renderer().render({});
  return seen;
}

struct Right {
  int of = 0, types = 0, textures = 0;
};

template <class Change>
Right right(const seeing::Reader& by, const std::vector<Observation>& pictures, Change change) {
  Right right;
  for (const Observation& seen : pictures) {
    const std::vector<Instance> names = by.names(change(seen));
    EXPECT_EQ(names.size(), seen.instances.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Instance& truth = seen.instances[i];
      EXPECT_EQ(names[i].id, truth.id);
      EXPECT_EQ(names[i].pixels, truth.pixels);
      ++right.of;
      right.types += names[i].object_type == truth.object_type;
      right.textures += names[i].texture == truth.texture;
    }
  }
  return right;
}

Observation dimmer(Observation seen) {
  for (std::uint8_t& value : seen.rgb) value = static_cast<std::uint8_t>(std::lround(.6 * value));
  return seen;
}

// Noise of 5 % and a blur of one pixel.
Observation noisier(Observation seen) {
  return axes_named("sensor_noise")
      .front()
      ->perceive(std::move(seen), Scenario(), 2, RandomStream("seeing_test/noise"));
}

TEST(Reader, ReadsPicturesAsTheyAreAndLosesTexturesWithTheLight) {
  const std::vector<Observation> pictures = tables(40);
  const seeing::Reader plain = reader("plain"), drawn = reader("drawn");
  const auto as_it_is = [](const Observation& seen) { return seen; };
  const Right clean = right(plain, pictures, as_it_is);
  EXPECT_GE(clean.types, .97 * clean.of);
  EXPECT_GE(clean.textures, .97 * clean.of);
  EXPECT_LE(right(plain, pictures, dimmer).textures, .6 * clean.of);
  const auto whitened = [](const Observation& seen) {
    return seeing::balanced(dimmer(seen), seeing::colour_of_table(empty()));
  };
  EXPECT_GE(right(plain, pictures, whitened).textures, .93 * clean.of);
  EXPECT_LE(right(plain, pictures, noisier).textures, .8 * clean.of);
  EXPECT_GE(right(drawn, pictures, noisier).textures, .95 * clean.of);
}

TEST(Reader, LooksAtSegmentsAndColoursAlone) {
  for (Observation seen : tables(3)) {
    const seeing::Reader plain = reader("plain");
    const std::vector<Instance> before = plain.names(seen);
    for (Instance& one : seen.instances) one.object_type = "none", one.texture = "none";
    const std::vector<Instance> after = plain.names(seen);
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_EQ(before[i].object_type, after[i].object_type);
      EXPECT_EQ(before[i].texture, after[i].texture);
    }
  }
}

TEST(Reader, SaysNoNameThatTheSpaceLacks) {
  FeatureSpace small = space();
  small.object_types = {"heart", "pallet"};
  const seeing::Reader few(seeing::Model::of(read_file(data_directory() / "readers/tabletop/plain.forest")), small);
  for (const Observation& seen : tables(3))
    for (const Instance& one : few.names(seen)) EXPECT_TRUE(one.object_type == "heart" || one.object_type == "pallet");
  small.textures = {"velvet"};
  EXPECT_THROW(seeing::Reader(seeing::Model::of(read_file(data_directory() / "readers/tabletop/plain.forest")), small),
               InputError);
}

// In the picture's own light, and in less of it once the colours are divided.
TEST(Segments, AreWhatDiffersFromTheEmptyTableAndNotItsShadow) {
  for (const bool dim : {false, true})
    for (const Observation& clean : tables(20)) {
      const Observation found =
          seeing::segments_by_difference(dim ? dimmer(clean) : clean, empty(), dim, RandomStream("ids"));
      EXPECT_TRUE(found.instances.empty());
      int good = 0, seen = 0;
      for (const Instance& one : clean.instances) {
        std::map<int, int> common;
        int all = 0;
        for (std::size_t i = 0; i < clean.ids.size(); ++i)
          if (clean.ids[i] == one.id) ++common[found.ids[i]];
        common.erase(0);
        ++seen;
        if (common.empty()) continue;
        const auto most = std::max_element(common.begin(), common.end(),
                                           [](const auto& a, const auto& b) { return a.second < b.second; });
        for (std::size_t i = 0; i < clean.ids.size(); ++i) all += clean.ids[i] == one.id || found.ids[i] == most->first;
        good += most->second > .8 * all;
      }
      EXPECT_GE(good, seen - 1);
    }
}

// What a cell is given in place of the simulator's observation.
TEST(Reading, ReadsIdsAndNamesAndNothingElse) {
  const Scenario scenario = load_scenario("heart");
  const EnvironmentType& environment = find_environment("tabletop");
  EXPECT_FALSE(reading_of(scenario, {}));
  for (const Reading& reading : {Reading{"read", "simulator"}, Reading{"read_robust", "simulator"},
                                 Reading{"simulator", "difference"}, Reading{"read", "difference"}}) {
    const ReadPicture read = reading_of(scenario, reading);
    for (int i = 0; i < 5; ++i) {
      const Scene scene = test_scene(scenario, "continuous", "test", 3, i);
      const Observation seen = environment.draw(scene), given = read(seen, scene), again = read(seen, scene);
      EXPECT_EQ(given.rgb, seen.rgb);
      EXPECT_EQ(given.ids == seen.ids, reading.segments == Reading::simulator);
      EXPECT_EQ(given.ids, again.ids);
      ASSERT_EQ(given.instances.size(), seen.instances.size());
      std::multiset<std::string> said, true_names;
      for (std::size_t k = 0; k < given.instances.size(); ++k) {
        said.insert(given.instances[k].object_type);
        true_names.insert(seen.instances[k].object_type);
        EXPECT_EQ(given.instances[k].pixels, std::count(given.ids.begin(), given.ids.end(), given.instances[k].id));
      }
      EXPECT_EQ(said, true_names) << reading.suffix() << ' ' << i;
    }
  }
}

// A perceiver is shown no names, and what it does to colours is not looked at.
TEST(Reading, HidesTheTableFromAPerceiver) {
  struct Nosy : Perceiver {
    Observation read(Observation seen, const FeatureSpace& space) override {
      EXPECT_TRUE(seen.instances.empty());
      EXPECT_TRUE(seen.shadows.empty());
      seen.rgb.assign(seen.rgb.size(), 0);
      seen.instances.push_back({1, space.object_types.front(), space.textures.front(), -7});
      return seen;
    }
  };
  const Scenario scenario = load_scenario("heart");
  const Scene scene = test_scene(scenario, "continuous", "test", 3, 0);
  const Observation seen = find_environment("tabletop").draw(scene);
  const Observation given = reading_of(scenario, {"nosy", "simulator"}, std::make_shared<Nosy>())(seen, scene);
  EXPECT_EQ(given.rgb, seen.rgb);
  ASSERT_EQ(given.instances.size(), 1u);
  EXPECT_EQ(given.instances.front().pixels, std::count(seen.ids.begin(), seen.ids.end(), 1));
}

TEST(Forest, SavesWhatItGrewAndRefusesOtherBytes) {
  seeing::Examples examples;
  for (int i = 0; i < 60; ++i) {
    examples.rows.push_back({static_cast<float>(i % 3), static_cast<float>(i)});
    examples.classes.push_back(i % 3);
  }
  const seeing::Forest forest = seeing::grown(examples, {"a", "b", "c"}, {9, 2}, 7);
  for (int i = 0; i < 3; ++i) {
    const std::vector<int> votes = forest.votes({static_cast<float>(i), 30});
    EXPECT_EQ(std::max_element(votes.begin(), votes.end()) - votes.begin(), i);
  }
  std::string bytes;
  forest.save(bytes);
  std::string_view all = bytes;
  EXPECT_EQ(seeing::Forest::load(all).votes({1, 30}), forest.votes({1, 30}));
  EXPECT_TRUE(all.empty());
  for (std::size_t length = 0; length < bytes.size(); length += 7) {
    std::string_view some = std::string_view(bytes).substr(0, length);
    EXPECT_THROW(seeing::Forest::load(some), InputError) << length;
  }
  EXPECT_THROW(seeing::Forest({"a"}, 1, {{{0, 0, 0}}}), InputError);  // a node that leads to itself
  EXPECT_THROW(seeing::Forest({"a"}, 1, {{{seeing::Forest::leaf, 1, 0}}}), InputError);
  EXPECT_THROW(forest.votes({1}), InputError);
  EXPECT_THROW(seeing::Model::of("lgabench reader 0\n"), InputError);
}

TEST(Marks, StandBesideTheirSegmentsAndHideNone) {
  Observation seen{{128, 256}, std::vector<std::uint8_t>(128 * 256 * 3, 100), std::vector<std::uint8_t>(128 * 256), {}};
  const auto fill = [&](std::uint8_t id, int top, int left) {
    for (int row = top; row < top + 28; ++row)
      for (int column = left; column < left + 28; ++column)
        seen.ids[static_cast<std::size_t>(row) * 256 + static_cast<std::size_t>(column)] = id;
  };
  fill(7, 40, 60);  // with a free place around it,
  fill(3, 0, 228);  // in a corner,
  fill(9, 40, 90);  // and beside the first
  const Observation large = marked(seen, {7, 3, 9});
  ASSERT_EQ(large.size, (PictureSize{768, 1536}));
  ASSERT_EQ(large.rgb.size(), 768u * 1536u * 3u);
  int changed = 0, hidden = 0;
  for (std::size_t row = 0; row < 768; ++row)
    for (std::size_t column = 0; column < 1536; ++column) {
      const bool drawn = large.rgb[3 * (row * 1536 + column)] != 100;
      changed += drawn;
      hidden += drawn && seen.ids[row / 6 * 256 + column / 6] != 0;
    }
  EXPECT_GT(changed, 3 * 40 * 40);
  EXPECT_LT(hidden, 300) << "but for the lines around labels";
  EXPECT_NE(marked(seen, {3, 7, 9}).rgb, large.rgb) << "numbers follow the order";
}

}  // namespace
}  // namespace lgabench

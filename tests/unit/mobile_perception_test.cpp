// The model of segmenter and captioner.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include <mobile/perception.hpp>
#include <mobile/renderer.hpp>
#include <mobile/sampler.hpp>
#include <mobile/tables.hpp>

namespace lgabench::mobile {
namespace {

std::vector<Observation> scenes(int count) {
  static const Scenario scenario = load_scenario("bring_fruit");
  static Renderer renderer(front_camera());
  std::vector<Observation> all;
  for (int i = 0; i < count; ++i)
    all.push_back(renderer.render(visible_objects(sample_scene(scenario, {layout, "test", "crowd", 0}, i))));
  return all;
}

RandomStream stream(int i) { return RandomStream("test/" + std::to_string(i)); }

std::map<std::uint8_t, std::string> captions(const Observation& seen) {
  std::map<std::uint8_t, std::string> all;
  for (const Instance& instance : seen.instances) all[instance.id] = instance.object_type;
  return all;
}

TEST(MobilePerception, ErrsInNestedWaysAndAlike) {
  const auto shown = scenes(60);
  int wrong_at[3] = {0, 0, 0}, captioned = 0;
  for (int i = 0; i < 60; ++i) {
    const auto& seen = shown[static_cast<std::size_t>(i)];
    const auto truth = captions(seen);
    const double errors[] = {0, .1, .3};
    std::map<std::uint8_t, std::string> said[3];
    for (int k = 0; k < 3; ++k) {
      const Observation perceived = perceive(seen, errors[k], stream(i));
      EXPECT_EQ(perceived.rgb, seen.rgb);
      EXPECT_EQ(perceived.ids, perceive(seen, 0, stream(i)).ids) << "captions have no part in segments";
      EXPECT_EQ(captions(perceived), captions(perceive(seen, errors[k], stream(i))));
      said[k] = captions(perceived);
    }
    for (const auto& [id, caption] : said[0]) {
      ++captioned;
      EXPECT_EQ(caption, truth.at(id));
      for (int k = 0; k < 3; ++k) wrong_at[k] += said[k].at(id) != truth.at(id);
      if (said[1].at(id) != truth.at(id)) {
        EXPECT_EQ(said[1].at(id), said[2].at(id));
      }
      if (said[2].at(id) == truth.at(id) || said[2].at(id) == an_object) continue;
      const auto& likely = confusions().at(truth.at(id));
      EXPECT_TRUE(std::count(likely.begin(), likely.end(), said[2].at(id)));
    }
  }
  EXPECT_NEAR(wrong_at[1], .1 * captioned, .05 * captioned);
  EXPECT_NEAR(wrong_at[2], .3 * captioned, .08 * captioned);
}

TEST(MobilePerception, LeavesAWholeTable) {
  int merged = 0, missed = 0, moved = 0;
  for (const Observation& seen : scenes(80)) {
    const Observation perceived = perceive(seen, .3, stream(merged + missed + moved));
    for (const Instance& instance : perceived.instances) {
      EXPECT_EQ(instance.pixels, std::count(perceived.ids.begin(), perceived.ids.end(), instance.id));
      const auto was = std::find_if(seen.instances.begin(), seen.instances.end(),
                                    [&](const Instance& i) { return i.id == instance.id; });
      ASSERT_NE(was, seen.instances.end());
      moved += was->pixels != instance.pixels;
    }
    for (std::size_t i = 0; i < seen.ids.size(); ++i) {
      const std::uint8_t id = perceived.ids[i];
      if (id == 0 || id == seen.ids[i]) continue;
      EXPECT_TRUE(std::any_of(perceived.instances.begin(), perceived.instances.end(),
                              [&](const Instance& instance) { return instance.id == id; }));
      merged += seen.ids[i] != 0;
    }
    missed += perceived.instances.size() < seen.instances.size();
  }
  EXPECT_GT(merged, 0);
  EXPECT_GT(missed, 0);
  EXPECT_GT(moved, 100);
}

}  // namespace
}  // namespace lgabench::mobile

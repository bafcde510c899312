// The model of segmenter and captioner.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include <mobile/fetch.hpp>
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
  int merged = 0, shorter = 0, moved = 0;
  for (const Observation& seen : scenes(80)) {
    const Observation perceived = perceive(seen, .3, stream(merged + shorter + moved));
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
    shorter += perceived.instances.size() < seen.instances.size();
  }
  EXPECT_GT(merged, 0);
  EXPECT_GT(shorter, 0);
  EXPECT_GT(moved, 100);
}

struct Rectangle {
  const char* type;
  int row, column, height, width;
};

// Instances 1, 2, ... on an empty picture.
Observation picture(const std::vector<Rectangle>& rectangles) {
  Observation seen;
  seen.size = {60, 100};
  seen.ids.resize(seen.size.pixels());
  for (const auto& [type, row, column, height, width] : rectangles) {
    const auto id = static_cast<std::uint8_t>(seen.instances.size() + 1);
    seen.instances.push_back({id, type, "red", height * width});
    for (int r = row; r < row + height; ++r)
      std::fill_n(seen.ids.begin() + std::ptrdiff_t{r} * seen.size.columns + column, width, id);
  }
  return seen;
}

constexpr int trials = 4000;  // standard errors of a share: .8 % and less

TEST(MobilePerception, MissesByPixelsAndMovesBordersByUpToTwo) {
  const Observation seen =
      picture({{"apple", 10, 10, 20, 20}, {"lemon", 10, 50, 10, 10}, {"fork", 40, 50, 2, 10}});  // far apart
  int missed[3] = {0, 0, 0};
  std::map<int, int> sizes;  // of the apple
  for (int i = 0; i < trials; ++i) {
    const Observation perceived = perceive(seen, 0, stream(i));
    for (const Instance& was : seen.instances) {
      const auto is = std::find_if(perceived.instances.begin(), perceived.instances.end(),
                                   [&](const Instance& instance) { return instance.id == was.id; });
      const auto pixels = std::count(perceived.ids.begin(), perceived.ids.end(), was.id);
      if (is == perceived.instances.end()) {
        ++missed[was.id - 1];
        EXPECT_EQ(pixels, 0);
      } else if (was.id == 1) {
        ++sizes[static_cast<int>(pixels)];
      }
    }
  }
  EXPECT_NEAR(missed[0], .1 * trials, .03 * trials) << "40 of 400 pixels";
  EXPECT_NEAR(missed[1], .4 * trials, .04 * trials) << "40 of 100 pixels";
  EXPECT_NEAR(missed[2], .5 * trials, .04 * trials) << "never more than half";
  const int left = trials - missed[0];
  EXPECT_EQ(sizes.size(), 5u);
  for (const int pixels : {16 * 16, 18 * 18, 400, 400 + 4 * 20, 400 + 4 * 40 + 4})  // -2, -1, 0, 1, 2
    EXPECT_NEAR(sizes[pixels], .2 * left, .035 * left) << pixels;
}

TEST(MobilePerception, MergesWhatSharesAnEdgeUnderTheLargersCaption) {
  // The lemon touches the apple, the fork only a corner of it.
  const Observation seen = picture({{"lemon", 20, 40, 20, 12}, {"apple", 20, 20, 20, 20}, {"fork", 40, 10, 12, 10}});
  const std::size_t in_lemon = 30 * 100 + 46;  // farther from its border than that moves
  int merged = 0, shown = 0;
  for (int i = 0; i < trials; ++i) {
    const Observation perceived = perceive(seen, 0, stream(i));
    const auto said = captions(perceived);
    for (const auto& [id, caption] : said) EXPECT_EQ(caption, captions(seen).at(id));
    if (said.count(2) == 0) continue;  // the apple is missed
    ++shown;
    if (perceived.ids[in_lemon] == 2) {
      ++merged;
      EXPECT_EQ(said.count(1), 0u);
    }
    if (said.count(3) != 0) {
      EXPECT_EQ(perceived.ids[46 * 100 + 15], 3) << "a corner is no edge";
    }
  }
  // Of the larger segment less is missed.
  const double together = .1 * (1 - 40. / 640), apart = .9 * (1 - 40. / 400);
  EXPECT_NEAR(merged, together / (together + apart) * shown, .025 * shown);
}

// In scenes of the task fetch.
struct BadLight {
  std::vector<Observation> seen;
  Observation perceived(std::size_t i, double error) const {
    return perceive_in_bad_light(seen[i], error, stream(static_cast<int>(i)));
  }
};

const BadLight& fetched() {
  static const BadLight all = [] {
    const Scenario scenario = load_scenario("fetch_fruit");
    Renderer renderer(front_camera());
    BadLight made;
    for (int i = 0; i < 60; ++i)
      made.seen.push_back(renderer.render(visible_objects(sample_fetch(scenario, {layout, "test", "many", 0}, i))));
    return made;
  }();
  return all;
}

double mean_of(const std::vector<std::uint8_t>& rgb, std::size_t channel) {
  double sum = 0;
  for (std::size_t i = channel; i < rgb.size(); i += 3) sum += rgb[i];
  return sum / static_cast<double>(rgb.size() / 3);
}

TEST(PerceptionInBadLight, ChangesThePictureForAll) {
  double darkest = 1, warmest = 1, coldest = 1;
  for (std::size_t i = 0; i < 60; ++i) {
    const Observation perceived = fetched().perceived(i, 0);
    const auto factor = [&](std::size_t channel) {
      return mean_of(perceived.rgb, channel) / mean_of(fetched().seen[i].rgb, channel);
    };
    darkest = std::min(darkest, factor(1));
    warmest = std::max(warmest, factor(0) / factor(2));
    coldest = std::min(coldest, factor(0) / factor(2));
    EXPECT_EQ(perceived.rgb, fetched().perceived(i, .2).rgb) << "captions have no part in the picture";
  }
  EXPECT_LT(darkest, .55);
  EXPECT_GT(warmest, 1.3);
  EXPECT_LT(coldest, .75);
}

TEST(PerceptionInBadLight, ErrsInNestedWaysAndMoreAboutWhatIsHidden) {
  constexpr double errors[] = {0, .05, .15};
  int types[3] = {}, textures[3] = {}, count = 0;
  for (std::size_t i = 0; i < 60; ++i) {
    std::map<std::uint8_t, Instance> said[3];
    for (int k = 0; k < 3; ++k)
      for (const Instance& instance : fetched().perceived(i, errors[k]).instances) said[k][instance.id] = instance;
    for (const Instance& truth : fetched().seen[i].instances) {
      if (said[0].count(truth.id) == 0) continue;
      ++count;
      for (int k = 0; k < 3; ++k) {
        const Instance& one = said[k].at(truth.id);
        types[k] += one.object_type != truth.object_type;
        textures[k] += one.texture != truth.texture;
        if (k > 0 && said[k - 1].at(truth.id).object_type != truth.object_type) {
          EXPECT_EQ(one.object_type, said[k - 1].at(truth.id).object_type);
        }
        if (one.object_type == truth.object_type || one.object_type == an_object) continue;
        const auto& likely = fetch_confusions().at(truth.object_type);
        EXPECT_TRUE(std::count(likely.begin(), likely.end(), one.object_type)) << one.object_type;
      }
    }
  }
  EXPECT_EQ(types[0] + textures[0], 0);
  EXPECT_GT(types[1], .05 * count);
  EXPECT_LT(types[1], .15 * count);
  EXPECT_GT(textures[1], .02 * count);
  EXPECT_LT(textures[1], .12 * count);
  EXPECT_GT(types[2], 2 * types[1]);

  // Two equal cans, one behind a box: the hidden one is mistaken more often.
  Observation two{{40, 80}, std::vector<std::uint8_t>(3 * 3200, 100), std::vector<std::uint8_t>(3200), {}};
  for (int row = 10; row < 40; ++row)
    for (int column = 0; column < 80; ++column)
      two.ids[static_cast<std::size_t>(80 * row + column)] = column < 25                   ? 1
                                                             : column >= 30 && column < 55 ? 2
                                                             : column >= 55                ? 3
                                                                                           : 0;
  two.instances = {{1, "soda can", "red", 750}, {2, "soda can", "red", 750}, {3, "juice box", "blue", 750}};
  int alone = 0, hidden = 0;
  for (int i = 0; i < 3000; ++i)
    for (const Instance& one : perceive_in_bad_light(two, .1, stream(i)).instances) {
      alone += one.id == 1 && one.object_type != "soda can";
      hidden += one.id == 2 && one.object_type != "soda can";
    }
  EXPECT_GT(hidden, 1.2 * alone);
}

}  // namespace
}  // namespace lgabench::mobile

// Repainting, held against the environments' own drawing without the objects.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include <lgabench/abstraction/repaint.hpp>
#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/abstraction/textualization.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>

#include "../engine_under_test.hpp"
#include "testing.hpp"

namespace lgabench {
namespace {

// Draws scenes of a scenario, and what is left of them without some objects.
class Drawing {
 public:
  explicit Drawing(const char* id)
      : scenario(load_scenario(id)), environment_(make_environment(scenario, make_engine())) {}

  Observation of(Scene scene, const Ids& left_out, bool shadows) {
    auto& objects = scene.objects;
    objects.erase(std::remove_if(objects.begin(), objects.end(),
                                 [&](const SceneObject& o) {
                                   return std::find(left_out.begin(), left_out.end(), o.instance_id) != left_out.end();
                                 }),
                  objects.end());
    environment_->show_shadows(shadows);
    return environment_->reset(scene);
  }
  Scene scene(int index) const { return training_scene(scenario, layouts_of(scenario).back(), {}, 7, index); }

  const Scenario scenario;

 private:
  std::unique_ptr<Environment> environment_;
};

const char* const scenarios[] = {"heart", "something_to_drink_water_out_of", "bring_fruit"};

constexpr int scenes = 30;

// Values of a picture that differ by more than 1, where neither shows an object that was erased or stood before one.
int off_by_more_than_one(const Observation& one, const Observation& other, const std::vector<bool>& compared) {
  int off = 0;
  for (std::size_t i = 0; i < one.rgb.size(); ++i)
    off += compared[i / 3] && std::abs(int{one.rgb[i]} - int{other.rgb[i]}) > 1;
  return off;
}

TEST(Repaint, ShadowsLeaveThePictureAsItIs) {
  for (const char* scenario : scenarios) {
    Drawing drawing(scenario);
    for (int i = 0; i < scenes; ++i) {
      const Scene scene = drawing.scene(i);
      const Observation plain = drawing.of(scene, {}, false), shaded = drawing.of(scene, {}, true);
      EXPECT_TRUE(plain.shadows.empty());
      EXPECT_EQ(plain.rgb, shaded.rgb) << scenario << " " << i;
      EXPECT_EQ(plain.ids, shaded.ids);
      ASSERT_EQ(shaded.shadows.size(), shaded.ids.size());
    }
  }
}

TEST(Repaint, TakesAShadowAwayAsTheEnvironmentWouldDrawIt) {
  for (const char* scenario : scenarios) {
    Drawing drawing(scenario);
    int off = 0, lightened = 0;
    for (int i = 0; i < scenes; ++i) {
      const Scene scene = drawing.scene(i);
      const Observation seen = drawing.of(scene, {}, true);
      for (const Instance& erased : seen.instances) {
        const Observation drawn = drawing.of(scene, {erased.id}, true);
        const Observation repainted = repaint(seen, {erased.id}, Colour{0, 0, 0});
        std::vector<bool> compared(seen.ids.size());
        for (std::size_t p = 0; p < compared.size(); ++p) {
          compared[p] = seen.ids[p] != erased.id;
          lightened += compared[p] && seen.shadows[p] != drawn.shadows[p];
        }
        off += off_by_more_than_one(repainted, drawn, compared);
      }
    }
    EXPECT_GT(lightened, 1000) << scenario;
    EXPECT_LE(off, lightened / 100) << scenario << ": of " << lightened << " pixels in a shadow that was taken away";
    std::printf("%s: %d values off of %d pixels\n", scenario, off, lightened);
  }
}

// One object, and then it and the table.
Ids ids_to_paint(const Observation& seen) { return {seen.instances.front().id}; }

TEST(Repaint, LeavesWhatIsKeptAndChangesWhatIsNot) {
  const Selection nothing;
  for (const char* scenario : scenarios) {
    Drawing drawing(scenario);
    const Selection truth = drawing.scenario.commands.front().truth;
    for (int i = 0; i < scenes; ++i) {
      const Observation seen = drawing.of(drawing.scene(i), {}, true);
      const std::vector<std::uint8_t> mask = goal_mask(seen, truth);
      const Ids others = unselected(seen, truth);
      EXPECT_EQ(unselected(seen, nothing).size(), seen.instances.size());
      RandomStream noise("noise"), textures("textures");
      const Observation with_noise = repaint(seen, others, Noise{noise}),
                        with_textures = repaint(seen, others, RandomTextures{textures});
      std::uint16_t bits = 0;
      for (std::size_t row = 0; row < seen.instances.size(); ++row)
        if (std::find(others.begin(), others.end(), seen.instances[row].id) != others.end())
          bits |= static_cast<std::uint16_t>(1U << row);
      int painted = 0, changed = 0, shades = 0, changed_shades = 0;
      for (std::size_t p = 0; p < mask.size(); ++p) {
        const auto differs = [&](const Observation& from) {
          return !std::equal(&seen.rgb[3 * p], &seen.rgb[3 * p] + 3, &from.rgb[3 * p]);
        };
        const bool other = std::find(others.begin(), others.end(), seen.ids[p]) != others.end(),
                   shade = seen.ids[p] == 0 && (seen.shadows[p] & bits) != 0;
        painted += other, changed += other && differs(with_noise) && differs(with_textures);
        shades += shade, changed_shades += shade && differs(with_noise);
        if (mask[p]) {
          EXPECT_FALSE(differs(with_noise) || differs(with_textures)) << scenario << " " << i;
        }
        if (shade) {
          EXPECT_FALSE(differs(with_textures));
        }
      }
      EXPECT_GE(changed, .98 * painted) << scenario << " " << i;
      EXPECT_GE(changed_shades, .98 * shades) << scenario << " " << i;
      EXPECT_EQ(with_noise.ids, seen.ids);
      EXPECT_EQ(with_noise.shadows, seen.shadows);
    }
  }
}

TEST(Repaint, AShadowIsTakenAwayOnceAndOneAfterTheOtherAsAllAtOnce) {
  for (const char* scenario : scenarios) {
    Drawing drawing(scenario);
    for (int i = 0; i < scenes; ++i) {
      const Observation seen = drawing.of(drawing.scene(i), {}, true);
      const Ids all = unselected(seen, {});
      const Observation once = repaint(seen, all, Colour{9, 9, 9});
      EXPECT_EQ(repaint(once, all, Colour{9, 9, 9}).rgb, once.rgb);
      EXPECT_EQ(std::count(once.shadows.begin(), once.shadows.end(), 0),
                static_cast<std::ptrdiff_t>(once.shadows.size()));
      Observation by_turns = seen;
      for (const std::uint8_t id : all) by_turns = repaint(std::move(by_turns), {id}, Colour{9, 9, 9});
      EXPECT_EQ(by_turns.rgb, once.rgb) << scenario << " " << i;
    }
  }
}

TEST(Repaint, TheUsualBackgroundIsTheEmptyTable) {
  for (const char* scenario : {"heart", "bring_fruit"}) {
    Drawing drawing(scenario);
    std::vector<Demonstration> demonstrations(5);
    Observation empty;
    for (int i = 0; i < 5; ++i) {
      Scene scene = drawing.scene(i);
      demonstrations[static_cast<std::size_t>(i)].steps.push_back({drawing.of(scene, {}, true), {}});
      scene.objects.clear();
      empty = drawing.of(scene, {}, true);
    }
    const Background usual = usual_background(demonstrations);
    int off = 0;
    for (std::size_t i = 0; i < usual.rgb.size(); ++i) off += usual.rgb[i] != empty.rgb[i];
    EXPECT_LE(off, static_cast<int>(usual.rgb.size() / 500)) << scenario;
    EXPECT_EQ(most_frequent_colour(usual), most_frequent_colour({empty.rgb})) << scenario;
  }
}

TEST(Repaint, WithoutShadowsLeavesThem) {
  Drawing drawing("heart");
  const Observation seen = drawing.of(drawing.scene(0), {}, false);
  const Observation painted = repaint(seen, ids_to_paint(seen), Colour{1, 2, 3});
  for (std::size_t p = 0; p < seen.ids.size(); ++p)
    if (seen.ids[p] != seen.instances.front().id) {
      EXPECT_TRUE(std::equal(&seen.rgb[3 * p], &seen.rgb[3 * p] + 3, &painted.rgb[3 * p]));
    }
}

TEST(Repaint, AMissedInstanceLosesItsShadow) {
  Drawing drawing("heart");
  const Observation seen = drawing.of(drawing.scene(0), {}, true);
  const Observation less = imperfect_textualization(seen, drawing.scenario.space, {0, .5}, RandomStream("missed"));
  ASSERT_LT(less.instances.size(), seen.instances.size());
  ASSERT_FALSE(less.instances.empty());
  const auto bit_of = [](const Observation& of, std::uint8_t id) {
    const auto found =
        std::find_if(of.instances.begin(), of.instances.end(), [id](const Instance& i) { return i.id == id; });
    return found == of.instances.end() ? 0 : 1 << (found - of.instances.begin());
  };
  for (std::size_t p = 0; p < seen.ids.size(); ++p)
    for (const Instance& one : seen.instances) {
      const int before = bit_of(seen, one.id), after = bit_of(less, one.id);
      EXPECT_EQ(after != 0 && (less.shadows[p] & after) != 0, after != 0 && (seen.shadows[p] & before) != 0);
    }
}

TEST(Repaint, RefusesWhatDoesNotFit) {
  Drawing drawing("heart");
  const Observation seen = drawing.of(drawing.scene(0), {}, true);
  EXPECT_SAYS(message_of<InputError>([&] { repaint(seen, {1}, Background{{1, 2, 3}}); }), "background");
  Observation cut = seen;
  cut.shadows.pop_back();
  EXPECT_SAYS(message_of<InputError>([&] { repaint(cut, {1}, Colour{}); }),
              "expected rgb, ids and shadows of 128 x 256");
  EXPECT_SAYS(message_of<InputError>([&] { usual_background({}); }), "got none");
}

// Written with LGABENCH_WRITE_GOLDEN=1; tests/python/repaint_test.py holds Python's repaint() against them.
TEST(Repaint, BytesAreThoseThatPythonMakes) {
  const auto hash = [](const std::vector<std::uint8_t>& bytes) {
    return sha256(std::string(bytes.begin(), bytes.end()));
  };
  Json all = Json::array();
  for (const char* scenario : scenarios) {
    Drawing drawing(scenario);
    const Selection truth = drawing.scenario.commands.front().truth;
    for (int i = 0; i < 3; ++i) {
      const Observation seen = drawing.of(drawing.scene(i), {}, true);
      Ids which = unselected(seen, truth);
      which.push_back(0);
      const std::string name = fmt::format("golden/{}/{}", scenario, i);
      RandomStream noise(name + "/noise"), textures(name + "/textures");
      const Background usual = usual_background({{{}, {{seen, {}}}}});
      const Ids one = ids_to_paint(seen);
      all.push_back({{"scenario", scenario},
                     {"index", i},
                     {"which", which},
                     {"seen", hash(seen.rgb)},
                     {"table", most_frequent_colour(usual)},
                     {"usual", hash(usual.rgb)},
                     {"erased", hash(repaint(seen, one, usual).rgb)},
                     {"colour", hash(repaint(seen, one, Colour{1, 2, 3}).rgb)},
                     {"noise", hash(repaint(seen, which, Noise{noise}).rgb)},
                     {"noise_of_one", hash(repaint(seen, one, Noise{noise}).rgb)},
                     {"textures", hash(repaint(seen, which, RandomTextures{textures}).rgb)}});
    }
  }
  const fs::path file = fs::path(LGABENCH_TEST_GOLDEN) / "repaint.json";
  if (std::getenv("LGABENCH_WRITE_GOLDEN")) write_file(file, all.dump(1) + '\n');
  EXPECT_EQ(all, parse_json(read_file(file), file.string()));
}

}  // namespace
}  // namespace lgabench

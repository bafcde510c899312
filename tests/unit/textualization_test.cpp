// Imperfect textualization: how often it errs, and that the errors of more noise hold those of less.
#include <algorithm>
#include <cmath>
#include <set>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/abstraction/textualization.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

constexpr int count = 200;  // instances of an observation: more than a scene has, for the statistics

// Instance i has three pixels of its own, and a type and a texture of the space.
Observation many_objects(const FeatureSpace& space) {
  Observation o;
  o.size = {128, 256};
  o.rgb.assign(3 * o.size.pixels(), 77);
  o.ids.resize(o.size.pixels());
  for (std::size_t i = 0; i < count; ++i) {
    const auto id = static_cast<std::uint8_t>(count - i);
    o.instances.push_back(
        {id, space.object_types[i % space.object_types.size()], space.textures[i % space.textures.size()], 3});
    std::fill_n(o.ids.begin() + static_cast<std::ptrdiff_t>(5 * i), 3, id);
  }
  return o;
}

struct ImperfectTextualization : testing::Test {
  const FeatureSpace space = load_feature_space("tabletop");
  const Observation perfect = many_objects(space);

  Observation with(double label_noise, double missed_segment, const std::string& stream = "test") const {
    return imperfect_textualization(perfect, space, {label_noise, missed_segment}, RandomStream(stream));
  }
  const Instance& before(const Instance& instance) const {
    return perfect.instances[static_cast<std::size_t>(count - instance.id)];
  }
};

bool same(const Instance& a, const Instance& b) {
  return a.id == b.id && a.object_type == b.object_type && a.texture == b.texture && a.pixels == b.pixels;
}

bool same(const Observation& a, const Observation& b) {
  return a.rgb == b.rgb && a.ids == b.ids &&
         std::equal(a.instances.begin(), a.instances.end(), b.instances.begin(), b.instances.end(),
                    [](const Instance& x, const Instance& y) { return same(x, y); });
}

TEST_F(ImperfectTextualization, WithoutNoiseChangesNothing) { EXPECT_TRUE(same(with(0, 0), perfect)); }

TEST_F(ImperfectTextualization, IsAFunctionOfTheStream) {
  EXPECT_TRUE(same(with(.2, .1), with(.2, .1)));
  EXPECT_FALSE(same(with(.2, .1), with(.2, .1, "another")));
}

TEST_F(ImperfectTextualization, ErrsAsOftenAsItShould) {
  constexpr int repetitions = 100, all = repetitions * count;  // standard errors: .3 % and less
  int types = 0, textures = 0, both = 0, missed = 0;
  std::set<std::string> instead;
  for (int k = 0; k < repetitions; ++k) {
    for (const Instance& seen : with(.2, 0, std::to_string(k)).instances) {
      const bool type = seen.object_type != before(seen).object_type, texture = seen.texture != before(seen).texture;
      types += type;
      textures += texture;
      both += type && texture;
      if (type && before(seen).object_type == space.object_types.front()) instead.insert(seen.object_type);
    }
    missed += count - static_cast<int>(with(0, .1, std::to_string(k)).instances.size());
  }
  EXPECT_NEAR(types, .2 * all, .015 * all);
  EXPECT_NEAR(textures, .2 * all, .015 * all);
  EXPECT_NEAR(both, .04 * all, .01 * all) << "types and textures err independently";
  EXPECT_NEAR(missed, .1 * all, .015 * all);
  EXPECT_EQ(instead.size(), space.object_types.size() - 1) << "every other type is given, the own never";
}

TEST_F(ImperfectTextualization, AlwaysErrsWithProbabilityOne) {
  for (const Instance& seen : with(1, 0).instances) {
    EXPECT_NE(seen.object_type, before(seen).object_type);
    EXPECT_NE(seen.texture, before(seen).texture);
  }
  const Observation nothing = with(0, 1);
  EXPECT_TRUE(nothing.instances.empty());
  EXPECT_EQ(std::count(nothing.ids.begin(), nothing.ids.end(), 0), static_cast<std::ptrdiff_t>(nothing.ids.size()));
}

TEST_F(ImperfectTextualization, MoreNoiseKeepsTheErrorsOfLess) {
  Observation less = perfect;
  for (const double noise : {.05, .1, .2, .5}) {
    const Observation more = with(noise, 0);
    int added = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Instance &was = less.instances[i], &is = more.instances[i], &right = perfect.instances[i];
      if (was.object_type != right.object_type) {
        EXPECT_EQ(is.object_type, was.object_type);
      }
      if (was.texture != right.texture) {
        EXPECT_EQ(is.texture, was.texture);
      }
      added += !same(is, was);
    }
    EXPECT_GT(added, 0);
    less = more;
  }
  const Observation few = with(.3, .1), many = with(.3, .3);
  EXPECT_LT(many.instances.size(), few.instances.size());
  for (const Instance& seen : many.instances)  // what is still seen was seen, with the same labels
    EXPECT_TRUE(std::any_of(few.instances.begin(), few.instances.end(), [&](const auto& i) { return same(i, seen); }));
}

TEST_F(ImperfectTextualization, TheGoalMaskShowsWhatIsLeft) {
  Selection everything;
  everything.target = {space.object_types, space.textures};
  const Observation seen = with(.2, .3);
  EXPECT_EQ(seen.rgb, perfect.rgb);
  ASSERT_LT(seen.instances.size(), std::size_t{count});
  const auto mask = goal_mask(seen, everything);  // refuses an id that the table lacks
  EXPECT_EQ(std::count(mask.begin(), mask.end(), 1), static_cast<std::ptrdiff_t>(3 * seen.instances.size()));

  Selection one;
  one.target = {{space.object_types.front()}, space.textures};
  const auto all = with(.2, 0), right = perfect;
  EXPECT_NE(goal_mask(all, one), goal_mask(right, one)) << "a wrong type is not in the mask";
}

TEST_F(ImperfectTextualization, RefusesWhatIsNoProbability) {
  for (const double p : {-.1, 1.1, static_cast<double>(NAN)}) {
    EXPECT_SAYS(message_of<InputError>([&] { with(p, 0); }), "label_noise: expected a probability");
    EXPECT_SAYS(message_of<InputError>([&] { with(0, p); }), "missed_segment: expected a probability");
  }
}

TEST_F(ImperfectTextualization, ASpaceOfOneNameLeavesNoOtherToConfuseItWith) {
  const FeatureSpace one{"one", {"heart"}, {"red"}};
  Observation o;
  o.instances = {{4, "heart", "red", 0}};
  EXPECT_TRUE(same(imperfect_textualization(o, one, {1, 0}, RandomStream("x")).instances.front(), o.instances.front()));
}

}  // namespace
}  // namespace lgabench

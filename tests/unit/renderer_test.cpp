#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <common/objects.hpp>
#include <common/textures.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/hash.hpp>
#include <tabletop/renderer.hpp>
#include <tabletop/workspace.hpp>

namespace lgabench::tabletop {
namespace {

constexpr int rows = Workspace::rows, columns = Workspace::columns;
constexpr double pixel_m = 1.0 / 256;

std::size_t index(int row, int column) { return static_cast<std::size_t>(row * columns + column); }
// The pixel whose square holds the point.
std::size_t pixel_at(double x, double y) {
  return index(static_cast<int>(std::floor((x - 0.25) / pixel_m)), static_cast<int>(std::floor((y + 0.5) / pixel_m)));
}
Rgb colour(const Observation& seen, std::size_t pixel) {
  return {seen.rgb[3 * pixel], seen.rgb[3 * pixel + 1], seen.rgb[3 * pixel + 2]};
}

VisibleObject object(const std::string& type, const std::string& texture, Vec2 at, double yaw = 0, std::uint8_t id = 1,
                     double z = 0) {
  return {type, texture, {{at.x, at.y, z}, from_yaw(yaw)}, id};
}

// Three scenes that between them have overlaps of boxes, hollow bodies, free yaw, a tumbled and a stacked body.
std::vector<std::vector<VisibleObject>> scenes() {
  VisibleObject tumbled = object("shorter block", "tiger", {0.5, 0.05}, 0, 4, 0.035);
  tumbled.pose.rotation = Quat{std::sin(0.6), 0, 0, std::cos(0.6)} * from_yaw(0.3);
  return {{object("heart", "red swirl", {0.375, -0.36}, 0, 3), object("letter R", "brick", {0.625, -0.06}, 0, 1),
           object("pallet", "wooden", {0.5, 0.3}, 0, 2)},
          {object("bowl", "blue and purple stripe", {0.41, -0.31}, 2.1, 200),
           object("pan", "granite", {0.61, -0.22}, -0.7, 7), object("small block", "dark olive", {0.47, -0.2}, 0.4, 9)},
          {object("pallet", "wooden", {0.5, 0.3}, 0.2, 1), object("flower", "red paisley", {0.52, 0.28}, 1, 2, 0.035),
           object("ring", "magma", {0.4, 0.0}, 0, 3), tumbled}};
}

TEST(Renderer, IdsAreTheOutlinesAtPixelCentres) {
  Renderer renderer;
  for (const std::string& type : object_types())
    for (const double yaw : {0.0, 0.35, pi / 2, -2.6}) {
      const Vec2 at{0.5013, 0.0171};
      const Observation seen = renderer.render({object(type, "red", at, yaw, 9)});
      const std::vector<Polygon> outline = placed_outline(object_model(type), at, yaw);
      const auto covers = [](const Polygon& polygon, Vec2 p) {
        for (std::size_t i = 0; i < polygon.size(); ++i) {
          const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
          if ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) < 0) return false;
        }
        return true;
      };
      int covered = 0, wrong = 0;
      for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
          const Vec2 p{0.25 + (row + 0.5) * pixel_m, -0.5 + (column + 0.5) * pixel_m};
          const bool inside =
              std::any_of(outline.begin(), outline.end(), [&](const Polygon& part) { return covers(part, p); });
          covered += inside;
          wrong += seen.ids[index(row, column)] != (inside ? 9 : 0);
        }
      EXPECT_GT(covered, 40) << type;
      EXPECT_LE(wrong, covered / 1000) << type << " at yaw " << yaw;
    }
}

TEST(Renderer, BytesAreTheRecordedOnes) {
  // After a wanted change of shapes, textures or light: look at the pictures, then take the hashes this test prints.
  const std::vector<std::string> golden{"c559253a29baa42d", "509216739549e366", "a0202f162e054f65"};
  Renderer renderer;
  for (std::size_t i = 0; i < golden.size(); ++i) {
    const Observation seen = renderer.render(scenes()[i]);
    std::string bytes(seen.rgb.begin(), seen.rgb.end());
    bytes.append(seen.ids.begin(), seen.ids.end());
    EXPECT_EQ(hex(hash64(bytes)), golden[i]) << "scene " << i;
  }
}

TEST(Renderer, PicturesDoNotDependOnWhatWasDrawnBefore) {
  Renderer used;
  for (const auto& scene : scenes()) used.render(scene);
  for (const auto& scene : scenes()) {
    Renderer fresh;
    const Observation a = fresh.render(scene), b = used.render(scene);
    EXPECT_EQ(a.rgb, b.rgb);
    EXPECT_EQ(a.ids, b.ids);
  }
  const Observation empty = used.render({});
  EXPECT_EQ(std::count(empty.ids.begin(), empty.ids.end(), 0), rows * columns);
  for (std::size_t i = 0; i < empty.ids.size(); ++i) ASSERT_EQ(colour(empty, i), colour(empty, 0));
}

TEST(Renderer, TableListsVisiblePixelsInTheOrderGiven) {
  Renderer renderer;
  const Observation seen =
      renderer.render({object("pallet", "wooden", {0.5, 0.3}, 0, 40), object("block", "red", {0.5, 0.3}, 0, 3, 0.035),
                       object("star", "red", {0.5, 0.9}, 0, 17),          // outside
                       object("small block", "red", {0.5, 0.3}, 0, 5)});  // inside the pallet
  ASSERT_EQ(seen.instances.size(), 4u);
  const std::vector<int> ids{40, 3, 17, 5};
  for (std::size_t i = 0; i < ids.size(); ++i) {
    EXPECT_EQ(seen.instances[i].id, ids[i]);
    EXPECT_EQ(seen.instances[i].pixels, std::count(seen.ids.begin(), seen.ids.end(), ids[i]));
  }
  EXPECT_EQ(seen.instances[1].object_type, "block");
  EXPECT_EQ(seen.instances[0].texture, "wooden");
  EXPECT_GT(seen.instances[0].pixels, 1500);
  EXPECT_NEAR(seen.instances[1].pixels, 324, 36);  // 18 x 18, unhidden
  EXPECT_EQ(seen.instances[2].pixels, 0);
  EXPECT_EQ(seen.instances[3].pixels, 0);
}

TEST(Renderer, TheHigherObjectHidesTheLowerInAnyOrder) {
  Renderer renderer;
  std::vector<VisibleObject> stack = scenes()[2];
  const Observation seen = renderer.render(stack);
  EXPECT_EQ(seen.ids[pixel_at(0.52, 0.28)], 2);
  std::reverse(stack.begin(), stack.end());
  const Observation reversed = renderer.render(stack);
  EXPECT_EQ(seen.rgb, reversed.rgb);
  EXPECT_EQ(seen.ids, reversed.ids);
}

TEST(Renderer, AnObjectOnItsSideShowsItsSide) {
  Renderer renderer;
  VisibleObject block = object("shorter block", "red", {0.5, 0.0}, 0, 1, 0.035);  // .07 x .07 x .03
  const int flat = renderer.render({block}).instances[0].pixels;
  block.pose.rotation = {std::sin(pi / 4), 0, 0, std::cos(pi / 4)};  // a quarter turn about x: .03 along y
  const Observation side = renderer.render({block});
  EXPECT_NEAR(side.instances[0].pixels, flat * 3.0 / 7, 30);
}

TEST(Renderer, LightComesFromTheUpperLeft) {
  Renderer renderer;
  const Observation seen = renderer.render({object("block", "red", {0.5, 0.0})});  // .07 high: shadow .0315 by .042
  const Rgb table = colour(seen, 0);
  EXPECT_EQ(colour(seen, pixel_at(0.5, 0.0)), (Rgb{255, 87, 89}));  // a lit level surface: the colour as it is
  for (const Vec2 lit : {Vec2{0.46, 0.0}, Vec2{0.5, -0.04}, Vec2{0.573, 0.03}, Vec2{0.52, 0.083}, Vec2{0.46, 0.06}})
    EXPECT_EQ(colour(seen, pixel_at(lit.x, lit.y)), table) << lit.x << ' ' << lit.y;
  for (const Vec2 dark : {Vec2{0.545, 0.02}, Vec2{0.52, 0.05}, Vec2{0.56, 0.07}, Vec2{0.52, 0.073}, Vec2{0.563, 0.03}})
    EXPECT_LT(colour(seen, pixel_at(dark.x, dark.y))[0], 0.7 * table[0]) << dark.x << ' ' << dark.y;
}

TEST(Renderer, ShadowsFallOnObjectsToo) {
  Renderer renderer;
  const VisibleObject pallet = object("pallet", "red", {0.5, 0.2}, 0, 1);
  const Observation alone = renderer.render({pallet});
  const Observation both = renderer.render({pallet, object("block", "blue", {0.48, 0.18}, 0, 2, 0.035)});
  const std::size_t beside = pixel_at(0.53, 0.225), before = pixel_at(0.43, 0.13);
  EXPECT_EQ(both.ids[beside], 1);
  EXPECT_LT(colour(both, beside)[0], 0.7 * colour(alone, beside)[0]);
  EXPECT_EQ(colour(both, before), colour(alone, before));
  // Also on one that stands beside, below or to the right.
  for (const auto& [pallet_at, block_at, shaded] :
       {std::array{Vec2{0.545, 0.0}, Vec2{0.42, 0.0}, Vec2{0.463, 0.02}},
        std::array{Vec2{0.5, -0.0555}, Vec2{0.5, -0.2}, Vec2{0.52, -0.155}}}) {
    const VisibleObject low = object("pallet", "red", pallet_at, 0, 1);
    const Observation beside_it = renderer.render({low, object("block", "blue", block_at, 0, 2)});
    ASSERT_EQ(beside_it.ids[pixel_at(shaded.x, shaded.y)], 1);
    EXPECT_LT(colour(beside_it, pixel_at(shaded.x, shaded.y))[0],
              0.7 * colour(renderer.render({low}), pixel_at(shaded.x, shaded.y))[0]);
  }
  // Its own rim shades the hollow of a bowl on the side of the light, and not the other.
  const Observation bowl = renderer.render({object("bowl", "red", {0.5, 0.0})});
  EXPECT_LT(colour(bowl, pixel_at(0.47, -0.04))[0], 0.7 * colour(bowl, pixel_at(0.53, 0.04))[0]);
}

// In light from the lower right all is mirrored.
TEST(Renderer, InAnotherLightShadowsFallTheOtherWay) {
  Renderer renderer;
  View view;
  view.light = {.36, .48, .8};
  const auto lit = [&](const std::vector<VisibleObject>& objects) {
    return renderer.render(objects, Ground::plain, view);
  };
  const Observation seen = lit({object("block", "red", {0.5, 0.0})});
  const Rgb table = colour(seen, 0);
  EXPECT_EQ(colour(seen, pixel_at(0.5, 0.0)), (Rgb{255, 87, 89}));
  EXPECT_EQ(colour(seen, pixel_at(0.545, 0.02)), table);
  for (const Vec2 dark : {Vec2{0.455, -0.02}, Vec2{0.48, -0.05}, Vec2{0.437, -0.03}})
    EXPECT_LT(colour(seen, pixel_at(dark.x, dark.y))[0], 0.7 * table[0]) << dark.x << ' ' << dark.y;
  const VisibleObject low = object("pallet", "red", {0.455, 0.0});
  const Observation both = lit({low, object("block", "blue", {0.58, 0.0}, 0, 2)});
  const std::size_t shaded = pixel_at(0.537, -0.02);
  ASSERT_EQ(both.ids[shaded], 1);
  EXPECT_LT(colour(both, shaded)[0], 0.7 * colour(lit({low}), shaded)[0]) << "by a ray";
  const Observation bowl = lit({object("bowl", "red", {0.5, 0.0})});
  EXPECT_GT(colour(bowl, pixel_at(0.47, -0.04))[0], colour(bowl, pixel_at(0.53, 0.04))[0] / 0.7);
}

TEST(Renderer, AViewShowsWhatItsCameraSays) {
  Renderer renderer;
  const std::vector<VisibleObject> objects = scenes()[1];
  const Observation usual = renderer.render(objects);
  View half;  // counter-clockwise
  half.turn_rad = {pi, 0};
  std::vector<std::uint8_t> ids = renderer.render(objects, Ground::plain, half).ids;
  std::reverse(ids.begin(), ids.end());
  int differ = 0;
  for (std::size_t i = 0; i < ids.size(); ++i) differ += ids[i] != usual.ids[i];
  EXPECT_LE(differ, 3) << "borders through a pixel's centre";

  View shifted;  // to the right and down, by whole pixels
  shifted.shift_m = {5 * pixel_m, 3 * pixel_m};
  const Observation seen = renderer.render(objects, Ground::plain, shifted);
  for (int row = 0; row < rows - 3; ++row)
    for (int column = 0; column < columns - 5; ++column) {
      EXPECT_EQ(seen.ids[index(row, column)], usual.ids[index(row + 3, column + 5)]);
      EXPECT_EQ(colour(seen, index(row, column)), colour(usual, index(row + 3, column + 5)));
    }

  const auto block = [&](double zoom, double turn) {
    View view;
    view.zoom = zoom;
    view.turn_rad = {-turn, 0};
    return renderer.render({object("block", "red", {0.5, 0.1})}, Ground::plain, view);
  };
  EXPECT_NEAR(block(2, 0).instances[0].pixels, 4 * block(1, 0).instances[0].pixels, 60);
  EXPECT_EQ(block(2, 0).ids[index(64, 128 + 51)], 1) << "twice as far from the middle";
  EXPECT_EQ(block(1, pi / 2).ids[index(64 - 26, 128)], 1) << "a camera that turns clockwise: right becomes up";
}

TEST(Renderer, ATableHasATextureBelowItsZones) {
  Renderer renderer;
  View view;
  view.table = "checkerboard";
  const Observation usual = renderer.render({}, Ground::goal_zones),
                    seen = renderer.render({}, Ground::goal_zones, view);
  const std::size_t in_zone = pixel_at(.5, .41);
  EXPECT_EQ(colour(seen, in_zone), colour(usual, in_zone));
  std::vector<Rgb> colours;
  for (int column = 100; column < 156; ++column)
    if (const Rgb one = colour(seen, index(64, column)); std::count(colours.begin(), colours.end(), one) == 0)
      colours.push_back(one);
  EXPECT_EQ(colours.size(), 2u);
  view.table = "plaid";
  EXPECT_THROW(renderer.render({}, Ground::plain, view), InputError);
  EXPECT_EQ(renderer.render({}, Ground::goal_zones).rgb, usual.rgb);
}

TEST(Renderer, ATextureTurnsWithItsObject) {
  Renderer renderer;
  const Vec2 centre{0.25 + 64 * pixel_m, -0.5 + 128 * pixel_m};  // on a corner of four pixels, for exact quarter turns
  for (const std::string name : {"rainbow", "red paisley", "tiger"}) {
    const Observation straight = renderer.render({object("block", name, centre)});
    const Observation turned = renderer.render({object("block", name, centre, pi / 2)});
    int compared = 0;
    for (int i = -7; i < 7; ++i)
      for (int j = -7; j < 7; ++j) {
        // A quarter turn takes local x (down) to y (right), local y to -x.
        const Rgb here = colour(turned, index(64 + i, 128 + j)), was = colour(straight, index(64 + j, 128 - 1 - i));
        compared += here == was;
      }
    EXPECT_GE(compared, 14 * 14 - 4) << name;  // a texel's border may fall either way
    EXPECT_NE(colour(straight, index(60, 130)), colour(turned, index(60, 130))) << name;
  }
}

TEST(Renderer, BadObjectsAreRefused) {
  Renderer renderer;
  const Vec2 at{0.5, 0};
  EXPECT_THROW(renderer.render({object("unicorn", "red", at)}), InputError);
  EXPECT_THROW(renderer.render({object("block", "plaid", at)}), InputError);
  EXPECT_THROW(renderer.render({object("block", "red", at, 0, 0)}), InputError);
  EXPECT_THROW(renderer.render({object("block", "red", at, 0, 8), object("star", "red", at, 0, 8)}), InputError);
  EXPECT_THROW(renderer.render({object("block", "red", {std::numeric_limits<double>::quiet_NaN(), 0})}), InputError);
  EXPECT_EQ(renderer.render({object("block", "red", {1e30, -1e30})}).instances[0].pixels, 0);
}

TEST(VisibleObjects, RestOnTheTableAsTheSceneSays) {
  Scene scene;
  scene.task = "pick_and_place";
  scene.objects = {{"heart", "red", role::target, {0.4, -0.2}, 0.5, 3},
                   {"pallet", "wooden", role::goal, {0.5, 0.3}, 0, 1}};
  const std::vector<VisibleObject> objects = visible_objects(scene);
  ASSERT_EQ(objects.size(), 2u);
  EXPECT_EQ(objects[0].object_type, "heart");
  EXPECT_EQ(objects[0].texture, "red");
  EXPECT_EQ(objects[0].instance_id, 3);
  EXPECT_DOUBLE_EQ(objects[0].pose.position_m.x, 0.4);
  EXPECT_DOUBLE_EQ(objects[0].pose.position_m.y, -0.2);
  EXPECT_DOUBLE_EQ(objects[0].pose.position_m.z, 0);
  EXPECT_NEAR(yaw_of(objects[0].pose.rotation), 0.5, 1e-12);
  EXPECT_EQ(objects[1].instance_id, 1);
}

}  // namespace
}  // namespace lgabench::tabletop

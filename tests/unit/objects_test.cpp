// Every object type, lying and standing: its size, that pieces, mesh and outline are one shape, and that suction finds
// material.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>

#include <common/objects.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/feature_space.hpp>
#include <lgabench/core/random.hpp>

namespace lgabench::common {
namespace {

constexpr double tolerance = 1e-9;

Vec2 xy(Vec3 p) { return {p.x, p.y}; }

bool covers(const std::vector<Polygon>& outline, Vec2 p, double slack = 0) {
  return std::any_of(outline.begin(), outline.end(), [&](const Polygon& polygon) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2 edge = polygon[(i + 1) % polygon.size()] - polygon[i];
      if (cross(edge, p - polygon[i]) < -slack * norm(edge)) return false;
    }
    return true;
  });
}

bool is_convex(const Polygon& polygon) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()], c = polygon[(i + 2) % polygon.size()];
    if (cross(b - a, c - b) <= 0) return false;
  }
  return true;
}

// Height of the highest face over a point.
std::optional<double> top_at(const Mesh& mesh, Vec2 p) {
  std::optional<double> top;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices_m[t[0]], b = mesh.vertices_m[t[1]], c = mesh.vertices_m[t[2]];
    const double whole = cross(xy(b) - xy(a), xy(c) - xy(a));
    if (whole <= 1e-12) continue;
    const double u = cross(p - xy(a), xy(c) - xy(a)) / whole, v = cross(xy(b) - xy(a), p - xy(a)) / whole;
    if (u < -1e-9 || v < -1e-9 || u + v > 1 + 1e-9) continue;
    const double z = a.z + u * (b.z - a.z) + v * (c.z - a.z);
    top = std::max(top.value_or(z), z);
  }
  return top;
}

constexpr std::string_view standing = "standing ";

// Every type, and again as it stands where that is another shape.
std::vector<std::string> all_models() {
  std::vector<std::string> all = object_types();
  for (const std::string& type : object_types())
    if (&standing_model(type) != &object_model(type)) all.push_back(std::string(standing) + type);
  return all;
}

class Objects : public testing::TestWithParam<std::string> {
 protected:
  bool stands = GetParam().rfind(standing, 0) == 0;
  const ObjectModel& model = stands ? standing_model(GetParam().substr(standing.size())) : object_model(GetParam());
  // How far the shape reaches beyond its outline: only a straw does, above all that it could touch.
  double overhang_m = GetParam() == "standing juice box" ? .004 : 0;
};

TEST_P(Objects, PiecesAreConvexAndInsideTheOutline) {
  ASSERT_FALSE(model.body.pieces.empty());
  EXPECT_LE(model.body.pieces.size(), 18u);
  for (const ConvexPiece& piece : model.body.pieces) {
    // Bottom corners, then as many top corners, edge parallel to edge: all faces are flat.
    const std::size_t n = piece.corners_m.size() / 2;
    ASSERT_EQ(piece.corners_m.size(), 2 * n);
    Polygon bottom, top;
    for (std::size_t i = 0; i < n; ++i) {
      bottom.push_back(xy(piece.corners_m[i]));
      top.push_back(xy(piece.corners_m[n + i]));
      EXPECT_EQ(piece.corners_m[i].z, piece.corners_m[0].z);
      EXPECT_EQ(piece.corners_m[n + i].z, piece.corners_m[n].z);
    }
    EXPECT_LT(piece.corners_m[0].z, piece.corners_m[n].z);
    EXPECT_TRUE(is_convex(bottom));
    EXPECT_TRUE(is_convex(top));
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR(cross(bottom[(i + 1) % n] - bottom[i], top[(i + 1) % n] - top[i]), 0, tolerance);
      for (const Polygon& polygon : {bottom, top})
        for (const double t : {0., .25, .5, .75})
          EXPECT_TRUE(covers(model.outline, (1 - t) * polygon[i] + t * polygon[(i + 1) % n], overhang_m + tolerance));
    }
  }
}

TEST_P(Objects, MeshIsClosedAndTheSameShapeAsThePieces) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double volume = 0;
  for (const auto& t : model.mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    const Vec3 a = model.mesh.vertices_m[t[0]], b = model.mesh.vertices_m[t[1]], c = model.mesh.vertices_m[t[2]];
    volume += (a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x)) / 6;
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  EXPECT_GT(volume, 0);  // faces look outwards

  const auto points = [](const std::vector<Vec3>& all) {
    std::set<std::tuple<double, double, double>> set;
    for (const Vec3 p : all) set.insert({p.x, p.y, p.z});
    return set;
  };
  std::vector<Vec3> corners;
  for (const auto& piece : model.body.pieces)
    corners.insert(corners.end(), piece.corners_m.begin(), piece.corners_m.end());
  EXPECT_EQ(points(model.mesh.vertices_m), points(corners));
}

TEST_P(Objects, OutlineIsTheMeshSeenFromAbove) {
  for (const Polygon& polygon : model.outline) EXPECT_TRUE(is_convex(polygon));
  RandomStream random("outline/" + model.type);
  for (int i = 0; i < 3000; ++i) {
    const Vec2 p{random.uniform(-.13, .13), random.uniform(-.13, .13)};
    const bool seen = top_at(model.mesh, p).has_value();
    EXPECT_TRUE(!seen || covers(model.outline, p, overhang_m + 1e-6)) << p.x << ' ' << p.y;
    EXPECT_TRUE(seen || !covers(model.outline, p, -1e-6)) << p.x << ' ' << p.y;
  }
}

TEST_P(Objects, StandsOnTheTableWithItsBoxCentred) {
  double low = 1, high = -1, radius = 0;
  Vec2 least, most;
  for (const Vec3 p : model.mesh.vertices_m) {
    low = std::min(low, p.z), high = std::max(high, p.z);
    least = {std::min(least.x, p.x), std::min(least.y, p.y)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y)};
    radius = std::max(radius, norm(xy(p)));
  }
  EXPECT_EQ(low, 0);
  EXPECT_EQ(high, model.height_m);
  EXPECT_NEAR(radius, model.radius_m, tolerance);
  EXPECT_NEAR(least.x + most.x, 0, tolerance);
  EXPECT_NEAR(least.y + most.y, 0, overhang_m + tolerance);
  EXPECT_NEAR(most.x - least.x, model.size_m.x, tolerance);
  EXPECT_NEAR(most.y - least.y, model.size_m.y, overhang_m + tolerance);
  EXPECT_GE(model.body.mass_kg, .02);
  EXPECT_LE(model.body.mass_kg, .3);
}

TEST_P(Objects, SuctionFindsFlatMaterial) {
  const auto height = top_at(model.mesh, model.grasp_m);
  ASSERT_TRUE(height);
  for (int i = 0; i < 64; ++i) {
    const Vec2 p = model.grasp_m + rotated({.01, 0}, i * .0981747704246810387);
    EXPECT_TRUE(covers(model.outline, p)) << p.x << ' ' << p.y;
    ASSERT_TRUE(top_at(model.mesh, p));
    EXPECT_NEAR(*top_at(model.mesh, p), *height, tolerance);  // clear of walls
  }
}

INSTANTIATE_TEST_SUITE_P(All, Objects, testing::ValuesIn(all_models()), [](const auto& instance) {
  std::string name = instance.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
});

TEST(ObjectTypes, AreTheFeatureSpaces) {
  const FeatureSpace tabletop = load_feature_space("tabletop"), household = load_feature_space("household");
  EXPECT_EQ(object_types(), household.object_types);
  const auto& all = household.object_types;
  ASSERT_EQ(all.size(), tabletop.object_types.size() + 20);
  EXPECT_TRUE(std::equal(tabletop.object_types.begin(), tabletop.object_types.end(), all.begin()));
  EXPECT_EQ(household.textures, tabletop.textures);
}

TEST(ObjectTypes, UnknownOneIsRefused) {
  EXPECT_THROW(object_model("teapot"), InputError);
  EXPECT_THROW(standing_model("teapot"), InputError);
}

TEST(ObjectTypes, BottlesCansAndBoxesStand) {
  std::set<std::string> upright;
  for (const std::string& type : object_types()) {
    const ObjectModel &lies = object_model(type), &stands = standing_model(type);
    if (&stands == &lies) continue;
    upright.insert(type);
    EXPECT_EQ(stands.type, type);
    EXPECT_GT(stands.height_m, std::max(stands.size_m.x, stands.size_m.y)) << type;
    EXPECT_LT(lies.height_m, std::max(lies.size_m.x, lies.size_m.y)) << type;
  }
  EXPECT_EQ(upright, (std::set<std::string>{"juice box", "soda can", "water bottle"}));
}

// docs/gallery.md; x is up and down in the picture, y left and right.
TEST(ObjectTypes, HaveTheProtocolsSizes) {
  const auto expect = [](const std::string& type, double x, double y, std::optional<double> height) {
    const ObjectModel& model = object_model(type);
    EXPECT_NEAR(model.size_m.x, x, 1e-9) << type;
    EXPECT_NEAR(model.size_m.y, y, 1e-9) << type;
    EXPECT_NEAR(model.height_m, height.value_or(model.height_m), 1e-12) << type;
  };
  expect("bowl", .17, .17, {});
  expect("block", .07, .07, .07);
  expect("shorter block", .07, .07, .03);
  expect("small block", .03, .03, .03);
  expect("L-shaped block", .128, .128, {});
  expect("pallet", .175, .21, .035);
  expect("frame", .225, .225, {});
  expect("container", .16, .16, .05);
  expect("three-sided rectangle", .2, .2, {});
  expect("line", .04, .25, .001);
  expect("square", .2, .2, .001);
  expect("pan", .16, .24, .03);
  expect("fork", .03, .18, .01);
  expect("spoon", .03, .18, .01);
  const FeatureSpace household = load_feature_space("household");
  for (std::size_t i = load_feature_space("tabletop").object_types.size(); i < household.object_types.size(); ++i) {
    const ObjectModel& model = object_model(household.object_types[i]);
    if (model.type == "fork" || model.type == "spoon") continue;
    EXPECT_LE(std::max(model.size_m.x, model.size_m.y), .1601) << model.type;
    EXPECT_GE(std::max(model.size_m.x, model.size_m.y), .07) << model.type;
  }
  for (const char* letter : {"A", "E", "G", "M", "R", "T", "V"})
    expect(std::string("letter ") + letter, .144, .144, .036);
  for (const auto& [type, size] : std::map<std::string, double>{{"heart", .144},
                                                                {"cross", .128},
                                                                {"diamond", .128},
                                                                {"triangle", .128},
                                                                {"ring", .128},
                                                                {"round", .128},
                                                                {"flower", .144},
                                                                {"hexagon", .144},
                                                                {"pentagon", .144},
                                                                {"star", .144}})
    EXPECT_NEAR(std::max(object_model(type).size_m.x, object_model(type).size_m.y), size, 1e-9) << type;
}

// Probes (right, up) that are material or not; each list fails for the letter upside down or mirrored.
TEST(ObjectTypes, LettersReadUpright) {
  struct Probe {
    const char* type;
    std::vector<Vec2> material, empty;
  };
  const std::vector<Probe> probes{
      {"letter A",
       {{0, .065}, {-.058, -.065}, {.058, -.065}, {0, -.026}},
       {{-.05, .06}, {.05, .06}, {0, -.06}, {0, 0}}},
      {"letter E", {{-.06, .03}, {.06, .06}, {.05, 0}, {.06, -.06}}, {{.03, .028}, {.03, -.028}, {.068, 0}}},
      {"letter G", {{-.057, 0}, {.04, -.011}, {0, -.06}, {0, .06}}, {{.06, .02}, {.02, .02}, {-.02, -.01}, {0, 0}}},
      {"letter M", {{-.06, -.065}, {.06, -.065}, {0, -.02}, {-.06, .065}}, {{0, .05}, {0, -.06}, {-.03, -.05}}},
      {"letter R",
       {{-.06, -.06}, {.05, -.06}, {.06, .03}, {0, .06}, {0, .002}},
       {{0, .03}, {-.02, -.05}, {.065, -.02}}},
      {"letter T", {{-.065, .06}, {.065, .06}, {0, -.06}}, {{-.065, -.06}, {.065, -.06}, {.04, 0}}},
      {"letter V", {{-.06, .065}, {.06, .065}, {0, -.06}}, {{0, .03}, {-.06, -.06}, {.06, -.06}}},
      {"heart", {{-.04, .04}, {.04, .04}, {0, -.055}}, {{0, .063}, {-.04, -.05}, {.04, -.05}}},
      {"pan", {{.11, 0}, {-.11, 0}}, {{.11, .05}, {.11, -.05}}},
      {"L-shaped block", {{-.05, .06}, {.06, -.05}}, {{.05, .05}}},
      {"three-sided rectangle", {{-.09, .09}, {.09, .09}, {0, -.09}}, {{0, .09}, {0, 0}}},
      {"triangle", {{0, .05}, {.06, -.054}}, {{.06, .05}}},
      {"pallet", {{.1, .08}}, {{.08, .1}}},
      {"banana", {{0, -.01}, {.065, .015}, {-.065, .015}}, {{0, .015}}},
      {"fork", {{.085, .012}, {.085, 0}, {.085, -.012}, {-.085, 0}}, {{.085, .006}, {.085, -.006}, {-.05, .012}}},
      {"mug", {{.057, 0}}, {{.057, .02}, {-.055, .035}}},
      {"water bottle", {{-.05, .028}, {.05, 0}}, {{.05, .028}}},
      {"drill", {{.075, .047}, {-.06, -.06}}, {{.075, -.06}}},
  };
  for (const Probe& probe : probes) {
    const auto& mesh = object_model(probe.type).mesh;
    const auto seen = [&](Vec2 p) { return top_at(mesh, {-p.y, p.x}).has_value(); };
    for (const Vec2 p : probe.material) EXPECT_TRUE(seen(p)) << probe.type << ' ' << p.x << ' ' << p.y;
    for (const Vec2 p : probe.empty) EXPECT_FALSE(seen(p)) << probe.type << ' ' << p.x << ' ' << p.y;
  }
}

TEST(ObjectTypes, HollowOnesAreHollow) {
  for (const char* type : {"bowl", "container", "mug", "pan", "plate"}) {
    const ObjectModel& model = object_model(type);
    EXPECT_LT(*top_at(model.mesh, model.grasp_m), .31 * model.height_m) << type;
  }
  for (const char* type : {"frame", "ring", "square"}) EXPECT_FALSE(top_at(object_model(type).mesh, {})) << type;
}

const Polygon unit{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

TEST(Outline, DistanceOfSquares) {
  const auto at = [](double x, double y, double yaw = 0) { return placed({unit}, {x, y}, yaw); };
  EXPECT_DOUBLE_EQ(distance(at(0, 0), at(1.5, 0)), .5);           // edge to edge
  EXPECT_DOUBLE_EQ(distance(at(0, 0), at(4, 5)), 5);              // corner to corner
  EXPECT_NEAR(distance(at(0, 0), at(2, .5, -pi / 4)), 1, 1e-12);  // edge to corner
  EXPECT_EQ(distance(at(0, 0), at(.5, .5)), 0);
  EXPECT_EQ(distance(at(0, 0), placed({unit}, {.5, -.2}, pi / 4)), 0);       // crossing, no corner inside
  EXPECT_EQ(distance({{{-9, -9}, {9, -9}, {9, 9}, {-9, 9}}}, at(0, 0)), 0);  // one inside the other
}

TEST(Outline, DistanceOfUnionsIsTheNearestPairs) {
  RandomStream random("pairs");
  for (int i = 0; i < 300; ++i) {
    const auto& a = object_model("letter G").outline;
    const auto b =
        placed(object_model("ring").outline, {random.uniform(-.2, .2), random.uniform(-.2, .2)}, random.uniform(-3, 3));
    double nearest = 1;
    for (const Polygon& p : a)
      for (const Polygon& q : b) nearest = std::min(nearest, distance({p}, {q}));
    EXPECT_DOUBLE_EQ(distance(a, b), nearest);
    EXPECT_NEAR(distance(b, a), nearest, 1e-12);
  }
}

TEST(Outline, HullAreaContains) {
  Polygon points = unit;
  points.insert(points.end(), {{.5, .5}, {.5, 0}, {1, .3}});
  const Polygon hull = convex_hull(points);
  EXPECT_EQ(hull.size(), 4u);
  EXPECT_DOUBLE_EQ(area(hull), 1);
  EXPECT_TRUE(contains(hull, {1, .5}));
  EXPECT_FALSE(contains(hull, {1.001, .5}));
}

}  // namespace
}  // namespace lgabench::common

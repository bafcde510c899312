// Axes that change how a scene is looked at, in both environments, and what that does to the oracle.
#include <algorithm>
#include <cmath>
#include <map>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/evaluator.hpp>
#include <lgabench/cell/reference_actor.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/perturbations.hpp>
#include <tabletop/two_poses.hpp>

#include "../engine_under_test.hpp"
#include "testing.hpp"

namespace lgabench {
namespace {

using tabletop::TwoPoses;

constexpr int scenes = 6, levels = 4;
const char* const moving[] = {"camera_shift", "camera_turn", "field_of_view"};

// Test scene of the first arm, the control.
Scene control(const Scenario& scenario, int index) {
  return test_scene(scenario, layouts_of(scenario).front(), scenario.tests.front().id, 0, index);
}

// A scenario whose first arm is also played along that axis.
Scenario perturbed(const std::string& id, const std::string& axis) {
  Json json = load_scenario(id).json;
  for (int level = 1; level <= levels; ++level) {
    json["tests"].push_back(json["tests"].front());
    json["tests"].back().update({{"arm", arm_of({axis, level})}, {"perturbation", {{axis, level}}}});
  }
  return read_scenario(json, "perturbed.json");
}

View view_at(const Scenario& scenario, const std::string& axis, int level, int index) {
  if (level == 0) return {};
  Scene scene = control(scenario, index);
  scene.arm = arm_of({axis, level});
  return view_of(scenario, scene);
}

struct Segment {
  Vec2 centre;  // row, column
  int pixels = 0;
};

std::map<int, Segment> segments(const Observation& seen) {
  std::map<int, Segment> all;
  for (int i = 0; i < static_cast<int>(seen.ids.size()); ++i)
    if (const int id = seen.ids[static_cast<std::size_t>(i)]) {
      Segment& one = all[id];
      const int row = i / seen.size.columns, column = i % seen.size.columns;
      one.centre = one.centre + Vec2{1. * row, 1. * column};
      ++one.pixels;
    }
  for (auto& [id, one] : all) one.centre = 1. / one.pixels * one.centre;
  return all;
}

// How far what is seen moved, where nearly all of it is still seen, in the control's order.
std::map<int, Vec2> moved(const Observation& from, const Observation& to) {
  std::map<int, Vec2> all;
  const auto before = segments(from);
  for (const auto& [id, one] : segments(to))
    if (one.pixels > .9 * before.at(id).pixels / 1.44) all[id] = one.centre - before.at(id).centre;
  return all;
}

double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

TEST(Views, WhatIsSeenMovesTheSameWayAtEveryLevelAndFartherAtEachNext) {
  for (const char* id : {"heart", "bring_fruit"})
    for (const char* axis : moving) {
      const Scenario scenario = perturbed(id, axis);
      const EnvironmentType& environment = *scenario.environment;
      for (int i = 0; i < scenes; ++i) {
        SCOPED_TRACE(fmt::format("{} {} {}", id, axis, i));
        const Scene scene = control(scenario, i);
        const Observation usual = environment.draw(scene);
        const auto farthest = moved(usual, environment.draw(scene, view_at(scenario, axis, levels, i)));
        ASSERT_FALSE(farthest.empty());
        double before = 0;
        for (int level = 1; level <= levels; ++level) {
          const auto now = moved(usual, environment.draw(scene, view_at(scenario, axis, level, i)));
          double sum = 0, along = 0;
          for (const auto& [object, way] : farthest) {
            sum += norm(way);
            along += dot(now.at(object), way) / norm(way);
          }
          EXPECT_GT(along, 1.3 * before) << level;
          if (level == levels) {
            EXPECT_NEAR(along, sum, 1e-9);
          }
          before = along;
        }
      }
    }
}

TEST(Views, ATopViewIsShiftedByTheLevelsCentimetres) {
  const Scenario scenario = perturbed("heart", "camera_shift");
  const EnvironmentType& environment = find_environment("tabletop");
  for (int level = 1; level <= levels; ++level) {
    const double pixels = 256 * std::array{.01, .025, .05, .1}.at(static_cast<std::size_t>(level - 1));
    for (int i = 0; i < scenes; ++i) {
      const Scene scene = control(scenario, i);
      const Observation usual = environment.draw(scene),
                        seen = environment.draw(scene, view_at(scenario, "camera_shift", level, i));
      const auto before = segments(usual);
      for (const auto& [id, one] : segments(seen))
        if (std::abs(one.pixels - before.at(id).pixels) < .02 * one.pixels) {
          EXPECT_NEAR(norm(one.centre - before.at(id).centre), pixels, .5);
        }
    }
  }
}

TEST(Views, LightTurnsByTheLevelInOnePlaneAndStaysAboveTheTable) {
  constexpr double degree = pi / 180;
  const Scenario scenario = perturbed("heart", "light_direction");
  double lowest = 1;
  for (int i = 0; i < 50; ++i) {
    const Vec3 last = view_at(scenario, "light_direction", levels, i).light;
    for (int level = 1; level <= levels; ++level) {
      const Vec3 light = view_at(scenario, "light_direction", level, i).light;
      EXPECT_NEAR(std::acos(dot(light, usual_light)), level * 15 * degree, 1e-9);
      EXPECT_NEAR(std::acos(std::min(1., dot(light, last))), (levels - level) * 15 * degree, 1e-7);
      EXPECT_GE(light.z, std::sin(25 * degree) - 1e-12);
      lowest = std::min(lowest, light.z);
    }
  }
  EXPECT_LT(lowest, std::sin(40 * degree)) << "and comes near to it";
}

TEST(Views, ATableLooksLikeNoObjectButAtTheLastLevel) {
  for (const char* id : {"tiger_colored_object", "fetch_fruit"}) {
    const Scenario scenario = perturbed(id, "table");
    for (int i = 0; i < scenes; ++i) {
      const Scene scene = control(scenario, i);
      const auto stands = [&scene](const std::string& texture) {
        return std::any_of(scene.objects.begin(), scene.objects.end(),
                           [&](const SceneObject& o) { return o.texture.find(texture) != std::string::npos; });
      };
      const auto table = [&](int level) { return view_at(scenario, "table", level, i).table; };
      EXPECT_FALSE(stands(table(1))) << table(1);
      EXPECT_TRUE(!stands(table(2)) || (stands("wooden") && stands("granite"))) << table(2);
      EXPECT_FALSE(stands(table(3))) << table(3);
      EXPECT_TRUE(stands(table(4))) << table(4);
    }
  }
}

TEST(Views, LightAndTableLeaveEveryIdWhereItIs) {
  for (const char* id : {"heart", "sweep_block_without_touching_line", "bring_fruit"})
    for (const char* axis : {"light_direction", "table"}) {
      const Scenario scenario = perturbed(id, axis);
      const EnvironmentType& environment = *scenario.environment;
      for (int level = 1; level <= levels; ++level) {
        const Scene scene = control(scenario, level);
        const Observation usual = environment.draw(scene),
                          seen = environment.draw(scene, view_at(scenario, axis, level, level));
        EXPECT_EQ(usual.ids, seen.ids);
        EXPECT_NE(usual.rgb, seen.rgb) << axis << " " << level;
        EXPECT_EQ(environment.draw(scene).rgb, usual.rgb) << "and the usual view is as before";
      }
    }
}

// Played by the oracle, at each level from 0.
std::vector<std::vector<Episode>> oracles(const std::string& id, const std::string& axis) {
  const Scenario scenario = perturbed(id, axis);
  const auto environment = make_environment(scenario, make_engine());
  std::vector<std::vector<Episode>> all;
  for (int level = 0; level <= levels; ++level) {
    std::vector<TestScene> tests;
    for (int i = 0; i < scenes; ++i)
      tests.push_back({control(scenario, i), nullptr, false, view_at(scenario, axis, level, i)});
    all.push_back(evaluate(*environment, tests, reference_actor("oracle"), [](int) {}));
  }
  return all;
}

int won_by(const std::vector<Episode>& episodes) {
  return static_cast<int>(
      std::count_if(episodes.begin(), episodes.end(), [](const Episode& e) { return e.success(); }));
}

TEST(Views, TheOracleIsLedAstrayAsFarAsThePictureMoves) {
  for (const char* id : {"heart", "bring_fruit"})
    for (const char* axis : moving) {
      const auto played = oracles(id, axis);
      EXPECT_EQ(won_by(played.front()), scenes) << id;
      EXPECT_LT(won_by(played.back()), scenes) << id << " " << axis;
      if (axis == moving[0]) {
        EXPECT_EQ(won_by(played.back()), 0) << id;
      }
    }
  // By the shift itself, in its grasp and where it lets go.
  const Scenario scenario = perturbed("heart", "camera_shift");
  const auto played = oracles("heart", "camera_shift");
  for (int level = 1; level <= levels; ++level)
    for (std::size_t i = 0; i < scenes; ++i) {
      const Vec2 shift = view_at(scenario, "camera_shift", level, static_cast<int>(i)).shift_m;
      const TwoPoses right = played[0][i].action, moved = played[static_cast<std::size_t>(level)][i].action;
      for (const auto pose : {&TwoPoses::pose0, &TwoPoses::pose1}) {
        EXPECT_NEAR((moved.*pose).position_m.x, (right.*pose).position_m.x - shift.y, 1e-6);
        EXPECT_NEAR((moved.*pose).position_m.y, (right.*pose).position_m.y - shift.x, 1e-6);
      }
    }
}

TEST(Views, WhereNothingMovesTheOracleActsAsEver) {
  for (const char* axis : {"light_direction", "table"})
    for (const char* id : {"heart", "bring_fruit"}) {
      const auto played = oracles(id, axis);
      for (int level = 1; level <= levels; ++level)
        for (std::size_t i = 0; i < scenes; ++i)
          EXPECT_EQ(played[static_cast<std::size_t>(level)][i].action, played[0][i].action) << axis << " " << id;
    }
}

// In perspective the oracle names a pixel of the target in the picture that it is shown.
TEST(Views, AMobileOraclesGraspLiesOnTheTargetInItsPicture) {
  const Scenario scenario = perturbed("bring_fruit", "camera_turn");
  const auto environment = make_environment(scenario, make_engine());
  for (int i = 0; i < scenes; ++i) {
    const Scene scene = control(scenario, i);
    const Observation usual = environment->reset(scene);
    const Action right = environment->expert_action();
    const Observation seen = environment->look(view_at(scenario, "camera_turn", 3, i));
    const Action led = environment->expert_action();
    const auto at = [&](const Observation& picture, const Action& action) {
      const int row = static_cast<int>(action[1] * picture.size.rows),
                column = static_cast<int>(action[0] * picture.size.columns);
      return picture.ids[static_cast<std::size_t>(row * picture.size.columns + column)];
    };
    const std::uint8_t target = scene.find(role::target)->instance_id;
    EXPECT_EQ(at(usual, right), target);
    EXPECT_EQ(at(seen, led), target);
    EXPECT_NE(led, right);
    EXPECT_EQ(environment->observe().ids, seen.ids) << "until the next reset()";
    EXPECT_EQ(environment->reset(scene).rgb, usual.rgb);
    EXPECT_EQ(environment->observe().rgb, usual.rgb);
    EXPECT_EQ(environment->expert_action(), right);
  }
}

TEST(Views, AFailureInAMovedPictureIsPerceptionsWhereThePolicySucceedsInTheUsualOne) {
  const Scenario scenario = perturbed("heart", "camera_shift");
  const auto environment = make_environment(scenario, make_engine());
  std::vector<TestScene> tests;
  for (int i = 0; i < 2; ++i)
    tests.push_back({control(scenario, i), nullptr, false, view_at(scenario, "camera_shift", levels, i)});
  const Actor oracle = reference_actor("oracle");
  std::vector<Episode> episodes = evaluate(*environment, tests, oracle, [](int) {});
  attribute_failures(*environment, tests, oracle, {}, episodes);
  for (const Episode& episode : episodes) EXPECT_EQ(episode.attribution, "perception");
}

TEST(Views, AnEnvironmentWithOneViewRefusesWhatMovesIt) {
  const Json json{{"camera_turn", 2}}, blur{{"sensor_noise", 2}}, all{{"all", 1}};
  const auto expect = [](const Json& perturbation, const char* environment, bool has_views) {
    expect_shown(JsonReader(perturbation, "mine.json", "/tests/1/perturbation"), axes_named(perturbation.begin().key()),
                 environment, has_views);
  };
  const auto refusal = [&expect](const Json& perturbation) {
    return message_of<InputError>([&] { expect(perturbation, "flat", false); });
  };
  EXPECT_SAYS(refusal(json),
              "mine.json: /tests/1/perturbation: expected an axis that keeps the view (camera_turn changes "
              "it): environment flat has only one");
  EXPECT_SAYS(refusal(all), "(light_direction changes it)");
  EXPECT_NO_THROW(expect(blur, "flat", false));
  EXPECT_NO_THROW(expect(json, "tabletop", true));
}

}  // namespace
}  // namespace lgabench

// The task fetch: what its scenes promise, and what a plan leads to.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include <lgabench/core/hash.hpp>
#include <lgabench/harness/suite.hpp>
#include <lgabench/harness/suite_scenario.hpp>
#include <mobile/fetch.hpp>
#include <mobile/mobile.hpp>
#include <mobile/near_misses.hpp>
#include <mobile/plan.hpp>
#include <mobile/receivers.hpp>
#include <mobile/renderer.hpp>
#include <mobile/sampler.hpp>

#include "../engine_under_test.hpp"
#include "testing.hpp"

namespace lgabench::mobile {
namespace {

const Suite& suite() {
  static const Suite loaded = load_suite("fetch");
  return loaded;
}

Scenario scenario_of(const std::string& id) { return suite_scenario(suite(), id, Truth::released); }

Scene scene_of(const Scenario& scenario, const std::string& arm, int index) {
  return sample_fetch(scenario, {layout, arm == "train" ? "train" : "test", arm, 7}, index);
}

// As of the other scenarios (mobile_scenes_test.cpp): training scenes, and those of the suite's arm with near misses.
TEST(FetchScenes, AreThoseRecorded) {
  const std::map<std::string, std::string> recorded{
      {"fetch_cleaner", "85356af001e1d0a3"},     {"fetch_cutlery", "482e498f3348a750"},
      {"fetch_dirty_plate", "f7b6844fb45b3981"}, {"fetch_drink", "b68fdd8c8c016b03"},
      {"fetch_fruit", "7334262509524422"},       {"fetch_ripe_fruit", "148922cd26665768"},
      {"fetch_unripe_fruit", "28f6938fe4847424"}};
  for (const std::string& id : suite().design.scenarios) {
    const Scenario scenario = scenario_of(id);
    std::string all;
    for (const char* arm : {"train", "near"})
      for (int i = 0; i < 15; ++i) all += hex(scene_of(scenario, arm, i).hash());
    EXPECT_EQ(sha256(all).substr(0, 16), recorded.at(id)) << id;
  }
}

std::vector<SceneObject> some(const Scene& scene, bool receivers) {
  std::vector<SceneObject> all;
  std::copy_if(scene.objects.begin(), scene.objects.end(), std::back_inserter(all),
               [receivers](const SceneObject& o) { return is_receiver(o.object_type) == receivers; });
  return all;
}

TEST(FetchScenes, HoldOneRightObjectAndOneRightReceiver) {
  for (const std::string& id : suite().design.scenarios) {
    const Scenario scenario = scenario_of(id);
    const Selection& truth = scenario.commands[0].truth;
    for (const auto& [arm, others] : {std::pair("train", 1), {"few", 2}, {"many", 7}, {"near", 7}})
      for (int i = 0; i < 15; ++i) {
        const Scene scene = scene_of(scenario, arm, i);
        const auto objects = some(scene, false), receivers = some(scene, true);
        ASSERT_EQ(objects.size(), static_cast<std::size_t>(others) + 1) << id << " " << arm;
        ASSERT_EQ(receivers.size(), 3u);
        int right = 0, right_receivers = 0;
        for (const SceneObject& o : objects) {
          right += o.role == role::target;
          EXPECT_EQ(truth.target.belongs(o.object_type, o.texture), o.role == role::target);
          EXPECT_TRUE(fetch_zone.contains(o.position_m));
          const auto& natural = natural_objects();
          EXPECT_NE(std::find(natural.begin(), natural.end(), Features{o.object_type, o.texture}), natural.end());
        }
        for (const SceneObject& o : receivers) {
          right_receivers += o.role == receiver;
          EXPECT_EQ(truth.second->contains(o.object_type, o.texture), o.role == receiver);
          EXPECT_NE(std::find_if(stations.begin(), stations.end(),
                                 [&](Vec2 station) { return norm(station - o.position_m) == 0; }),
                    stations.end());
        }
        EXPECT_EQ(right, 1);
        EXPECT_EQ(right_receivers, 1);
      }
  }
}

TEST(FetchScenes, ShowEverythingWhollyAndMostOfTheTarget) {
  const Camera& camera = front_camera();
  Renderer renderer(camera);
  for (const std::string& id : suite().design.scenarios)
    for (int i = 0; i < 10; ++i) {
      const Scene scene = scene_of(scenario_of(id), "near", i);
      const auto objects = visible_objects(scene);
      for (const VisibleObject& o : objects)
        for (const Vec3& v : model_of(o.object_type).mesh.vertices_m) {
          const Vec2 at = camera.at(o.pose.position_m + rotated(v, o.pose.rotation));
          EXPECT_TRUE(at.x > 0 && at.x < camera.size.rows - 1 && at.y > 0 && at.y < camera.size.columns - 1)
              << o.object_type << " " << at.x << " " << at.y;
        }
      const std::uint8_t target = scene.find(role::target)->instance_id;
      const auto pixels = [&](const std::vector<VisibleObject>& shown) {
        const auto seen = renderer.ids(shown);
        return static_cast<double>(std::count(seen.begin(), seen.end(), target));
      };
      std::vector<VisibleObject> alone;
      std::copy_if(objects.begin(), objects.end(), std::back_inserter(alone),
                   [&](const VisibleObject& o) { return o.instance_id == target; });
      EXPECT_GE(pixels(objects) / pixels(alone), .9);
    }
}

TEST(FetchScenes, OfTwoArmsShareTargetReceiverAndStation) {
  const Scenario scenario = scenario_of("fetch_fruit");
  for (int i = 0; i < 10; ++i) {
    const Scene many = scene_of(scenario, "many", i), near = scene_of(scenario, "near", i);
    for (const char* role : {role::target, receiver}) {
      EXPECT_EQ(many.find(role)->object_type, near.find(role)->object_type);
      EXPECT_EQ(many.find(role)->texture, near.find(role)->texture);
    }
    EXPECT_EQ(norm(many.find(receiver)->position_m - near.find(receiver)->position_m), 0);
  }
}

TEST(FetchNearMisses, AreLikeWhatTheCommandMeans) {
  int of_class = 0, scenes = 0;
  for (const std::string& id : suite().design.scenarios) {
    const Scenario scenario = scenario_of(id);
    const FeatureSet& receives = *scenario.commands[0].truth.second;
    for (int i = 0; i < 20; ++i, ++scenes) {
      const Scene scene = scene_of(scenario, "near", i);
      const SceneObject &target = *scene.find(role::target), &goal = *scene.find(receiver);
      const auto objects = some(scene, false), receivers = some(scene, true);
      const auto like = [](const SceneObject& a, const SceneObject& b) {
        return a.object_type == b.object_type || a.texture == b.texture;
      };
      const auto near =
          std::count_if(objects.begin(), objects.end(), [&](const auto& o) { return like(o, target); }) - 1;
      if (target.texture != "yellow with brown spots") {  // which bananas alone have
        EXPECT_GE(near, 2) << id << " " << target.texture;
      }
      EXPECT_GE(std::count_if(receivers.begin(), receivers.end(), [&](const auto& o) { return like(o, goal); }), 2)
          << id;
      const bool any_texture = receives.textures.size() == scenario.space.textures.size();
      for (const SceneObject& o : receivers)
        if (any_texture) {
          EXPECT_EQ(o.texture, goal.texture) << id;
        }
      const auto& types = scenario.commands[0].truth.target.product().object_types;
      of_class += std::any_of(objects.begin(), objects.end(), [&](const SceneObject& o) {
        return o.role != role::target && std::count(types.begin(), types.end(), o.object_type) > 0;
      });
    }
  }
  EXPECT_GT(of_class, .3 * scenes) << "the same class, another condition";
}

// What shares most with the others is not mostly the target: ties in equal parts.
TEST(FetchNearMisses, GiveTheTargetAwayToNobodyWhoDoesNotHearTheCommand) {
  double share = 0;
  int scenes = 0;
  for (const std::string& id : suite().design.scenarios)
    for (int i = 0; i < 40; ++i, ++scenes) {
      const Scene scene = scene_of(scenario_of(id), "near", i);
      int most = 0, tied = 0, of_target = 0;
      for (const SceneObject& one : some(scene, false)) {
        int shared = 0;
        for (const SceneObject& o : some(scene, false))
          shared += (o.object_type == one.object_type) + (o.texture == one.texture);
        if (shared > most) most = shared, tied = 0;
        tied += shared == most;
        if (one.role == role::target) of_target = shared;
      }
      share += of_target == most ? 1. / tied : 0;
    }
  EXPECT_LT(share / scenes, 1. / 8 + .1);
}

TEST(FetchScenario, RefusesWhatItCannotShow) {
  const auto refusal = [](const Json& arm) {
    Json json = load_scenario("fetch_ripe_fruit").json;
    json["tests"] = Json::array({arm});
    json["tests"][0]["arm"] = "test";
    return message_of<InputError>([&] { read_scenario(json, "mine.json"); });
  };
  EXPECT_SAYS(refusal({{"distractors", {8, 8}}}),
              "mine.json: /tests/0/distractors/0: expected a whole number from 0 to 7");
  EXPECT_SAYS(
      refusal({{"near_miss", {{"textures", {"red"}}}}}),
      "/tests/0/near_miss/textures/0: expected a name outside of what \"Put a ripe fruit on the clean plate.\"");
  EXPECT_SAYS(refusal({{"near_miss", {{"object_types", {"kite"}}}}}), "expected a name of the feature space");
  EXPECT_SAYS(refusal({{"near_first", true}}), "near_first");
}

Environment& fetching() {
  static const auto made = make_environment(make_engine(), true);
  return *made;
}

TEST(FetchEpisode, FailsByName) {
  const Scenario scenario = scenario_of("fetch_fruit");
  for (int i = 0; i < 5; ++i) {
    const Scene scene = scene_of(scenario, "near", i);
    fetching().reset(scene);
    const Plan plan = fetching().expert_action();
    EXPECT_TRUE(fetching().step(plan).is_success) << i;

    const auto failure_at = [&](Vec2 place) {
      fetching().reset(scene);
      Plan other = plan;
      other.waypoint_m = before(place);
      other.drop_m = place;
      return fetching().step(other).failure;
    };
    std::set<double> taken;
    for (const SceneObject& o : some(scene, true)) {
      taken.insert(o.position_m.y);
      if (o.role == role::distractor) {
        EXPECT_EQ(failure_at(o.position_m), failure::wrong_receiver) << o.object_type;
      }
    }
    for (const Vec2 station : stations)
      if (taken.count(station.y) == 0) {
        EXPECT_EQ(failure_at(station), failure::dropped_elsewhere);
      }

    fetching().reset(scene);
    for (const SceneObject& o : scene.objects)
      if (o.role != role::target) {
        EXPECT_EQ(fetching().step(fetching().expert_action_for(o.instance_id)).failure, failure::wrong_object);
      }
  }
}

TEST(FetchEpisode, EveryStationIsWithinReach) {
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const Stations::Station& station = fetch_plans().stations.all[i];
    EXPECT_EQ(station.values[4], stations[i].x);
    EXPECT_EQ(station.values[5], stations[i].y);
    EXPECT_FALSE(blocked({station.values[0], station.values[1]}));
    for (const double coordinate : {station.seen.x, station.seen.y}) EXPECT_TRUE(coordinate > 0 && coordinate < 1);
  }
}

}  // namespace
}  // namespace lgabench::mobile

// Episodes of several steps, played in examples/reach2d: the loop, its records and files, and environments that break
// their interface.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/demonstrations.hpp>
#include <lgabench/cell/evaluator.hpp>
#include <lgabench/cell/hdf5.hpp>
#include <lgabench/cell/reference_actor.hpp>
#include <lgabench/host/messages.hpp>
#include <lgabench/learning/featurizer.hpp>
#include <lgabench/learning/network.hpp>
#include <lgabench/learning/noisy_copies.hpp>
#include <lgabench/learning/training.hpp>
#include <lgabench/plugin/simple_environment.hpp>

#include "altered_environment.hpp"
#include "testing.hpp"

namespace lgabench {
namespace {

// Before the first environment is asked for.
const bool is_found = [] {
  ::setenv("LGABENCH_PLUGIN_PATH", LGABENCH_TEST_PLUGINS, 1);
  ::setenv("LGABENCH_SCENARIO_PATH", LGABENCH_TEST_SCENARIOS, 1);
  return true;
}();

constexpr const char* utterance = "Move to the red disc.";

Scenario reach() { return load_scenario("reach2d_red"); }

Scenario reach_with(const Json& members) {
  Json json = reach().json;
  json.update(members);
  return read_scenario(json, "test");
}

std::vector<TestScene> tests(const Scenario& scenario, int n) {
  std::vector<TestScene> all;
  for (int i = 0; i < n; ++i) all.push_back({test_scene(scenario, "plane", "test", 0, i)});
  return all;
}

std::vector<Scene> to_show(const Scenario& scenario, int n) {
  std::vector<Scene> all;
  for (int i = 0; i < n; ++i) all.push_back(training_scene(scenario, "plane", {}, 0, i));
  return all;
}

std::vector<Episode> played(const Scenario& scenario, const Actor& actor, int n) {
  const auto environment = make_environment(scenario, nullptr);
  return evaluate(*environment, tests(scenario, n), actor, [](int) {});
}

Actor doing(std::function<Action(const Given&)> act) {
  Actor actor;
  actor.choose = [act = std::move(act)](const Environment&, const Given& given) { return Move(act(given)); };
  return actor;
}

std::vector<Demonstration> shown(const Scenario& scenario, int n, int noisy = 0, Outcomes* outcomes = nullptr) {
  const auto environment = make_environment(scenario, nullptr);
  return demonstrate(*environment, to_show(scenario, n), {Needs::Targets::truth, noisy, .5}, {utterance}, outcomes);
}

void expect_same(const Step& a, const Step& b) {
  EXPECT_EQ(a.observation.rgb, b.observation.rgb);
  EXPECT_EQ(a.observation.ids, b.observation.ids);
  EXPECT_EQ(a.observation.state, b.observation.state);
  EXPECT_EQ(a.observation.brought, b.observation.brought);
  EXPECT_EQ(a.label, b.label);
}

void expect_same(const std::vector<Demonstration>& a, const std::vector<Demonstration>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].steps.size(), b[i].steps.size());
    ASSERT_EQ(a[i].recovery.size(), b[i].recovery.size());
    for (std::size_t t = 0; t < a[i].steps.size(); ++t) expect_same(a[i].steps[t], b[i].steps[t]);
    for (std::size_t t = 0; t < a[i].recovery.size(); ++t) expect_same(a[i].recovery[t], b[i].recovery[t]);
  }
}

TEST(Steps, TheOracleWinsEveryScene) {
  std::size_t most = 0, least = 20;
  for (const Episode& e : played(reach(), reference_actor("oracle"), 500)) {
    EXPECT_TRUE(e.success()) << e.index << ": " << e.failure;
    most = std::max(most, e.actions().size());
    least = std::min(least, e.actions().size());
  }
  EXPECT_LE(most, 20u);
  EXPECT_GT(most, least);
}

TEST(Steps, ARecordedEpisodePlayedAgainGivesTheSameBitsAtEveryStep) {
  const Scenario scenario = reach();
  std::map<int, std::vector<Observation>> seen;
  const auto environment = make_environment(scenario, nullptr);
  Actor actor = reference_actor("oracle");
  actor.choose = [&seen, oracle = actor.choose](const Environment& at, const Given& given) {
    seen[given.scene.index].push_back(given.seen);
    EXPECT_EQ(given.step + 1, static_cast<int>(seen[given.scene.index].size()));
    return oracle(at, given);
  };
  for (const Episode& played : evaluate(*environment, tests(scenario, 20), actor, [](int) {})) {
    const Json line = to_json(played);
    const Episode e = read_episode(JsonReader(parse_json(canonical(line), "line"), "line"));
    EXPECT_EQ(to_json(e), line);
    ASSERT_EQ(e.actions().size(), seen[e.index].size());
    Observation now = environment->reset(test_scene(scenario, "plane", "test", 0, e.index));
    for (std::size_t t = 0; t < e.actions().size(); ++t) {
      EXPECT_EQ(now.rgb, seen[e.index][t].rgb);
      EXPECT_EQ(now.state, seen[e.index][t].state) << "to the last bit: actions are carried out as stored";
      const StepResult result = environment->step(e.actions()[t]);
      EXPECT_EQ(result.terminated, t + 1 == e.actions().size());
      now = result.observation;
    }
  }
}

TEST(Steps, AnEpisodeOfOneActionIsWrittenAsEver) {
  Episode e{"test", 0, 0, "0123456789abcdef"};
  e.add({1, 2});
  EXPECT_EQ(to_json(e).at("action"), (Json{1, 2}));
  EXPECT_FALSE(to_json(e).contains("then"));
  EXPECT_FALSE(to_json(e).contains("done"));
  e.add({3, 4});
  e.add({});
  EXPECT_EQ(to_json(e).at("then"), Json::array({Json::array({3, 4})}));
  EXPECT_EQ(to_json(e).at("done"), true);
  EXPECT_EQ(e.actions(), (std::vector<Action>{{1, 2}, {3, 4}, {}}));
  Json bad = to_json(e);
  bad["action"] = nullptr;
  EXPECT_SAYS(message_of<InputError>([&] { read_episode(JsonReader(bad, "line")); }), "\"action\" before them");
}

TEST(Steps, APolicyIsResetOnceAnEpisode) {
  struct Counting : Policy {
    void reset() override { ++resets; }
    Action act(const Observation&, const Instruction&) override { return ++acts, Action{0, 0}; }
    int resets = 0, acts = 0;
  } policy;
  const std::vector<Instruction> told{{utterance, {}}};
  const auto episodes = played(reach(), policy_actor(policy, told, "counting"), 3);
  EXPECT_EQ(policy.resets, 3);
  EXPECT_EQ(policy.acts, 60);
  for (const Episode& e : episodes) EXPECT_EQ(e.failure, "not_reached");
}

TEST(Steps, WhatAPolicyThrowsEndsTheEpisodeAndKeepsWhatWasDone) {
  const auto episodes = played(reach(), doing([](const Given& given) -> Action {
                                 if (given.step == 2) throw MethodError("no more");
                                 return {0, .01};
                               }),
                               1);
  EXPECT_EQ(episodes[0].failure, failure::method_error);
  EXPECT_EQ(episodes[0].actions().size(), 2u);
}

TEST(Steps, NothingLeftToDoIsSaidOnlyWhereTheScenarioHasIt) {
  const Actor stops = doing([](const Given& given) { return given.step == 0 ? Action{0, 0} : Action(); });
  const Episode refused = played(reach(), stops, 1)[0];
  EXPECT_EQ(refused.failure, failure::method_error);
  EXPECT_SAYS(refused.error, "action: expected 2 numbers, got none");
  EXPECT_EQ(refused.actions().size(), 1u);
  const Episode stopped = played(reach_with({{"may_stop", true}}), stops, 1)[0];
  EXPECT_EQ(stopped.failure, "not_reached");
  EXPECT_TRUE(stopped.done);
  EXPECT_EQ(stopped.actions().size(), 2u);
  Json one = load_scenario("heart").json;
  one["may_stop"] = true;
  EXPECT_SAYS(message_of<InputError>([&] { read_scenario(one, "heart"); }), "a task of several steps");
}

TEST(Steps, PerceptionErrsAnewAtEveryStepAndKeepsTheState) {
  const Scenario scenario = reach_with({{"tests", Json::array({{{"arm", "test"}, {"label_noise", .5}}})}});
  const Perception perception = perception_of(scenario, scenario.tests.front());
  const Scene scene = test_scene(scenario, "plane", "test", 0, 0);
  const auto environment = make_environment(scenario, nullptr);
  const Observation seen = environment->reset(scene);
  const auto textures = [&](int step) {
    std::vector<std::string> all;
    for (const Instance& one : perception(seen, scene, step).instances) all.push_back(one.texture);
    return all;
  };
  EXPECT_EQ(textures(1), textures(1));
  EXPECT_NE(textures(0), textures(1));
  EXPECT_NE(textures(1), textures(2));
  EXPECT_EQ(perception(seen, scene, 1).state, seen.state);
  EXPECT_EQ(later_stream(0), "");
}

TEST(Steps, TrajectoriesAndRecoveryStepsAreToldApartInEveryForm) {
  Outcomes outcomes;
  auto all = shown(reach(), 4, 3, &outcomes);
  std::size_t recovered = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_GT(all[i].steps.size(), 2u);
    EXPECT_EQ(outcomes[i].size(), all[i].steps.size() + all[i].recovery.size());
    for (std::size_t t = 0; t + 1 < all[i].steps.size(); ++t)
      EXPECT_EQ(outcomes[i][t].observation.state, all[i].steps[t + 1].observation.state);
    EXPECT_TRUE(outcomes[i][all[i].steps.size() - 1].is_success);
    recovered += all[i].recovery.size();
    for (const Step& step : all[i].recovery) EXPECT_NE(step.observation.state, all[i].steps[0].observation.state);
  }
  EXPECT_GT(recovered, 6u);
  all[1].steps[2].observation.brought = {{"round", "green"}};
  all[2].steps.back().label.clear();  // nothing is left to do
  expect_same(read_demonstrations(demonstrations_hdf5(all, "test"), "test"), all);
  host::Layout layout{{64, 128}, actions_of(reach()), state_of(reach()), true};
  const host::DemonstrationFile file = host::pack(layout, all);
  expect_same(host::unpack(layout, JsonReader(file.header, "learn"), file.file), all);
  EXPECT_EQ(host::to_json(layout).at("may_stop"), true);
  EXPECT_EQ(host::to_json(layout).at("observation").at("state").size(), 2u);
  layout.state.pop_back();
  EXPECT_SAYS(message_of<Error>([&] { host::pack(layout, all); }), "state: expected 1 numbers, got 2");
}

TEST(Steps, EveryStepIsARowAndThoseWhereNothingIsLeftToDoAreApart) {
  auto all = shown(reach(), 2, 2);
  std::size_t steps = 0;
  for (const Demonstration& one : all) steps += one.steps.size() + one.recovery.size();
  all[0].steps.back().label.clear();
  Featurizer featurizer({{PolicyInputs::Picture::mask}}, actions_of(reach()), state_of(reach()));
  const Samples samples = featurizer.samples(all);
  EXPECT_EQ(samples.rows, static_cast<int>(steps) - 1);
  ASSERT_TRUE(samples.stops);
  EXPECT_EQ(samples.stops->rows, 1);
  EXPECT_EQ(samples.stops->labels, std::vector<float>(2));
  const Observation& last = all[0].steps.back().observation;
  EXPECT_FLOAT_EQ(samples.stops->state[1], static_cast<float>(last.state[1]));
  Samples one(featurizer.shape(), 1);
  featurizer.write(last, all[0].instruction, Phase::training, one, 0);
  EXPECT_EQ(samples.stops->pictures, one.pictures);
  EXPECT_FALSE(featurizer.samples(shown(reach(), 1)).stops);
  const Samples noisy = with_noisy_copies(samples, 2, .05, 0);
  EXPECT_EQ(noisy.stops, samples.stops);
  for (std::size_t i = 0; i < noisy.state.size(); ++i) EXPECT_EQ(noisy.state[i], samples.state[i / 6 * 2 + i % 2]);
  const Observation& first = all[0].steps[0].observation;
  EXPECT_FLOAT_EQ(samples.state[0], static_cast<float>(first.state[0] / .5));
  EXPECT_FLOAT_EQ(samples.state[1], static_cast<float>(first.state[1]));
}

struct NoLog : TrainingLog {
  void epoch(int, long long, double) override {}
};

// Samples of which the state alone says what to do.
Samples led_by_state(const NetworkShape& shape, int rows) {
  Samples samples(shape.samples(), rows);
  RandomStream random("state");
  for (float& number : samples.state) number = static_cast<float>(random.uniform(-1, 1));
  for (std::size_t i = 0; i < samples.labels.size(); ++i) samples.labels[i] = (i % 2 ? -.4f : .3f) * samples.state[i];
  return samples;
}

double worst(Network& network, const Samples& samples) {
  double error = 0;
  const std::vector<float>& predicted = network.predict(samples);
  for (std::size_t i = 0; i < predicted.size(); ++i)
    error = std::max<double>(error, std::abs(predicted[i] - samples.labels[i]));
  return error;
}

TEST(Steps, TheNetworkLearnsFromTheState) {
  NoLog log;
  for (const bool text : {false, true}) {
    const NetworkShape shape{{1}, text, Architecture::plain, 2, false, 2};
    const Samples samples = led_by_state(shape, 40);
    Network network(shape, 1, Loss::norm);
    train(network, samples, {100}, 1, log);
    EXPECT_LT(worst(network, samples), .05) << text;
  }
  for (const Architecture architecture : {Architecture::text, Architecture::released})
    for (const bool text : {false, true}) {
      const NetworkShape shape{{1}, text, architecture, 2, false, 2};
      Samples samples = led_by_state(shape, 10);
      Network network(shape, 1, Loss::norm);
      const double loss = network.backward(samples, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
      for (int i = 0; i < 50; ++i) network.update(1e-3), network.backward(samples, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
      EXPECT_LT(network.backward(samples, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}), .7 * loss) << text;
      const std::vector<float> one = network.predict(samples);
      for (float& number : samples.state) number = -number;
      EXPECT_NE(one, network.predict(samples));
    }
  NetworkShape many{{1}};
  many.state = 17;
  EXPECT_SAYS(message_of<InputError>([&] { Network(many, 1, Loss::norm); }), "expected 16 numbers at most");
}

// What an environment does against its interface costs the cell, in words of its own.
std::string broken(const AlteredEnvironment::Alter& alter) {
  Scenario scenario = reach();
  const AlteredType type(*scenario.environment, alter);
  scenario.environment = &type;
  return message_of<EngineError>([&] { played(scenario, reference_actor("oracle"), 1); });
}

TEST(BrokenSteps, AreEachSaidWithSceneAndStep) {
  const std::string at = "environment reach2d: scene 0 of test, step ";
  EXPECT_EQ(broken([](StepResult& r) {
              r.observation.state = {NAN, 0};
            }),
            at + "1: state: down: expected -0.5 to 0.5, got nan");
  EXPECT_EQ(broken([](StepResult& r) {
              r.observation.state = {0, 2};
            }),
            at + "1: state: across: expected -1 to 1, got 2");
  EXPECT_EQ(broken([](StepResult& r) { r.observation.state = {0}; }), at + "1: state: expected 2 numbers, got 1");
  EXPECT_EQ(broken([](StepResult& r) { r.terminated = false, r.is_success = true, r.failure = failure::none; }),
            at + "1: a success in an episode that did not end");
  EXPECT_EQ(broken([](StepResult& r) { r.is_success = true; }), at + "1: the failure is \"goes_on\" of a success");
  EXPECT_EQ(broken([](StepResult& r) { r.is_success = false, r.failure = failure::none; }),
            at + "1: the failure is \"none\" without a success");
  EXPECT_EQ(broken([](StepResult& r) { r.terminated = true; }),
            at + "1: the failure of an episode that is over is \"goes_on\"");
  EXPECT_EQ(broken([](StepResult& r) { r.failure = "not_reached"; }),
            at + "1: the failure of an episode that goes on is \"not_reached\"");
}

TEST(BrokenSteps, AnEnvironmentThatGoesOnAfterDoneIsSaid) {
  Scenario scenario = reach_with({{"may_stop", true}});
  const AlteredType type(*scenario.environment, [](StepResult& r) {
    r.terminated = false;
    r.failure = failure::goes_on;
  });
  scenario.environment = &type;
  EXPECT_EQ(
      message_of<EngineError>([&] { played(scenario, doing([](const Given&) { return Action(); }), 1); }),
      "environment reach2d: scene 0 of test, step 1: the episode goes on after its actor said that nothing is left "
      "to do");
}

TEST(BrokenSteps, AnEpisodeThatNeverEndsFailsAfterItsLastStep) {
  Scenario scenario = reach();
  const AlteredType type(*scenario.environment, [](StepResult& r) {
    r.terminated = r.is_success = false;
    r.failure = failure::goes_on;
  });
  scenario.environment = &type;
  const Episode e = played(scenario, reference_actor("oracle"), 1)[0];
  EXPECT_EQ(e.failure, failure::goes_on);
  EXPECT_EQ(e.actions().size(), 20u);
  EXPECT_SAYS(message_of<EngineError>([&] { shown(scenario, 1); }),
              "scene 0 of train, step 20: the oracle's episode does not end");
}

TEST(BrokenSteps, AnOracleThatFailsDemonstratesNothing) {
  Scenario scenario = reach();
  const AlteredType type(*scenario.environment, [](StepResult& r) {
    if (!r.is_success) return;
    r.is_success = false;
    r.failure = "wrong_disc";
  });
  scenario.environment = &type;
  EXPECT_SAYS(message_of<EngineError>([&] { shown(scenario, 1); }), "the oracle's episode ends as wrong_disc");
}

TEST(BrokenSteps, AStepAfterTheEndIsRefused) {
  const Scenario scenario = reach();
  const auto environment = make_environment(scenario, nullptr);
  environment->reset(test_scene(scenario, "plane", "test", 0, 7));
  int steps = 0;
  for (bool over = false; !over; ++steps) over = environment->step(environment->expert_action()).terminated;
  EXPECT_EQ(message_of<Error>([&] {
              environment->step({0, 0});
            }),
            fmt::format("step(): scene 7 of test is over after {} steps; expected a reset() before it", steps));
}

// Scenes of six discs and six squares, which nobody plays.
class Shapes : public SimpleEnvironment {
 public:
  Shapes() : SimpleEnvironment(about()) {}

 protected:
  void place(Scene& /*scene*/, RandomStream /*random*/) const override {}
  std::unique_ptr<Environment> make(const std::string& /*task*/) const override { return nullptr; }

 private:
  static EnvironmentDescription about() {
    EnvironmentDescription about;
    about.id = "shapes";
    about.tasks = {{"reach", {"plane"}, {}, {}, "reach2d_red"}};
    about.spaces = {"tabletop"};
    for (const char* type : {"round", "square"})
      for (const char* texture : {"red", "green", "blue", "yellow", "purple", "orange"})
        about.things.push_back({type, texture});
    about.most_things = 7;
    return about;
  }
};

TEST(SimpleEnvironments, DrawAsManyOthersAsTheFileSaysNearMissesFirst) {
  const Shapes shapes;
  Scenario scenario = reach();
  scenario.environment = &shapes;
  const auto scene_with = [&](const Json& members, int index) {
    const Json file = scenario.json;
    const JsonReader reader(members, "members");
    scenario.tests.front().scenes = shapes.read_content(scenario, JsonReader(file, "file"), &reader, false);
    return shapes.sample(scenario, {"plane", "test", "test", 0}, index);
  };
  const auto is_near = [](const SceneObject& one) { return one.object_type == "round" || one.texture == "red"; };
  std::set<std::size_t> counts;
  for (int i = 0; i < 20; ++i) {
    const Scene all = scene_with(Json::object(), i), near = scene_with({{"near_miss", true}}, i);
    EXPECT_EQ(all.objects.size(), 7u);
    EXPECT_TRUE(std::all_of(near.objects.begin(), near.objects.end(), is_near)) << "five discs, and the red square";
    EXPECT_EQ(scene_with({{"distractors", {0, 0}}}, i).objects.size(), 1u);
    counts.insert(scene_with({{"distractors", {2, 4}}, {"near_miss", true}}, i).objects.size());
  }
  EXPECT_EQ(counts, (std::set<std::size_t>{3, 4, 5}));
  for (const auto& [members, said] :
       {std::pair<Json, const char*>{{{"distractors", {2}}}, "/distractors: expected [fewest, most]"},
        {{{"distractors", {2, 7}}}, "/distractors/1: expected"},
        {{{"near_miss", "round"}}, "/near_miss: expected"}})
    EXPECT_SAYS(message_of<InputError>([&, &given = members] { scene_with(given, 0); }), said);
}

}  // namespace
}  // namespace lgabench

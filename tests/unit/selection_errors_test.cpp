// Errors made on purpose in what was selected.
#include <gtest/gtest.h>

#include <algorithm>

#include <lgabench/abstraction/selection_errors.hpp>
#include <lgabench/core/scenario.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

Selection right(const Scenario& scenario) {
  Selection selection = scenario.commands.front().truth;
  selection.provenance = Provenance::truth;
  return selection;
}

bool holds(const std::vector<std::string>& all, const std::vector<std::string>& some) {
  return std::all_of(some.begin(), some.end(),
                     [&](const auto& name) { return std::find(all.begin(), all.end(), name) != all.end(); });
}

TEST(SelectionErrors, MoreOfThemHoldThoseThatFewerMake) {
  const Scenario scenario = load_scenario("something_from_a_typical_kitchen");
  const Selection truth = right(scenario);
  FeatureSet fewer = truth.target.product(), more = fewer;
  for (const double p : {.1, .2, .4, .8, 1.}) {
    const FeatureSet less = with_errors(truth, scenario, 0, {p, 0}, 3, "").target.product();
    EXPECT_TRUE(holds(fewer.object_types, less.object_types) && holds(fewer.textures, less.textures)) << p;
    fewer = less;
    const FeatureSet larger = with_errors(truth, scenario, 0, {0, p}, 3, "").target.product();
    EXPECT_TRUE(holds(larger.object_types, more.object_types) && holds(larger.textures, more.textures)) << p;
    more = larger;
  }
  EXPECT_TRUE(fewer.object_types.empty() && fewer.textures.empty());
  EXPECT_EQ(more.object_types, scenario.space.object_types);
}

TEST(SelectionErrors, AreTheSameForEveryMethodAndOfTheirProbability) {
  const Scenario scenario = load_scenario("red_heart");
  const Selection truth = right(scenario);
  Selection other = truth;
  other.target.product().object_types = {"star"};  // what it lacks stays missing, what it has too many stays
  int added = 0, missing = 0;
  constexpr int seeds = 200;
  const auto n = static_cast<double>(scenario.space.object_types.size() - 1);
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const FeatureSet a = with_errors(truth, scenario, 0, {.2, .2}, seed, "").target.product();
    const FeatureSet b = with_errors(other, scenario, 0, {.2, .2}, seed, "").target.product();
    EXPECT_EQ(a.textures, b.textures);
    EXPECT_TRUE(holds(b.object_types, {"star"}));
    EXPECT_FALSE(holds(b.object_types, {"heart"}));
    const bool kept = holds(a.object_types, {"heart"});
    missing += !kept;
    added += static_cast<int>(a.object_types.size()) - kept;
  }
  EXPECT_NEAR(missing / static_cast<double>(seeds), .2, .1);
  EXPECT_NEAR(added / (seeds * n), .2, .02);
}

TEST(SelectionErrors, LeaveOutWhatIsNeverMeantAndWhoSelectsNothing) {
  const Scenario scenario = load_scenario("tiger_colored_object");
  const Selection truth = right(scenario);
  ASSERT_TRUE(holds(truth.target.product().object_types, {"pallet"}));
  EXPECT_TRUE(holds(with_errors(truth, scenario, 0, {}, 0, "pallet").target.product().object_types, {"pallet"}));
  EXPECT_FALSE(holds(with_errors(truth, scenario, 0, {0, .9}, 0, "pallet").target.product().object_types, {"pallet"}));
  EXPECT_TRUE(with_errors(Selection(), scenario, 0, {0, .9}, 0, "pallet").target.empty());
}

TEST(SelectionErrors, AreReadAsTheyAreWritten) {
  const auto read = [](const Json& json) { return read_selection_errors(JsonReader(json, "cell")); };
  EXPECT_EQ(to_json(read({{"missing", .1}, {"added", .25}})), Json({{"missing", .1}, {"added", .25}}));
  EXPECT_EQ(read({{"missing", .1}, {"added", .25}}).suffix(), "+added=0.25+missing=0.1");
  EXPECT_EQ(to_json(read(Json::object())), Json::object());
  EXPECT_SAYS(message_of<InputError>([&] { read({{"missing", 1.5}}); }), "/missing: expected a number from 0 to 1");
  EXPECT_THROW(read({{"wrong", .1}}), InputError);
}

}  // namespace
}  // namespace lgabench

// What labels, language and the truth add.
#include <gtest/gtest.h>

#include <lgabench/report/report.hpp>
#include <lgabench/statistics/steps.hpp>

#include "report_run.hpp"

namespace lgabench {
namespace {

using Spec = FabricatedRun::Spec;

// Of 20 scenes, two seeds and two scenarios: pixels 4, labels 9, language 14, the truth 20; a little more in the
// second.
void add_stage(FabricatedRun& run, const char* method, int won, const Json& policy = "heat_map") {
  for (const char* scenario : {"heart", "letter"})
    for (int seed = 0; seed < 2; ++seed) {
      Spec spec{method, std::min(20, won + (scenario == std::string("letter") ? 2 : 0)), scenario, 5, seed};
      spec.options = {{"policy", policy}};
      run.add(spec);
    }
}

void add_stages(FabricatedRun& run, const Json& policy_of_labels = "heat_map") {
  add_stage(run, "gcbc_seg", 4);
  add_stage(run, "taken_features", 9, policy_of_labels);
  add_stage(run, "lga", 14);
  add_stage(run, "human", 18);
}

TEST(Steps, AreOfTheSameScenesAndAddUp) {
  FabricatedRun run;
  add_stages(run);
  const report::Report report = report::write_report(run.save().path);
  const Json summary = read_json(run.path / "summary.json");
  ASSERT_EQ(summary.at("steps").size(), 1u);
  const Json& steps = summary["steps"][0];
  EXPECT_EQ(steps["arm"], "test");
  EXPECT_EQ(steps["demonstrations"], 5);
  EXPECT_EQ(steps["commands"], 2);
  double sum = steps["stages"][0]["success"];
  EXPECT_DOUBLE_EQ(sum, .25);
  for (std::size_t i = 0; i < 3; ++i) {
    const Json &step = steps["steps"][i], &stage = steps["stages"][i + 1];
    sum += step["difference"].get<double>();
    EXPECT_NEAR(sum, stage["success"].get<double>(), 1e-12);
    EXPECT_EQ(summary["rows"][stage["row"].get<std::size_t>()]["success"], stage["success"]);
    EXPECT_LT(step["low"], step["difference"]);
    EXPECT_GT(step["high"], step["difference"]);
  }
  EXPECT_DOUBLE_EQ(steps["steps"][0]["difference"], .25);
  std::string headline;
  for (const document::Span& span : report.document.headline) headline += span.text;
  EXPECT_SAYS(headline, "LGA succeeds in 0.75 of the episodes. From pixels GCBC-SEG has 0.25; labels add 0.25 [");
  EXPECT_SAYS(read_file(run.path / "report.html"), "What labels, language and the truth add");
}

TEST(Steps, NeedFourRowsOfOnePolicyAndTheSameSeeds) {
  const auto steps_in = [](FabricatedRun& run) {
    report::write_report(run.save().path);
    return read_json(run.path / "summary.json").contains("steps");
  };
  FabricatedRun other_policy, other_seeds, lacking;
  add_stages(other_policy, "centroid");
  EXPECT_FALSE(steps_in(other_policy));
  for (const char* method : {"gcbc_seg", "taken_features", "lga", "human"}) {
    Spec spec{method, 10};
    spec.seed = method == std::string("lga") ? 1 : 0;
    other_seeds.add(spec);
    if (method != std::string("taken_features")) lacking.add({method, 10});
  }
  EXPECT_FALSE(steps_in(other_seeds));
  EXPECT_FALSE(steps_in(lacking));
}

// Where one command has all of a step and the other one nothing, other commands make it uncertain, other scenes do not.
TEST(Steps, OverCommandsAreWider) {
  const auto rates = [](double one, double other) {
    const std::vector<double> first(50, one), second(50, other);
    return std::vector<std::vector<std::vector<double>>>{{first, first}, {second, second}};
  };
  const statistics::StageOutcomes outcomes{{rates(0, 0), rates(1, 0), rates(1, 0), rates(1, 1)}, {1, 1}, true};
  const auto [labels, language, truth] = statistics::steps_of(outcomes, "test");
  EXPECT_EQ(labels.difference, .5);
  EXPECT_GT(labels.interval.low, .4);
  EXPECT_LT(labels.over_commands.low, .1);
  EXPECT_GT(labels.over_commands.high, .9);
  EXPECT_EQ(language.difference, 0);
  EXPECT_LE(language.interval.low, 0);
  EXPECT_GE(language.interval.high, 0);
  EXPECT_EQ(truth.difference, .5);
  // What a command counts weighs it: 3 of 4 parts are the first's.
  EXPECT_EQ(statistics::steps_of({outcomes.rates, {3, 1}, true}, "test")[0].difference, .75);
}

}  // namespace
}  // namespace lgabench

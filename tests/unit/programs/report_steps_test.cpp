// What labels, the command and the truth add.
#include <gtest/gtest.h>

#include <cmath>

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
    EXPECT_FALSE(step.contains("over_commands")) << "two commands decide nothing";
  }
  EXPECT_SAYS(read_file(run.path / "report.html"), "undecided");
  EXPECT_DOUBLE_EQ(steps["steps"][0]["difference"], .25);
  std::string headline;
  for (const document::Span& span : report.document.headline) headline += span.text;
  EXPECT_SAYS(headline,
              "LGA succeeds in 0.75 of the episodes. From pixels GCBC-SEG has 0.25; counting labels adds 0.25 [");
  EXPECT_SAYS(read_file(run.path / "report.html"), "What labels, the command and the truth add");
}

TEST(Steps, GoOverTheOtherRuleOfLabelsAndBothWhereTheyPlayed) {
  FabricatedRun run;
  add_stages(run);
  add_stage(run, "taken_names", 11);
  add_stage(run, "lga_then_taken", 16);
  report::write_report(run.save().path);
  const Json steps = read_json(run.path / "summary.json").at("steps").at(0);
  std::vector<std::string> told;
  for (const Json& stage : steps["stages"]) told.push_back(stage["what"]);
  EXPECT_EQ(told, (std::vector<std::string>{"pixels", "labels, counted", "labels, by what their names mean",
                                            "command read", "both", "true mask"}));
  EXPECT_EQ(steps["steps"].size(), 5u);
  EXPECT_NEAR(steps["steps"][2]["difference"].get<double>(), .15, 1e-9);

  FabricatedRun other_policy;  // of a row that is not needed: the steps go over it
  add_stages(other_policy);
  add_stage(other_policy, "lga_then_taken", 16, "centroid");
  report::write_report(other_policy.save().path);
  EXPECT_EQ(read_json(other_policy.path / "summary.json")["steps"][0]["stages"].size(), 4u);
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

// Where half of the commands have all of a step and the others nothing, other commands make it uncertain, other scenes
// do not.
TEST(Steps, OverCommandsAreWiderAndUndecidedBelowSix) {
  const auto rates = [](int commands, double first, double second) {
    const auto all = [](double rate) { return std::vector<std::vector<double>>(2, std::vector<double>(50, rate)); };
    std::vector<std::vector<std::vector<double>>> row;
    for (int i = 0; i < commands; ++i) row.push_back(all(i % 2 == 0 ? first : second));
    return row;
  };
  const auto steps_over = [&](int commands, std::vector<double> weights = {}) {
    if (weights.empty()) weights.assign(static_cast<std::size_t>(commands), 1);
    return statistics::steps_of(
        {{rates(commands, 0, 0), rates(commands, 1, 0), rates(commands, 1, 0), rates(commands, 1, 1)}, weights, true},
        "test");
  };
  const auto six = steps_over(6);
  ASSERT_EQ(six.size(), 3u);
  EXPECT_EQ(six[0].difference, .5);
  EXPECT_GT(six[0].interval.low, .4);
  ASSERT_TRUE(six[0].over_commands);
  EXPECT_NEAR(six[0].over_commands->low, .5 - 2.5706 * std::sqrt(.3 / 6), 1e-3) << "Student's, with five degrees";
  EXPECT_NEAR(six[0].over_commands->high, .5 + 2.5706 * std::sqrt(.3 / 6), 1e-3);
  EXPECT_EQ(six[1].difference, 0);
  EXPECT_EQ(six[1].over_commands->low, six[1].interval.low) << "commands that all agree do not make certain";
  EXPECT_EQ(six[1].over_commands->high, six[1].interval.high);
  for (const statistics::Step& step : steps_over(5)) EXPECT_FALSE(step.over_commands);
  EXPECT_EQ(statistics::signed_interval(steps_over(5)[0].over_commands), "undecided");
  EXPECT_EQ(steps_over(2, {3, 1})[0].difference, .75) << "what a command counts weighs it";
}

}  // namespace
}  // namespace lgabench

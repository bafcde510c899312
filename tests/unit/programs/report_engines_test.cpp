// Two engines on the same scenes: what counts, and what does not.
#include <gtest/gtest.h>

#include <lgabench/report/report.hpp>
#include <lgabench/statistics/engines.hpp>

#include "report_run.hpp"

namespace lgabench {
namespace {

FabricatedRun::Spec on(const std::string& engine, FabricatedRun::Spec spec) {
  spec.engine = engine;
  return spec;
}

FabricatedRun::Spec acting(FabricatedRun::Spec spec, double action) {
  spec.arms = {{"test", spec.won, {0}, action}};
  return spec;
}

TEST(Engines, AgreeWhereTheSameActionEndsAlike) {
  FabricatedRun run;
  // LGA and LGA-HILL act alike: each of their twenty actions counts once among all.
  for (const char* method : {"lga", "lga_hill"}) {
    run.add(on("mujoco", {method, 15}));
    run.add(on("bullet", {method, 13}));
  }
  run.add(on("mujoco", acting({"gcbc_dart", 4}, .1)));
  run.add(on("bullet", acting({"gcbc_dart", 9}, .2)));  // trained on what the other engine showed
  run.add(on("mujoco", {"oracle", 20, "heart", 0, 0, "reference"}));
  run.save();
  const statistics::RunResults results = statistics::read_run(run.path);
  const auto agreements = statistics::engine_agreement(results);
  ASSERT_EQ(agreements.size(), 1u);
  const statistics::EngineAgreement& a = agreements[0];
  EXPECT_EQ(a.first + a.second, "bulletmujoco");
  ASSERT_EQ(a.rows.size(), 4u);
  for (const std::size_t same : {0u, 1u}) {
    EXPECT_EQ(a.rows[same].same.episodes, 20);
    EXPECT_EQ(a.rows[same].same.won_first, 13);
    EXPECT_EQ(a.rows[same].same.won_second, 15);
    EXPECT_EQ(a.rows[same].same.agreed(), 18);
    EXPECT_NEAR(a.rows[same].interval.low, .699, .001);  // Wilson's of 18 of 20
    EXPECT_NEAR(a.rows[same].interval.high, .972, .001);
  }
  EXPECT_EQ(a.rows[2].method, "gcbc_dart");
  EXPECT_EQ(a.rows[2].same.episodes, 0);
  EXPECT_EQ(a.rows[2].other_actions, 20);
  EXPECT_EQ(a.rows[3].method, "");
  EXPECT_EQ(a.rows[3].same.episodes, 20);
  ASSERT_EQ(a.disagreements.size(), 2u);
  EXPECT_EQ(a.disagreements[0].index, 13u);
  EXPECT_EQ(a.disagreements[0].episode().failure, "missed_object");
  EXPECT_EQ(a.disagreements[0].failure_second, "none");
}

TEST(Engines, OtherScenesAreNotCompared) {
  FabricatedRun run;
  FabricatedRun::Spec elsewhere{"lga", 15};
  elsewhere.first_scene = 10;  // ten of them at another index, ten unknown
  run.add(on("mujoco", {"lga", 15}));
  run.add(on("bullet", elsewhere));
  run.save();
  const statistics::RunResults results = statistics::read_run(run.path);
  EXPECT_EQ(statistics::engine_agreement(results)[0].rows[0].same.episodes, 0);
}

TEST(Engines, EpisodesOfSeveralStepsAreCountedOutAndSaid) {
  FabricatedRun run;
  FabricatedRun::Spec steps{"lga", 15};
  steps.arms = {{"test", 15, {0}, .5}};
  steps.arms.front().steps = 3;
  run.add(on("mujoco", steps));
  run.add(on("bullet", steps));
  run.save();
  const std::string said = "bullet and mujoco, layout cells: not counted are 20 episodes of tasks of several steps";
  EXPECT_NE(table_text(run.path).find(said), std::string::npos) << table_text(run.path);
  const Json alone = read_json(run.path / "summary.json").at("engine_agreement").at(0);
  EXPECT_EQ(alone.at("several_steps"), 20);
  EXPECT_TRUE(alone.at("rows").empty());
  // Beside a scenario of one step, whose rows have their own episodes alone.
  run.add(on("mujoco", {"lga", 15, "star"}));
  run.add(on("bullet", {"lga", 15, "star"}));
  run.save();
  const auto agreement = statistics::engine_agreement(statistics::read_run(run.path)).at(0);
  EXPECT_EQ(agreement.several_steps, 20);
  EXPECT_EQ(agreement.rows.at(0).same.episodes, 20);
  EXPECT_TRUE(agreement.disagreements.empty());
}

TEST(Engines, OneHasNoAgreement) {
  FabricatedRun run;
  run.add({"lga", 15});
  run.save();
  const report::Report report = report::write_report(run.path);
  EXPECT_TRUE(report.agreements.empty());
  EXPECT_EQ(read_file(run.path / "report.html").find("Does it depend on the engine"), std::string::npos);
}

}  // namespace
}  // namespace lgabench

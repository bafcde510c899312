// Comparisons of fabricated runs, and of a cell with itself computed again.
#include <gtest/gtest.h>

#include <tuple>

#include <lgabench/report/report.hpp>
#include <lgabench/statistics/agreement.hpp>
#include <lgabench/statistics/compare.hpp>
#include <lgabench/statistics/engines.hpp>
#include <lgabench/statistics/summary.hpp>

#include "report_run.hpp"

namespace lgabench {
namespace {

using statistics::Agreement;
using statistics::ComparedRow;
using statistics::RunComparison;
using Spec = FabricatedRun::Spec;

RunComparison compared(const FabricatedRun& a, const FabricatedRun& b) {
  return statistics::compare_runs(statistics::read_run(a.save().path), statistics::read_run(b.save().path));
}

std::string refusal(const FabricatedRun& a, const FabricatedRun& b) {
  try {
    compared(a, b);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Compare, EqualRunsDifferInNothing) {
  FabricatedRun run;
  run.add({"lga", 15});
  run.add({"oracle", 20, "heart", 0, 0, "reference"});
  const RunComparison comparison = compared(run, run);
  ASSERT_EQ(comparison.rows.size(), 2u);
  for (const ComparedRow& row : comparison.rows) {
    EXPECT_EQ(row.change.difference, 0);
    EXPECT_EQ(row.p_holm, 1);
    EXPECT_TRUE(row.total.same_actions);
  }
  EXPECT_FALSE(comparison.regressed());
  for (const auto& time : comparison.times) EXPECT_EQ(time.change.difference, 0);
}

TEST(Compare, RowsThatDifferInTheErrorsOfTheSelectionAreNotPaired) {
  Spec erring{"lga+missing=0.4", 5};
  erring.selection_errors = {{"missing", .4}};
  FabricatedRun run;
  run.add({"lga", 15});
  run.add(erring);
  const RunComparison comparison = compared(run, run);
  EXPECT_EQ(comparison.rows.size(), 2u);
  EXPECT_EQ(comparison.only_a + comparison.only_b, 0);
  for (const ComparedRow& row : comparison.rows) EXPECT_TRUE(row.total.same_actions);
}

TEST(Compare, EpisodesWithoutAnActionAreNotTheSameAction) {
  Spec silent{"lga", 0};
  silent.arms = {{"test", 0, {0}, NAN}, {"hard", 0, {0}, NAN}};
  FabricatedRun run, engines;
  run.add(silent);
  for (const ComparedRow& row : compared(run, run).rows) EXPECT_FALSE(row.total.same_actions);
  const statistics::Summary summary = statistics::summarize(statistics::read_run(run.path));
  for (const statistics::Row& row : summary.tables[0].rows)
    if (row.shift) {
      EXPECT_FALSE(row.shift->same_actions);
    }
  engines.add(silent);
  silent.engine = "bullet";
  engines.add(silent);
  const auto agreement = statistics::engine_agreement(statistics::read_run(engines.save().path));
  EXPECT_EQ(agreement.at(0).rows.at(0).same.episodes, 0);
  EXPECT_EQ(agreement.at(0).rows.at(0).other_actions, 0);
}

TEST(Compare, FindsTheRowThatIsWorse) {
  FabricatedRun a, b;
  for (int seed = 0; seed < 3; ++seed) {
    a.add({"lga", 18, "heart", 20, seed});
    b.add({"lga", 8, "heart", 20, seed});
    a.add({"gcbc_dart", 2, "heart", 20, seed});
    b.add({"gcbc_dart", 3, "heart", 20, seed});
  }
  const RunComparison comparison = compared(a, b);
  ASSERT_EQ(comparison.rows.size(), 2u);
  const ComparedRow &lga = comparison.rows[0], &dart = comparison.rows[1];
  EXPECT_EQ(lga.method, "lga");
  EXPECT_NEAR(lga.change.difference, -.5, 1e-12);
  EXPECT_TRUE(lga.worse());
  EXPECT_EQ(lga.cells, 3);
  EXPECT_EQ(lga.cells_worse, 3);  // ten scenes against none in each: p = .002
  EXPECT_EQ(lga.total.only_first, 30);
  EXPECT_FALSE(dart.worse() || dart.better());
  EXPECT_EQ(dart.cells_worse + dart.cells_better, 0);
  EXPECT_TRUE(comparison.regressed());
  EXPECT_FALSE(compared(b, a).regressed());
  EXPECT_TRUE(compared(b, a).rows[0].better());
}

// Six scenes that A alone won: p = .03125, which is chance among two rows.
TEST(Compare, HolmCountsTheRows) {
  FabricatedRun a, b;
  a.add({"lga", 12});
  b.add({"lga", 6});
  EXPECT_TRUE(compared(a, b).regressed());
  a.add({"gcbc_dart", 12});
  b.add({"gcbc_dart", 6});
  EXPECT_FALSE(compared(a, b).regressed());
}

TEST(Compare, TestsTimesInPairs) {
  FabricatedRun a, b;
  for (int seed = 0; seed < 12; ++seed) {
    Spec spec{"lga", 15, "heart", 20, seed};
    spec.learn_s = 4 + seed;
    a.add(spec);
    spec.learn_s += 1 + .01 * seed;
    b.add(spec);
  }
  for (const auto& time : compared(a, b).times) {
    if (time.phase == "learn_s") {
      EXPECT_NEAR(time.change.difference, 1.055, 1e-12);
      EXPECT_GT(time.change.interval.low, 1);
      EXPECT_NEAR(time.change.p, 2 / 4096., 1e-12);  // all of 12 ranks on one side
      EXPECT_NEAR(time.p_holm, 7 * 2 / 4096., 1e-12);
    } else {
      EXPECT_EQ(time.p_holm, 1) << time.phase;
    }
  }
  EXPECT_FALSE(compared(a, b).regressed()) << "seconds are no regression: they depend on the machine";
}

TEST(Compare, RefusesOtherTests) {
  FabricatedRun a, b;
  a.add({"lga", 15});
  Spec other{"lga", 15};
  other.first_scene = 1;
  b.add(other);
  EXPECT_SAYS(refusal(a, b), "scenes 0000000000000000 and 0000000000000001 at index 0");
  FabricatedRun suite;
  suite.run["suite"] = "q2";
  suite.add({"lga", 15});
  EXPECT_SAYS(refusal(a, suite), "suite q1 in A, q2 in B");
  FabricatedRun nothing;
  nothing.add({"lga", 15, "letter"});
  EXPECT_SAYS(refusal(a, nothing), "no cell finished in both");
}

TEST(Compare, NamesCellsThatPlayedOtherScenes) {
  FabricatedRun a, b;
  Spec other{"lga", 15, "letter"};
  for (FabricatedRun* run : {&a, &b}) {
    run->add({"lga", 15});
    other.first_scene = run == &a ? 0 : 1;
    run->add(other);
  }
  const RunComparison comparison = compared(a, b);
  ASSERT_EQ(comparison.rows.size(), 1u);
  EXPECT_EQ(comparison.rows[0].scenarios, 1);
  ASSERT_EQ(comparison.other_scenes.size(), 1u);
  EXPECT_EQ(comparison.other_scenes[0].scenario, "letter");
  EXPECT_EQ(comparison.other_scenes[0].cells, std::vector<std::string>{"lga n=20 seed=0"});
  EXPECT_SAYS(report::comparison_text(comparison),
              "letter, layout cells, engine mujoco, arm test: other scenes (scenes 0000000000000000 and "
              "0000000000000001 at index 0), not compared: lga n=20 seed=0");
  EXPECT_EQ(comparison.times[0].cells, 1);
  EXPECT_EQ(comparison.only_a + comparison.only_b, 0);
}

TEST(Compare, TakesTheArmsOfBothRuns) {
  FabricatedRun a, b;
  Spec one{"lga", 15}, more{"lga", 15};
  one.arms = {{"seen", 15}, {"unseen", 12}};
  more.arms = {{"seen", 15}, {"seen_varied", 10}, {"unseen", 3}};
  a.add(one);
  b.add(more);
  const RunComparison comparison = compared(a, b);
  ASSERT_EQ(comparison.rows.size(), 2u);
  EXPECT_EQ(comparison.rows[1].arm, "unseen");
  EXPECT_NEAR(comparison.rows[1].change.difference, -.45, 1e-12);
  ASSERT_EQ(comparison.other_scenes.size(), 1u);
  EXPECT_EQ(comparison.other_scenes[0].arm, "seen_varied");
  EXPECT_EQ(comparison.other_scenes[0].why, "an arm of B alone");
}

TEST(Compare, PairsRowsByWhatTheyAreNotByTheirNames) {
  FabricatedRun before, now;
  const auto add = [](FabricatedRun& run, const std::string& row, int won, const Json& options) {
    Spec spec{row, won};
    spec.options = options;
    run.add(spec);
  };
  add(before, "lga", 18, {{"loss", "norm"}, {"network", "plain"}});
  add(before, "lga+network=text", 6, {{"loss", "norm"}, {"network", "text"}});
  add(now, "lga+network=plain", 18, {{"loss", "norm"}, {"network", "plain"}});
  add(now, "lga", 6, {{"loss", "norm"}, {"network", "text"}});
  add(now, "lga+loss=squared", 9, {{"loss", "squared"}, {"network", "text"}});
  const RunComparison comparison = compared(before, now);
  ASSERT_EQ(comparison.rows.size(), 2u);
  EXPECT_EQ(comparison.rows[0].method, "lga");
  EXPECT_EQ(comparison.rows[0].method_a, "lga+network=text");
  EXPECT_EQ(comparison.rows[1].method, "lga+network=plain");
  EXPECT_EQ(comparison.rows[1].method_a, "lga");
  for (const ComparedRow& row : comparison.rows) EXPECT_EQ(row.change.difference, 0);
  EXPECT_EQ(comparison.only_a, 0);
  EXPECT_EQ(comparison.only_b, 1) << "loss=squared has no row in the earlier run";
  EXPECT_SAYS(report::comparison_text(comparison), "LGA network=plain (in A LGA)");
}

TEST(Compare, CountsWhatOneRunAloneHas) {
  FabricatedRun a, b;
  a.add({"lga", 15});
  b.add({"lga", 15});
  a.add({"lga", 15, "letter"});
  b.add({"gcbc_dart", 15});
  RunComparison comparison = compared(a, b);
  EXPECT_EQ(comparison.only_a, 1);
  EXPECT_EQ(comparison.only_b, 1);
  EXPECT_TRUE(comparison.regressed()) << "a cell of A's is missing";
  EXPECT_SAYS(verdict(comparison), "1 of A's cells is missing in B. ");
  const statistics::RunResults in_a = statistics::read_run(a.save().path), in_b = statistics::read_run(b.save().path);
  EXPECT_FALSE(statistics::compare_runs(in_a, in_b, statistics::RowPair{"lga", "lga"}).regressed())
      << "two rows were chosen";
  b.add_failed({"lga", 15, "letter"}, "plugin");
  comparison = compared(a, b);
  EXPECT_EQ(comparison.only_a, 0);
  EXPECT_EQ(comparison.failed_b, 1);
  EXPECT_TRUE(comparison.regressed());
}

// A cell recorded as `there` that is computed as `here`.
statistics::CellAgreement agreement(const Spec& there, const Spec& here, bool excused) {
  FabricatedRun a, b;
  return statistics::compare_cells(a.add(there), b.add(here), excused);
}

TEST(Compare, ARowOfOneMethodWithARowOfAnother) {
  FabricatedRun a, b;
  for (int seed = 0; seed < 3; ++seed) {
    a.add({"lga", 8, "heart", 20, seed});
    a.add({"gcbc_dart", 2, "heart", 20, seed});
    b.add({"my_method", 18, "heart", 20, seed});
  }
  const statistics::RunResults in_a = statistics::read_run(a.save().path), in_b = statistics::read_run(b.save().path);
  const RunComparison comparison = statistics::compare_runs(in_a, in_b, statistics::RowPair{"lga", "my_method"});
  ASSERT_EQ(comparison.rows.size(), 1u);
  EXPECT_EQ(comparison.rows[0].method_a, "lga");
  EXPECT_EQ(comparison.rows[0].method, "my_method");
  EXPECT_NEAR(comparison.rows[0].change.difference, .5, 1e-12);
  EXPECT_EQ(comparison.rows[0].cells, 3);
  EXPECT_EQ(comparison.only_a, 0);  // the other rows are left out, not missed
  EXPECT_EQ(verdict(comparison), "B is better: my_method against LGA (cells, 20 demonstrations, test) +0.50.");
  EXPECT_EQ(report::comparison_text(comparison).rfind("B is better: ", 0), 0u) << "the verdict comes first";
  EXPECT_EQ(to_json(comparison).at("verdict"), verdict(comparison));

  const RunComparison within = statistics::compare_runs(in_a, in_a, statistics::RowPair{"lga", "gcbc_dart"});
  EXPECT_NEAR(within.rows.at(0).change.difference, -.3, 1e-12);
  EXPECT_SAYS(message_of<InputError>([&] {
                statistics::compare_runs(in_a, in_b, statistics::RowPair{"lga", "my_methd"});
              }),
              "no row \"my_methd\" (did you mean \"my_method\"?)");
}

TEST(Compare, ItsVerdictIsOneLine) {
  FabricatedRun a, b;
  a.add({"lga", 15}), a.add({"gcbc_dart", 15});
  b.add({"lga", 15}), b.add({"gcbc_dart", 14});
  EXPECT_EQ(verdict(compared(a, a)), "B acts as A does in every scene (2 rows).");
  EXPECT_EQ(verdict(compared(a, b)), "No difference: 2 of 2 rows do not differ beyond chance.");
  b.add({"gcbc_seg", 3}), a.add({"gcbc_seg", 17});
  EXPECT_EQ(verdict(compared(a, b)),
            "B is worse: GCBC-SEG (cells, 20 demonstrations, test) -0.70. 2 of 3 rows do not differ beyond chance.");
  const std::string text = report::comparison_text(compared(a, b));
  EXPECT_SAYS(text, " total ");
  EXPECT_SILENT(text, " learn ");
  EXPECT_SAYS(report::comparison_text(compared(a, b), true), " learn ");
}

TEST(CompareCells, SameBytes) {
  EXPECT_EQ(agreement({"lga", 15}, {"lga", 15}, false).agreement, Agreement::identical);
  EXPECT_EQ(agreement({"lga", 15}, {"lga", 15}, false).detail, "");
}

TEST(CompareCells, OtherBytesNeedAnExcuse) {
  Spec there{"lga", 15}, here{"lga", 15};
  there.arms = {{"test", 15}};
  here.arms = {{"test", 15, {0}, 0.25}};  // other actions
  EXPECT_EQ(agreement(there, here, true).agreement, Agreement::same_outcomes);
  const statistics::CellAgreement owed = agreement(there, here, false);
  EXPECT_EQ(owed.agreement, Agreement::differs);
  EXPECT_SAYS(owed.detail, "from episodes.jsonl line 1, though");
}

TEST(CompareCells, OtherOutcomesAreCounted) {
  const statistics::CellAgreement other = agreement({"lga", 15}, {"lga", 11}, true);
  EXPECT_EQ(other.agreement, Agreement::other_outcomes);
  EXPECT_SAYS(other.detail, "arm test: 15 of 20 succeeded in the record, 11 recomputed, 4 episodes ended differently");
  EXPECT_SAYS(other.detail, "from episodes.jsonl line 12");
  EXPECT_EQ(other.episodes, 20);

  // Episodes that turned in one cell are one policy's; in six cells, all one way, they are no chance.
  const statistics::CellAgreement three = agreement({"lga", 15}, {"lga", 12}, true);
  EXPECT_EQ(three.only_recorded, 3);
  EXPECT_EQ(three.only_recomputed, 0);
  std::vector<std::pair<std::string, statistics::CellAgreement>> cells{{"lga", three}, {"oracle", {}}};
  for (int i = 0; i < 4; ++i) cells.emplace_back("lga", three);
  const std::vector<statistics::PooledAgreement> five = statistics::pooled(cells);
  ASSERT_EQ(five.size(), 1u);
  EXPECT_EQ(std::tuple(five[0].cells, five[0].only_recorded, five[0].worse, five[0].better), std::tuple(5, 15, 5, 0));
  EXPECT_FALSE(five[0].differs());
  cells.emplace_back("lga", three);
  const std::vector<statistics::PooledAgreement> six = statistics::pooled(cells);
  EXPECT_NEAR(six.at(0).p_holm, 2 * std::pow(.5, 6), 1e-12);
  EXPECT_TRUE(six[0].differs());
  // A forger may spread them over the rows too.
  std::vector<std::pair<std::string, statistics::CellAgreement>> spread;
  for (const char* row : {"a", "b"})
    for (int i = 0; i < 4; ++i) spread.emplace_back(row, three);
  const std::vector<statistics::PooledAgreement> rows = statistics::pooled(spread);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_FALSE(rows[0].differs());
  EXPECT_EQ(rows[2].row, "");
  EXPECT_TRUE(rows[2].differs());
  Spec otherwise{"lga", 15};
  otherwise.failure = "wrong_object";
  EXPECT_EQ(agreement({"lga", 15}, otherwise, true).agreement, Agreement::other_outcomes);
}

TEST(CompareCells, OneVerdictOverAllCells) {
  using statistics::Reproduction;
  const auto cell = [](Agreement agreement, int there, int here, int episodes) {
    statistics::CellAgreement one{agreement, "", there, here, episodes};
    return std::pair(std::string("lga"), one);
  };
  const auto same = cell(Agreement::identical, 0, 0, 100);
  EXPECT_EQ(statistics::verdict_of({same, same}), Reproduction::identical);
  EXPECT_EQ(statistics::verdict_of({same, cell(Agreement::same_outcomes, 0, 0, 100)}), Reproduction::agrees);
  EXPECT_EQ(statistics::verdict_of({same, cell(Agreement::differs, 0, 0, 100)}), Reproduction::differs);
  const auto verdict = [&](int recorded, int recomputed, int episodes) {
    return statistics::verdict_of({cell(Agreement::other_outcomes, recorded, recomputed, episodes)});
  };
  EXPECT_EQ(verdict(10, 10, 2000), Reproduction::agrees) << "1 %";
  EXPECT_EQ(verdict(11, 10, 2000), Reproduction::differs);
  EXPECT_EQ(verdict(5, 5, 400), Reproduction::agrees) << "ten";
  EXPECT_EQ(verdict(6, 5, 400), Reproduction::differs);
  EXPECT_EQ(verdict(4, 0, 100), Reproduction::agrees) << "4 %";
  EXPECT_EQ(verdict(3, 2, 100), Reproduction::differs);
  EXPECT_EQ(verdict(1, 0, 20), Reproduction::differs) << "one of twenty";
  const std::vector<std::pair<std::string, statistics::CellAgreement>> six(6,
                                                                           cell(Agreement::other_outcomes, 1, 0, 1000));
  EXPECT_EQ(statistics::verdict_of({six.begin(), six.end() - 1}), Reproduction::agrees);
  EXPECT_EQ(statistics::verdict_of(six), Reproduction::differs) << "six cells, all one way";
}

// 35 cells of an entry, whose policies were trained with kernels that gave other last bits: what each found. Every draw
// of a few of them is an honest replay.
TEST(CompareCells, HonestReplaysOfFewCellsAgree) {
  std::vector<std::pair<int, int>> found{{0, 1}, {0, 4}, {1, 0}, {5, 1}, {0, 1}, {1, 1}, {1, 0}};
  found.resize(35);
  std::vector<std::pair<std::string, statistics::CellAgreement>> cells;
  for (const auto& [recorded, recomputed] : found) {
    const bool turned = recorded + recomputed > 0;
    cells.emplace_back("lga", statistics::CellAgreement{turned ? Agreement::other_outcomes : Agreement::same_outcomes,
                                                        "", recorded, recomputed, 100});
  }
  int draws = 0, agree = 0, one_percent = 0;
  for (std::size_t a = 0; a < cells.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      for (std::size_t c = 0; c < b; ++c)
        for (std::size_t d = 0; d < c; ++d, ++draws) {
          agree += statistics::verdict_of({cells[a], cells[b], cells[c], cells[d]}) == statistics::Reproduction::agrees;
          int flips = 0;
          for (const std::size_t i : {a, b, c, d}) flips += found[i].first + found[i].second;
          one_percent += flips <= 4;
        }
  EXPECT_GT(agree, .995 * draws);
  EXPECT_LT(one_percent, .9 * draws) << "what 1 % would say of them";
  EXPECT_EQ(statistics::verdict_of(cells), statistics::Reproduction::agrees);
}

TEST(CompareCells, NothingExcusesOtherScenesOrSelections) {
  Spec scenes{"lga", 15}, selection{"lga", 15};
  scenes.first_scene = 1;
  selection.provenance = "human";
  EXPECT_EQ(agreement({"lga", 15}, scenes, true).agreement, Agreement::differs);
  EXPECT_SAYS(agreement({"lga", 15}, scenes, true).detail, "scenes 0000000000000000 and");
  EXPECT_EQ(agreement({"lga", 15}, selection, true).agreement, Agreement::differs);
  EXPECT_SAYS(agreement({"lga", 15}, selection, true).detail, "selection.json line 1");
}

}  // namespace
}  // namespace lgabench

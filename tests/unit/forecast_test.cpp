// What a run is expected to take, on the seconds that the cells of real runs took: no clock.
#include <algorithm>
#include <cmath>
#include <sstream>

#include <lgabench/harness/counted_progress.hpp>
#include <lgabench/harness/forecast.hpp>
#include <lgabench/harness/schedule.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

struct Played {
  Cell cell;
  double seconds;
};

// The cells of a run on two busy cores, as they ended: "ROW DEMONSTRATIONS SECONDS" a line. Rows are renamed where
// `unknown`.
std::vector<Played> recorded(const std::string& run, std::size_t arms, bool unknown = false) {
  std::istringstream lines(read_file(fs::path(LGABENCH_TEST_REFERENCE) / ("cell_seconds_" + run + ".txt")));
  std::vector<Played> all;
  Played one;
  while (lines >> one.cell.method.id >> one.cell.demonstrations >> one.seconds) {
    if (unknown) one.cell.method.id = "my_" + one.cell.method.id;
    one.cell.method.name = one.cell.method.id;
    one.cell.method.options = {{"epochs", 750}, {"network", "text"}};
    one.cell.episodes = 20;
    one.cell.environment = "tabletop";
    one.cell.scenario = std::make_shared<const Json>(Json{{"id", "s"},
                                                          {"task", "pick_and_place"},
                                                          {"commands", Json::array({Json::object()})},
                                                          {"tests", Json(arms, Json::object())}});
    all.push_back(one);
  }
  return all;
}

double seconds_of(const std::vector<Played>& played, std::size_t first) {
  double sum = 0;
  for (std::size_t i = first; i < played.size(); ++i) sum += played[i].seconds;
  return sum;
}

// After the first `done` cells: what the others are expected to take.
double expected(const std::vector<Played>& played, std::size_t done) {
  Costs costs;
  double sum = 0;
  for (std::size_t i = 0; i < played.size(); ++i)
    if (i < done)
      costs.learn(played[i].cell, played[i].seconds);
    else
      sum += costs.expected_seconds(played[i].cell);
  return sum;
}

TEST(Remaining, IsRightWithinThreeTenthsAfterTheFirstTenth) {
  for (const bool unknown : {false, true})
    for (const auto& [run, arms] : {std::pair{"q1", 1u}, {"q2", 4u}}) {
      const std::vector<Played> played = recorded(run, arms, unknown);
      ASSERT_GE(played.size(), 80u);
      const std::size_t tenth = played.size() / 10 + 1;
      const double left = seconds_of(played, tenth), all = seconds_of(played, 0);
      EXPECT_NEAR(expected(played, tenth) / left, 1, unknown ? .4 : .3) << run;
      for (std::size_t done = tenth; done < played.size(); done += played.size() / 40) {
        const double told = all - seconds_of(played, done) + expected(played, done);
        EXPECT_NEAR(told / all, 1, .3) << run << unknown << " after " << done << " of " << played.size();
      }
    }
}

// The machine of the table was twice as fast as the one of the record, which had other work to do.
TEST(Remaining, IsOfTheRightSizeBeforeTheFirstCell) {
  for (const auto& [run, arms] : {std::pair{"q1", 1u}, {"q2", 4u}}) {
    const std::vector<Played> played = recorded(run, arms);
    const double ratio = expected(played, 0) / seconds_of(played, 0);
    EXPECT_GT(ratio, .5) << run;
    EXPECT_LT(ratio, 2) << run;
  }
}

TEST(Remaining, OfAScheduleIsThatOfTheCellsNotGivenOut) {
  const std::vector<Played> played = recorded("q2", 4);
  std::vector<const Cell*> cells;
  for (const Played& one : played) cells.push_back(&one.cell);
  Schedule schedule(cells);
  EXPECT_NEAR(schedule.left_s(), expected(played, 0), 1e-9);
  const Cell* first = schedule.next();
  EXPECT_NEAR(schedule.left_s(), expected(played, 0) - usual_seconds(*first), 1e-9);
  schedule.learn(*first, 3 * usual_seconds(*first));
  EXPECT_NEAR(schedule.left_s(), 3 * (expected(played, 0) - usual_seconds(*first)), 1e-6);
  EXPECT_NEAR(Schedule(cells, std::nullopt, schedule.costs()).left_s(), 3 * expected(played, 0), 1e-6);
}

TEST(UsualSeconds, GrowWithWhatIsLearntAndPlayed) {
  Cell cell = recorded("q1", 1).front().cell;
  const auto with = [&](const char* option, const Json& value) {
    Cell other = cell;
    other.method.options[option] = value;
    return usual_seconds(other) / usual_seconds(cell);
  };
  EXPECT_EQ(cell.method.id, "gcbc_seg");
  EXPECT_NEAR(with("epochs", 75), .14, .05);
  EXPECT_LT(with("network", "plain"), .9);
  EXPECT_LT(with("policy", "centroid"), .1);
  Cell few = cell, many = cell;
  few.demonstrations = 16, many.demonstrations = 1600;
  for (Cell* one : {&few, &many}) one->method.options["policy"] = "heat_map";
  EXPECT_GT(usual_seconds(few), 3);
  EXPECT_LT(usual_seconds(many), usual_seconds(few) + 2) << "as many steps for any data";
  Cell two = cell, hundred = cell;
  Json scenario = *cell.scenario;
  scenario["commands"] = {Json::object(), Json::object(), {{"seen", false}}};
  two.scenario = std::make_shared<const Json>(scenario);
  EXPECT_NEAR(usual_seconds(two) / usual_seconds(cell), 2, .1) << "demonstrations are of each seen command";
  hundred.episodes = 100;
  EXPECT_GT(usual_seconds(hundred), usual_seconds(cell) + .3);
  EXPECT_EQ(measured_on(cell), "");
  cell.method.id = "my_method";
  EXPECT_EQ(measured_on(cell), "LGA");
}

TEST(Forecasts, CountByRow) {
  std::vector<Played> played = recorded("q2", 4);
  std::vector<const Cell*> complete, missing;
  Costs costs;
  for (Played& one : played) {
    if (one.cell.method.id == "lga_l") one.cell.method.id = one.cell.method.name = "my_method";
    const bool there = one.cell.method.id == "lga" && complete.size() < 5;
    (there ? complete : missing).push_back(&one.cell);
    if (there) costs.learn(one.cell, one.seconds);
  }
  const auto none = [](const Cell&) { return false; };
  const Forecast all = forecast(complete, missing, costs, 1, none);
  EXPECT_EQ(all.cells, 80u);
  EXPECT_EQ(all.there, 5u);
  std::map<std::string, Forecast::Row> rows;
  double seconds = 0;
  for (const Forecast::Row& row : all.rows) rows[row.name] = row, seconds += row.seconds;
  EXPECT_EQ(rows.size(), 8u);
  EXPECT_EQ(rows["lga"].cells, 12u);
  EXPECT_EQ(rows["lga"].there, 5u);
  EXPECT_EQ(rows["lga"].based_on, "this run's cells");
  EXPECT_EQ(rows["gcbc_dart"].based_on, "cells measured elsewhere");
  EXPECT_EQ(rows["my_method"].based_on, "LGA's cells");
  EXPECT_NEAR(all.wall_s, seconds, 1e-6) << "one worker";
  EXPECT_NEAR(rows["lga"].seconds / 7, 2.3, .5) << "as the five took";
  EXPECT_EQ(all.text(1), "75 cells to compute, 5 already computed: about 6 min with 1 worker");
  EXPECT_EQ(all.text(1, "finding causes"), "finding causes: 75 cells, about 6 min with 1 worker");
  EXPECT_GT(all.run_bytes, 75 * 28e3);
}

// A method that nobody has measured may take any time; what lgabench does for it is the least.
TEST(Forecasts, SayWhatIsUnknown) {
  std::vector<Played> played = recorded("q2", 4);
  std::vector<const Cell*> missing;
  Costs costs;
  for (Played& one : played) {
    if (one.cell.method.id == "lga_l") one.cell.method.id = one.cell.method.name = "my_method";
    missing.push_back(&one.cell);
  }
  const auto is_mine = [](const Cell& cell) { return cell.method.id == "my_method"; };
  const auto row_of = [](const Forecast& all) {
    const auto is_row = [](const Forecast::Row& row) { return row.name == "my_method"; };
    return *std::find_if(all.rows.begin(), all.rows.end(), is_row);
  };
  const Forecast all = forecast({}, missing, costs, 1, is_mine);
  EXPECT_TRUE(all.unknown);
  EXPECT_SAYS(all.text(1), "80 cells to compute, 0 already computed: unknown, at least ");
  EXPECT_TRUE(row_of(all).unknown);
  EXPECT_SAYS(row_of(all).based_on, "unknown");
  double least = 0;
  for (const Cell* cell : missing)
    if (is_mine(*cell)) least += least_seconds(*cell);
  EXPECT_NEAR(row_of(all).seconds, least, 1e-9);
  for (const Cell* cell : missing) {
    EXPECT_GT(least_seconds(*cell), 0);
    EXPECT_LE(least_seconds(*cell), usual_seconds(*cell));
  }
  for (const Played& one : played)
    if (is_mine(one.cell)) costs.learn(one.cell, one.seconds);
  const Forecast later = forecast({}, missing, costs, 1, is_mine);
  EXPECT_FALSE(later.unknown) << "its cells were played";
  EXPECT_EQ(row_of(later).based_on, "this run's cells");
  EXPECT_SAYS(later.text(1), ": about ");
}

// What an option counts is learnt that often, with any demonstrations.
TEST(Forecasts, CountUpdates) {
  Cell cell = recorded("q2", 4).front().cell;
  cell.method.id = cell.method.name = "diffusion";
  const auto learning = [&cell](int updates) {
    cell.method.options["updates"] = updates;
    return usual_seconds(cell) - least_seconds(cell);
  };
  EXPECT_EQ(measured_on(cell), "");
  EXPECT_GT(learning(1200), 10);
  EXPECT_NEAR(learning(12'000), 10 * learning(1200), 1e-6);
  const double few = learning(1200);
  cell.demonstrations *= 5;
  EXPECT_NEAR(learning(1200), few, 1e-6);
}

// The half of the most steps is played, in training and in tests.
TEST(Forecasts, CountSteps) {
  const std::vector<Played> one_step = recorded("q2", 4);
  Cell several = one_step.front().cell;
  Json scenario = *several.scenario;
  scenario["task"] = "errands";
  several.scenario = std::make_shared<const Json>(scenario);
  EXPECT_GT(least_seconds(several), 3 * least_seconds(one_step.front().cell));
  EXPECT_LT(least_seconds(several), 4 * least_seconds(one_step.front().cell));
}

TEST(Texts, OfCounts) {
  EXPECT_EQ(count_text("asked", 0, 112, 3), "asked 0 of 112");
  EXPECT_EQ(count_text("asked", 28, 112, 10), "asked 28 of 112, about 30 s left");
  EXPECT_EQ(count_text("asked", 112, 112, 40), "asked 112 of 112 in 40 s");
  EXPECT_EQ(count_text("asked", 1881, 0, 30), "asked 1881") << "nobody knows how many there will be";
  EXPECT_EQ(count_text("asked", 113, 112, 30), "asked 113");
}

TEST(Texts, OfTimeAndSize) {
  EXPECT_EQ(duration_text(0), "0 s");
  EXPECT_EQ(duration_text(89), "89 s");
  EXPECT_EQ(duration_text(90), "2 min");
  EXPECT_EQ(duration_text(3600), "1 h 0 min");
  EXPECT_EQ(size_text(950e3), "950 KB");
  EXPECT_EQ(size_text(47e6), "47 MB");
  EXPECT_EQ(size_text(1.24e9), "1.2 GB");
}

}  // namespace
}  // namespace lgabench

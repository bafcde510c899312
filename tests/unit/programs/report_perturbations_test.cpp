// How a policy breaks: curves over the levels of perturbations, their areas, losses and pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include <lgabench/core/random.hpp>
#include <lgabench/report/report.hpp>
#include <lgabench/statistics/bootstrap.hpp>

#include "report_run.hpp"

namespace lgabench {
namespace {

using Spec = FabricatedRun::Spec;
using Wins = std::vector<int>;  // of 20, at levels 1, 2, ...

// Plays a control and each level of each axis.
Spec perturbed(const std::string& method, int control, const std::vector<std::pair<std::string, Wins>>& axes) {
  Spec spec{method, 0};
  spec.arms = {{"control", control}};
  for (const auto& [axis, wins] : axes)
    for (std::size_t i = 0; i < wins.size(); ++i) {
      spec.arms.push_back({fmt::format("{}_{}", axis, i + 1), wins[i], {0}, .25});
      spec.arms.back().perturbation = {{axis, i + 1}};
    }
  return spec;
}

Json curve_of(const Json& summary, const std::string& method, const std::string& axis) {
  for (const Json& curve : summary.at("perturbations"))
    if (curve.at("method") == method && curve.at("axis") == axis) return curve;
  return nullptr;
}

const document::Section& section_of(const report::Report& report) {
  for (const document::Section& section : report.document.sections)
    if (section.id == "perturbations") return section;
  throw Error("no section");
}

const document::Grid& grid_named(const report::Report& report, const std::string& name) {
  for (const document::Grid* grid : report.document.grids())
    if (grid->name == name) return *grid;
  throw Error("no table " + name);
}

FabricatedRun& small(FabricatedRun& run) {
  Spec lga = perturbed("lga", 16, {{"segmentation", {16, 12, 6, 0}}, {"light_colour", {16, 16, 15, 17}}});
  lga.arms[1].unchanged = 20;
  lga.arms[2].unchanged = 3;
  run.add(lga);
  run.add(perturbed("gcbc_dart", 8, {{"segmentation", {8, 8, 8, 8}}, {"light_colour", {8, 6, 0, 0}}}));
  for (const auto& [row, wins] : {std::pair("oracle", Wins{20, 20, 15, 9}), {"random_object", {8, 8, 6, 3}}}) {
    Spec reference = perturbed(row, wins.front(), {{"segmentation", wins}, {"light_colour", Wins(4, wins.front())}});
    reference.kind = "reference", reference.demonstrations = 0;
    run.add(reference);
  }
  return run;
}

TEST(PerturbationCurves, PairEachLevelWithTheControl) {
  FabricatedRun run;
  report::write_report(small(run).save().path);
  const Json summary = read_json(run.path / "summary.json"), curve = curve_of(summary, "lga", "segmentation");
  EXPECT_EQ(curve["control"]["success"], .8);
  ASSERT_EQ(curve["levels"].size(), 4u);
  const Json& third = curve["levels"][2];
  EXPECT_EQ(third["level"], 3);
  EXPECT_EQ(third["name"], "4 pixels; 20 %, 20 %");
  EXPECT_EQ(third["success"], .3);
  EXPECT_EQ(third["change"]["difference"], -.5);
  EXPECT_EQ(third["lost"], 10);
  EXPECT_EQ(third["gained"], 0);
  EXPECT_EQ(third["p_mcnemar"], statistics::mcnemar(10, 0));
  EXPECT_EQ(third["change"]["p"], statistics::mcnemar(10, 0)) << "of one policy";
  EXPECT_EQ(third["change"]["low"], statistics::paired_difference(10, 0, 20).low);
  EXPECT_EQ(summary["rows"][third["row"].get<std::size_t>()]["arm"], "segmentation_3");
  EXPECT_EQ(summary["rows"][curve["control"]["row"].get<std::size_t>()]["arm"], "control");
  EXPECT_EQ(curve["levels"][0]["unchanged_inputs"], 20);
  EXPECT_EQ(curve["levels"][1]["unchanged_inputs"], 3);
  EXPECT_EQ(curve["levels"][3]["inputs"], 20);
}

// Of 20 episodes, as many of each in the order of `takings`.
std::vector<std::string> took(std::array<int, 4> counts) {
  std::vector<std::string> all;
  for (std::size_t what = 0; what < counts.size(); ++what)
    all.insert(all.end(), static_cast<std::size_t>(counts[what]), takings[what]);
  return all;
}

TEST(PerturbationCurves, SayWhatALevelOfInstructionTookAndHowMuchLanguageWasUsed) {
  FabricatedRun run;
  Spec hears = perturbed("lga", 18, {{"instruction", {0, 0, 2}}}),
       deaf = perturbed("gcbc_seg", 12, {{"instruction", {12, 12, 12}}});
  hears.arms[0].took = took({18, 1, 1, 0}), hears.arms[3].took = took({2, 14, 1, 3});
  hears.arms[1].took = hears.arms[2].took = took({0, 0, 0, 20});
  for (auto& arm : deaf.arms) arm.took = took({12, 4, 3, 1});
  run.add(hears);
  run.add(deaf);
  const report::Report report = report::write_report(run.save().path);
  const Json summary = read_json(run.path / "summary.json"), curve = curve_of(summary, "lga", "instruction");
  EXPECT_EQ(curve["levels"][2]["name"], "another command");
  EXPECT_EQ(curve["control"]["took"], Json({{"own", 18}, {"other", 1}, {"third", 1}}));
  EXPECT_EQ(curve["levels"][2]["took"], Json({{"own", 2}, {"other", 14}, {"third", 1}, {"none", 3}}));
  EXPECT_EQ(curve["levels"][0]["took"], Json({{"none", 20}}));
  EXPECT_FALSE(curve["levels"][0].contains("use_of_language") || curve["levels"][1].contains("use_of_language"));
  const Json use = curve["levels"][2]["use_of_language"];
  EXPECT_DOUBLE_EQ(use["difference"], 13 / 20.) << "14 took it, 1 did in the control";
  EXPECT_GT(use["low"], .3);
  EXPECT_LT(use["high"], .9);
  EXPECT_EQ(curve_of(summary, "gcbc_seg", "instruction")["levels"][2]["use_of_language"]["difference"], 0);
  const document::Grid& grid = grid_named(report, "perturbations");
  const auto is_use = [](const document::TableCell& head) { return head.spans.front().text == "use of language"; };
  const auto column = std::find_if(grid.heads.begin(), grid.heads.end(), is_use);
  ASSERT_NE(column, grid.heads.end());
  const auto& cell = grid.rows.front().cells.at(static_cast<std::size_t>(column - grid.heads.begin()));
  EXPECT_EQ(cell.spans.front().text, "+0.65");
  FabricatedRun without;
  const report::Report plain = report::write_report(small(without).save().path);
  const auto& heads = grid_named(plain, "perturbations").heads;
  EXPECT_TRUE(std::none_of(heads.begin(), heads.end(), is_use));
}

TEST(PerturbationCurves, CorrectOverAllLevelsOfAllAxesOfARow) {
  FabricatedRun run;
  report::write_report(small(run).save().path);
  const Json summary = read_json(run.path / "summary.json");
  std::vector<double> p;
  std::vector<Json> levels;
  for (const char* axis : {"segmentation", "light_colour"}) {
    const Json curve = curve_of(summary, "lga", axis);
    for (const Json& level : curve["levels"]) {
      p.push_back(level["change"]["p"]);
      levels.push_back(level);
    }
  }
  ASSERT_EQ(p.size(), 8u);
  const std::vector<double> adjusted = statistics::holm(p);
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_EQ(levels[i]["p_holm"], adjusted[i]) << i;
  EXPECT_EQ(curve_of(summary, "lga", "segmentation")["tests"], 8);
  EXPECT_EQ(curve_of(summary, "lga", "segmentation")["first_loss"], 3) << "level 2 alone: p .125";
  EXPECT_EQ(curve_of(summary, "lga", "light_colour")["first_loss"], nullptr);
  EXPECT_EQ(curve_of(summary, "oracle", "segmentation")["levels"][0]["p_holm"], nullptr) << "a reference row";
}

TEST(PerturbationCurves, HaveTheAreaOfTrapezoidsRelativeToTheControl) {
  FabricatedRun run;
  report::write_report(small(run).save().path);
  const Json summary = read_json(run.path / "summary.json");
  const Json area = curve_of(summary, "lga", "segmentation")["area"];
  EXPECT_DOUBLE_EQ(area["relative"].get<double>(), (16 / 2. + 16 + 12 + 6 + 0 / 2.) / 4 / 16);
  EXPECT_LT(area["low"], area["relative"]);
  EXPECT_GT(area["high"], area["relative"]);
  EXPECT_DOUBLE_EQ(curve_of(summary, "gcbc_dart", "segmentation")["area"]["relative"].get<double>(), 1);
  EXPECT_EQ(curve_of(summary, "oracle", "segmentation")["area"], nullptr);

  FabricatedRun apart, never;
  Spec first_and_last = perturbed("lga", 16, {{"segmentation", {16, 0}}});
  first_and_last.arms.back().perturbation = {{"segmentation", 4}};
  apart.add(first_and_last);
  report::write_report(apart.save().path);
  EXPECT_DOUBLE_EQ(
      curve_of(read_json(apart.path / "summary.json"), "lga", "segmentation")["area"]["relative"].get<double>(),
      (1 + 3 / 2.) / 4)
      << "levels lie as far apart as their numbers";
  never.add(perturbed("lga", 0, {{"segmentation", {0, 1}}}));
  report::write_report(never.save().path);
  EXPECT_EQ(curve_of(read_json(never.path / "summary.json"), "lga", "segmentation")["area"], nullptr)
      << "nothing of nothing";
}

TEST(PerturbationCurves, AreOverScenariosAndSeeds) {
  FabricatedRun run;
  for (const char* scenario : {"heart", "letter"})
    for (int seed = 0; seed < 2; ++seed) {
      Spec spec = perturbed("lga", 16, {{"segmentation", {seed == 0 ? 8 : 4}}});
      spec.scenario = scenario, spec.seed = seed;
      run.add(spec);
    }
  Spec without{"lga", 0, "ring"};
  without.arms = {{"control", 4}};
  run.add(without);
  report::write_report(run.save().path);
  const Json curve = curve_of(read_json(run.path / "summary.json"), "lga", "segmentation");
  EXPECT_NEAR(curve["control"]["success"].get<double>(), .8, 1e-12) << "of the scenarios that have the axis";
  EXPECT_EQ(curve["control"]["row"], nullptr);
  EXPECT_NEAR(curve["levels"][0]["success"].get<double>(), .3, 1e-12);
  EXPECT_EQ(curve["levels"][0]["lost"], 2 * (8 + 12));
  EXPECT_LT(curve["levels"][0]["change"]["p"], .001);
  EXPECT_NEAR(curve["area"]["relative"].get<double>(), (1 + .3 / .8) / 2, 1e-12);
}

TEST(PerturbationSection, ShowsEveryLevelBesideTheControlAndNoMeanOverAxes) {
  FabricatedRun run;
  const report::Report report = report::write_report(small(run).save().path);
  const document::Grid& curves = grid_named(report, "perturbations");
  std::vector<std::string> heads, first;
  for (const document::TableCell& head : curves.heads) heads.push_back(head.text());
  for (const document::TableCell& cell : curves.rows.front().cells) first.push_back(cell.text());
  EXPECT_EQ(heads, (std::vector<std::string>{"method", "axis", "control", "1", "2", "3", "4", "area",
                                             "first significant loss", "unchanged input"}));
  ASSERT_EQ(first.size(), heads.size());
  EXPECT_EQ(first[2], "0.80");
  EXPECT_EQ(first[4], "0.60");
  EXPECT_EQ(first[5], "0.30*");
  EXPECT_EQ(first[8], "3");
  EXPECT_EQ(first[9], "23 of 80");
  std::vector<std::string> references;
  for (const document::Grid::Row& row : curves.rows)
    if (row.reference) references.push_back(row.cells[0].text() + " " + row.cells[1].text());
  EXPECT_EQ(references, std::vector<std::string>{"oracle segmentation"}) << "only where it is no bound of its control";

  const document::Grid& areas = grid_named(report, "perturbations_areas_cells_mujoco_20");
  EXPECT_EQ(areas.heads.size(), 4u) << "method, control, and each axis";
  EXPECT_EQ(areas.rows.size(), 2u);
  for (const char* file : {"perturbations_cells_mujoco_20", "perturbations_segmentation_cells_mujoco_20",
                           "perturbations_light_colour_cells_mujoco_20"})
    for (const char* ending : {".svg", ".pdf"})
      EXPECT_TRUE(fs::exists(run.path / "figures" / (file + std::string(ending))));
  const std::string terminal = document::terminal(report.document, run.path);
  EXPECT_SAYS(terminal, "segmentation");
  EXPECT_SILENT(terminal, "segmentation_3");  // levels are no arms of the table of success
  EXPECT_SAYS(document::markdown(section_of(report)),
              "**LGA** loses significantly along segmentation from level 3; not along light_colour");
}

TEST(PerturbationSection, HasNoNumberThatIsNotTheSummarys) {
  FabricatedRun run;
  report::write_report(small(run).save().path);
  const std::string page = read_file(run.path / "report.html");
  const Json summary = read_json(run.path / "summary.json");
  const std::regex value("<span data-value=\"(/perturbations/[^\"]*)\">([^<]*)</span>");
  int seen = 0;
  for (std::sregex_iterator it(page.begin(), page.end(), value), end; it != end; ++it, ++seen) {
    const std::string text = it->str(2);
    const std::size_t dot = text.find('.');
    const double half = dot == std::string::npos ? 0 : .5 * std::pow(10, -static_cast<double>(text.size() - dot - 1));
    EXPECT_NEAR(std::stod(text), summary.at(Json::json_pointer(it->str(1))).get<double>(), half + 1e-9) << it->str(1);
  }
  EXPECT_GT(seen, 150);
}

TEST(PerturbationSection, IsThereOnlyWhereArmsArePerturbed) {
  FabricatedRun run;
  run.add({"lga", 15});
  report::write_report(run.save().path);
  EXPECT_FALSE(read_json(run.path / "summary.json").contains("perturbations"));
  EXPECT_SILENT(read_file(run.path / "report.html"), "How a policy breaks");
}

TEST(PerturbationSection, AnAxisThatIsNotInstalledHasItsCurve) {
  FabricatedRun run;
  run.add(perturbed("lga", 16, {{"moonlight", {4}}}));
  report::write_report(run.save().path);
  const Json curve = curve_of(read_json(run.path / "summary.json"), "lga", "moonlight");
  EXPECT_EQ(curve["levels"][0]["name"], "");
  EXPECT_EQ(curve["first_loss"], 1);
}

TEST(PerturbationSection, ACellWithoutItsRecordFails) {
  FabricatedRun run;
  run.add({"lga", 15});
  fs::remove(run.add(perturbed("gcbc_dart", 16, {{"segmentation", {4}}})) / "perturbed.jsonl");
  const report::Report report = report::write_report(run.save().path);
  ASSERT_EQ(report.summary.failed.size(), 1u);
  EXPECT_SAYS(report.summary.failed[0].reason, "perturbed.jsonl");
}

TEST(Settings, SayWhatDemonstrationsWereSeenThrough) {
  FabricatedRun run;
  Spec spec{"lga", 15};
  spec.train_on = {{"sensor_noise", 2}};
  run.add(spec);
  EXPECT_SAYS(table_text(run.save().path), "q1: methods saw their demonstrations through sensor_noise, level 2\n");
}

// Two rows of which one wins what the other does, now and then less.
TEST(SharedResamples, HaveTheRatioOfTwoRows) {
  RandomStream random("ratio");
  constexpr int trials = 120, scenes = 60;
  int covered = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> whole, part;
    for (int i = 0; i < scenes; ++i) {
      whole.push_back(random.uniform() < .7);
      part.push_back(whole.back() > 0 && random.uniform() < .6);
    }
    const statistics::SharedResamples resamples({{{part}}, {{whole}}}, false, "trial" + std::to_string(trial));
    const auto interval = resamples.ratio(0, 1);
    ASSERT_TRUE(interval);
    covered += interval->low <= .6 && .6 <= interval->high;
  }
  EXPECT_GE(covered, 108) << "of 120, 95 % of which are 114";
  const statistics::SharedResamples none({{{std::vector<double>(20, 0)}}, {{std::vector<double>(20, 0)}}}, true,
                                         "none");
  EXPECT_FALSE(none.ratio(0, 1));
}

}  // namespace
}  // namespace lgabench

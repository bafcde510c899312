// Learning curves, and the page over several runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <lgabench/report/index.hpp>
#include <lgabench/report/report.hpp>

#include "report_run.hpp"

namespace lgabench {
namespace {

using Spec = FabricatedRun::Spec;

const document::Chart& chart_named(const document::Document& document, const std::string& file) {
  const auto charts = document.charts();
  const auto found = std::find_if(charts.begin(), charts.end(), [&](const auto* chart) { return chart->file == file; });
  if (found == charts.end()) throw std::runtime_error("no chart " + file);
  return **found;
}

// The cell's training.jsonl in another's words.
void log(const fs::path& cell, const std::string& lines) {
  write_file(cell / "training.jsonl", lines);
  Json status = read_json(cell / "status.json");
  status["files"]["training.jsonl"] = sha256(lines);
  write_file(cell / "status.json", canonical(status) + "\n");
}

TEST(LearningCurves, AreMeansOfTheCellsWithTheMostDemonstrations) {
  FabricatedRun run;
  for (int seed = 0; seed < 2; ++seed) {
    Spec lga{"lga", 15, "heart", 50, seed};
    lga.curves = {{"validation", seed ? 4. : 2.}};
    run.add(lga);
    run.add({"lga", 3, "heart", 10, seed});
    run.add({"gcbc_dart", 3, "heart", 50, seed});
  }
  const report::Report report = report::write_report(run.save().path);
  const document::Chart& loss = chart_named(report.document, "training_loss_cells_mujoco");
  ASSERT_EQ(loss.series.size(), 2u);
  EXPECT_EQ(loss.series[0].name, "LGA");
  ASSERT_EQ(loss.series[0].points.size(), 3u);
  EXPECT_EQ(loss.series[0].points[2].x, 3);
  EXPECT_EQ(loss.series[0].points[2].y, 1. / 3) << "a loss that falls to a third is on a plain scale";

  // The mean of 2 and 4, then of 1 and 2; a curve that one method alone logs.
  const document::Chart& validation = chart_named(report.document, "training_validation_cells_mujoco");
  ASSERT_EQ(validation.series.size(), 1u);
  EXPECT_EQ(validation.series[0].points[0].y, 3);
  EXPECT_EQ(validation.series[0].points[1].y, 1.5);
  EXPECT_LE(validation.bottom, 1);
  EXPECT_GE(validation.top, 3);
  for (const char* file : {"training_loss_cells_mujoco.svg", "training_validation_cells_mujoco.pdf"})
    EXPECT_TRUE(fs::exists(run.path / "figures" / file)) << file;
  EXPECT_SAYS(read_file(run.path / "report.html"), "<h2 id=\"training-title\">Learning curves</h2>");
}

TEST(LearningCurves, ThatFallFarStandOnPowersOfTen) {
  FabricatedRun run;
  Spec spec{"lga", 15};
  spec.curves = {{"far", 1e-9}};
  run.add(spec);
  Spec other{"gcbc_dart", 15};
  other.curves = {{"far", 1000.}};
  run.add(other);
  const report::Report report = report::write_report(run.save().path);
  const document::Chart& chart = chart_named(report.document, "training_far_cells_mujoco");
  EXPECT_NEAR(chart.series[1].points[0].y, 3, 1e-9);
  EXPECT_LE(chart.levels.front().at, chart.series[0].points[2].y);
  EXPECT_GE(chart.levels.back().at, 3);
  EXPECT_EQ(chart.levels.back().label, "1000");
}

TEST(LearningCurves, AreThereOnlyWhereSomethingWasLogged) {
  FabricatedRun run;
  log(run.add({"lga", 15}), "");
  report::write_report(run.save().path);
  EXPECT_SILENT(read_file(run.path / "report.html"), "Learning curves");
}

TEST(LearningCurves, OfAnyNumbersHaveFewTicks) {
  for (const auto& [lowest, highest] : {std::pair(1.8e19, 1.8e19),
                                        {3e6, 3e6},
                                        {-1e100, -1e100},
                                        {1e100, 1e100},
                                        {-1e100, 1e100},
                                        {0., 1e100},
                                        {5e-324, 1e100},
                                        {0., 0.},
                                        {.5, .5 + 1e-15},
                                        {0., 5e-324},
                                        {-3., 1.}}) {
    SCOPED_TRACE(fmt::format("{} to {}", lowest, highest));
    FabricatedRun run;
    for (const auto& [method, value] : {std::pair("lga", lowest), {"gcbc_dart", highest}})
      log(run.add({method, 15}), fmt::format("{{\"epoch\":9223372036854775807,\"loss\":{},\"steps\":1}}\n", value));
    const report::Report report = report::write_report(run.save().path);
    const document::Chart& chart = chart_named(report.document, "training_loss_cells_mujoco");
    for (const auto* ticks : {&chart.ticks, &chart.levels}) {
      EXPECT_GE(ticks->size(), 2u);
      EXPECT_LE(ticks->size(), 30u);
      for (std::size_t i = 1; i < ticks->size(); ++i) EXPECT_LT((*ticks)[i - 1].at, (*ticks)[i].at);
    }
    for (const document::Series& series : chart.series) {
      EXPECT_LE(chart.bottom, series.points[0].y);
      EXPECT_GE(chart.top, series.points[0].y);
    }
    EXPECT_TRUE(std::isfinite(chart.top - chart.bottom));
    const std::string figure = read_file(run.path / "figures/training_loss_cells_mujoco.svg");
    EXPECT_SILENT(figure, "nan");
    EXPECT_SILENT(figure, "inf");
  }
}

TEST(LearningCurves, ALineThatIsNoneCostsItsOwnCell) {
  for (const char* line : {"{\"epoch\":1,\"loss\":\"low\",\"steps\":1}", "{\"epoch\":0,\"loss\":1,\"steps\":1}",
                           "{\"epoch\":1,\"loss\":1e101,\"steps\":1}", "{\"epoch\":1,\"loss\":1}"}) {
    FabricatedRun run;
    const fs::path cell = run.add({"lga", 15});
    run.add({"gcbc_dart", 15});
    log(cell, std::string(line) + "\n");
    const report::Report report = report::write_report(run.save().path);
    ASSERT_EQ(report.summary.failed.size(), 1u) << line;
    EXPECT_EQ(report.summary.failed[0].key, cell.filename());
    EXPECT_SAYS(report.summary.failed[0].reason, "cannot be read: training.jsonl: line 1: /");
    EXPECT_EQ(chart_named(report.document, "training_loss_cells_mujoco").series.size(), 1u);
  }
}

TEST(Index, HasEveryRunAndItsMethodsBestFirst) {
  TemporaryDirectory place;
  FabricatedRun a, b;
  a.add({"lga", 10});
  b.add({"my_method", 15});
  b.add({"lga", 20, "letter"});
  std::vector<report::Report> reports;
  reports.push_back(report::write_report(a.save().path));
  reports.push_back(report::write_report(b.save().path));
  FabricatedRun c;
  c.add({"my_method", 15});
  reports.push_back(report::write_report(c.save().path));
  const document::Document index = report::write_index(reports, place.path / "index.html");
  const std::vector<const document::Grid*> grids = index.grids();
  ASSERT_EQ(grids.size(), 2u);
  ASSERT_EQ(grids[0]->rows.size(), 3u);
  const std::string link = grids[0]->rows[0].cells[0].link;
  EXPECT_TRUE(fs::equivalent(place.path / link, a.path / "report.html")) << link;

  // a and c share a setting; b has another set of scenarios.
  const auto& rows = grids[1]->rows;
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].group.text(), rows[1].group.text());
  EXPECT_NE(rows[1].group.text(), rows[2].group.text());
  EXPECT_EQ(rows[0].cells[0].text(), "my_method");
  EXPECT_EQ(rows[0].cells[2].text(), "0.75");
  EXPECT_EQ(rows[1].cells[0].text(), "LGA");
  const std::string page = read_file(place.path / "index.html");
  EXPECT_SAYS(page, "<a href=\"" + link + "\">");
}

TEST(ErrorCurves, AreOfOneKindOfErrorsAndBeginWithTheRowWithout) {
  FabricatedRun run;
  Spec other{"lga_s", 3};
  other.options = {{"epochs", 750}};
  run.add(other);
  const auto add = [&run](int won, const Json& errors, const std::string& suffix, const char* failure) {
    Spec spec{"lga" + suffix, won};
    spec.options = {{"epochs", 9}};
    spec.provenance = "truth";
    spec.selection_errors = errors;
    spec.failure = failure;
    run.add(spec);
  };
  add(20, nullptr, "", "missed_object");
  add(16, {{"missing", .1}}, "+missing=0.1", "missed_object");
  add(8, {{"missing", .3}}, "+missing=0.3", "abstraction_empty");
  add(2, {{"missing", .3}, {"added", .1}}, "+added=0.1+missing=0.3", "missed_object");
  const report::Report report = report::write_report(run.save().path);
  const Json summary = read_json(run.path / "summary.json");
  ASSERT_EQ(summary.at("error_curves").size(), 1u);
  const Json& curve = summary["error_curves"][0];
  EXPECT_EQ(curve["method"], "lga");
  EXPECT_EQ(curve["errors"], "missing");
  ASSERT_EQ(curve["points"].size(), 3u);
  EXPECT_EQ(curve["points"][0]["p"], 0);
  EXPECT_EQ(curve["points"][2]["success"], .4);
  EXPECT_EQ(curve["points"][2]["empty"], .6);
  EXPECT_EQ(summary["rows"][curve["points"][1]["row"].get<std::size_t>()]["method"], "lga+missing=0.1");
  EXPECT_NEAR(curve["slope"].get<double>(), -.2, 1e-12);
  EXPECT_FALSE(curve.contains("low")) << "one policy tells of no other";
  const document::Chart& chart = chart_named(report.document, "errors_missing_cells_mujoco_test_20");
  ASSERT_EQ(chart.series.size(), 1u);
  EXPECT_EQ(chart.series[0].name, "LGA epochs=9") << "as tables name the row";
  std::string sources;
  for (const document::Note& note : report.document.notes) sources += note.text + "\n";
  EXPECT_SAYS(sources, "φ̂ of LGA missing=0.1 epochs=9: true φ̂ with errors made in it: no human data");
  EXPECT_SAYS(sources, "φ̂ of LGA epochs=9: true φ̂: no human data");
  EXPECT_SAYS(read_file(run.path / "report.html"), "What an error of the Selection costs");

  const std::vector<const document::Grid*> grids = report.document.grids();
  const auto named = [&](const std::string& name) {
    return *std::find_if(grids.begin(), grids.end(), [&](const auto* grid) { return grid->name == name; });
  };
  const document::Grid& errors = *named("errors_cells_mujoco_test_20");
  std::vector<std::string> heads, values;
  for (const document::TableCell& head : errors.heads) heads.push_back(head.text());
  EXPECT_EQ(heads, (std::vector<std::string>{"method", "no errors", "missing 0.1", "missing 0.3", "slope per 0.1",
                                             "missing 0.3, added 0.1"}));
  ASSERT_EQ(errors.rows.size(), 2u);
  for (const document::TableCell& cell : errors.rows[0].cells) values.push_back(cell.text());
  EXPECT_EQ(values, (std::vector<std::string>{"LGA epochs=9", "1.00", "0.80", "0.40, 0.60 empty", "-0.20", "0.10"}));
  for (const document::Grid::Row& row : named("cells_mujoco_mean")->rows)
    EXPECT_SILENT(row.cells[0].text(), "missing") << "rows with errors are in the table of errors alone";
}

TEST(ErrorCurves, OfSeveralPoliciesHaveTheirSlopesInterval) {
  FabricatedRun run;
  for (int seed = 0; seed < 3; ++seed)
    for (const auto& [won, missing] : {std::pair(20, 0.), {12, .2}, {4 + 2 * seed, .4}}) {
      Spec spec{missing == 0 ? "lga" : fmt::format("lga+missing={}", missing), won, "heart", 20, seed};
      if (missing != 0) spec.selection_errors = {{"missing", missing}};
      run.add(spec);
    }
  report::write_report(run.save().path);
  const Json curve = read_json(run.path / "summary.json").at("error_curves").at(0);
  EXPECT_NEAR(curve["slope"].get<double>(), .1 * (.3 - 1) / .4, 1e-12);
  EXPECT_LT(curve["low"], curve["slope"]);
  EXPECT_GT(curve["high"], curve["slope"]);
  EXPECT_LT(curve["high"], -.05) << "60 scenes tell it from 0";
}

}  // namespace
}  // namespace lgabench

// Reports of fabricated runs with several arms and several commands.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include <lgabench/report/report.hpp>
#include <lgabench/statistics/paper.hpp>
#include <lgabench/statistics/summary.hpp>

#include "report_run.hpp"

namespace lgabench {
namespace {

using Arm = FabricatedRun::Arm;
using Spec = FabricatedRun::Spec;

// As q2: one command; LGA's control and texture act alike.
Spec shifted(const std::string& method, const std::string& scenario, int seed, int control, int texture, int hard) {
  Spec spec{method, 0, scenario, 50, seed};
  const double elsewhere = method == "lga" ? 0.5 : 0.25;
  spec.arms = {{"control", control}, {"texture", texture, {0}, elsewhere}, {"hard", hard, {0}, 0.125}};
  return spec;
}

// As q3: two commands that are trained on, and one that is not.
Spec ambiguous(const std::string& method, int seen, int unseen) {
  Spec spec{method, 0, "q3_fruit", 50};
  spec.arms = {{"seen", seen, {0, 1}}, {"unseen", unseen, {2}}};
  spec.commands = {{"Bring me a tomato.", true}, {"Bring me an apple.", true}, {"Bring me a fruit.", false}};
  spec.of_commands[2]["truth"] = {{"target", {{"object_types", {"heart", "star"}}, {"textures", "ALL"}}}};
  return spec;
}

Json rows_of(const FabricatedRun& run) {
  report::write_report(run.save().path);
  const Json summary = read_json(run.path / "summary.json");
  Json rows;
  for (const Json& row : summary.at("rows"))
    rows[row.at("scenario").get<std::string>() + " " + row.at("method").get<std::string>() + " " +
         row.at("arm").get<std::string>()] = row;
  return rows;
}

TEST(Arms, ChangeIsTheMeanOfPairedDifferences) {
  FabricatedRun run;
  for (int seed = 0; seed < 3; ++seed) {  // differences -.5, -.4, -.3 and -.1 thrice
    run.add(shifted("gcbc_dart", "q2_heart", seed, 15, 5 + 2 * seed, 15));
    run.add(shifted("gcbc_dart", "q2_bowl", seed, 10, 8, 10));
  }
  const Json rows = rows_of(run);
  EXPECT_EQ(rows.at("q2_heart gcbc_dart control").at("shift"), nullptr);
  const Json heart = rows.at("q2_heart gcbc_dart texture").at("shift");
  EXPECT_EQ(heart.at("against"), "control");
  EXPECT_NEAR(heart.at("difference"), -0.4, 1e-12);
  EXPECT_FALSE(heart.at("same_actions"));
  // The scenarios are fixed: what moves the mean are 20 scenes in each, shared by three seeds.
  const Json mean = rows.at("(mean) gcbc_dart texture").at("shift");
  EXPECT_NEAR(mean.at("difference"), -0.25, 1e-12);
  EXPECT_NEAR(mean.at("high").get<double>(), -.13, .04);
  EXPECT_NEAR(mean.at("low").get<double>(), -.38, .04);
  // Nothing changed: no difference, and the width that 60 scenes leave open.
  const Json hard = rows.at("q2_heart gcbc_dart hard").at("shift");
  EXPECT_EQ(hard.at("difference"), 0.0);
  EXPECT_LT(hard.at("low"), -0.01);
  EXPECT_GT(hard.at("high"), 0.01);
  EXPECT_FALSE(hard.at("same_actions"));
}

TEST(Arms, SameActionsAreMarkedForMethodsAlone) {
  FabricatedRun run;
  run.add(shifted("lga", "q2_heart", 0, 20, 19, 10));
  Spec other = shifted("lga", "q2_heart", 1, 20, 20, 10);
  run.add(other);
  Spec constant = shifted("constant_action", "q2_heart", 0, 2, 2, 2);
  constant.kind = "reference";
  constant.arms[1].action = 0.5;
  run.add(constant);
  Json rows = rows_of(run);
  EXPECT_TRUE(rows.at("q2_heart lga texture").at("shift").at("same_actions"));
  EXPECT_FALSE(rows.at("q2_heart lga hard").at("shift").at("same_actions"));
  EXPECT_TRUE(rows.at("q2_heart constant_action texture").at("shift").at("same_actions"));
  const std::string text = table_text(run.path);
  EXPECT_SAYS(text, "= the same actions as in control.");

  // One policy of three that acts otherwise, in all its scenes: not the same.
  other.seed = 2;
  other.arms[1].action = 0.51;
  run.add(other);
  rows = rows_of(run);
  EXPECT_FALSE(rows.at("q2_heart lga texture").at("shift").at("same_actions"));
  EXPECT_SILENT(table_text(run.path), "the same actions");
}

TEST(Arms, NoActionIsNotTheSameAction) {
  FabricatedRun run;
  Spec spec = shifted("lga", "q2_heart", 0, 0, 0, 0);
  spec.failure = "abstraction_empty";
  for (Arm& arm : spec.arms) arm.action = std::nan("");
  run.add(spec);
  EXPECT_FALSE(rows_of(run).at("q2_heart lga texture").at("shift").at("same_actions"));
}

TEST(Arms, OfOtherCommandsAreNotPaired) {
  FabricatedRun run;
  run.run["suite"] = "q3";
  run.add(ambiguous("lga", 20, 15));
  run.add(ambiguous("gcbc_dart", 10, 5));
  const Json rows = rows_of(run);
  EXPECT_EQ(rows.at("q3_fruit lga unseen").at("shift"), nullptr);
  EXPECT_EQ(rows.at("q3_fruit lga unseen").at("success"), 0.75);
  EXPECT_SILENT(table_text(run.path), "change against");
  EXPECT_SILENT(read_file(run.path / "report.md"), "Change against");
}

// A command and two paraphrases, of which the second may be ambiguous.
Spec paraphrased(const std::string& method, const std::string& scenario, int original, int synonym, int implied,
                 bool is_ambiguous) {
  Spec spec{method, 0, scenario, 50};
  spec.arms = {{"original", original, {0}}, {"synonym", synonym, {1}}, {"implied", implied, {2}}};
  spec.commands = {{"Bring me the heart.", true}, {"Fetch me the heart.", false}, {"I need its symbol.", false}};
  spec.of_commands = {{1, {{"arm", "synonym"}}}, {2, {{"arm", "implied"}}}};
  if (is_ambiguous) spec.of_commands[2]["ambiguous"] = true;
  return spec;
}

TEST(Arms, OfAParaphraseArePairedAndEnterNoMeanWhereItIsAmbiguous) {
  FabricatedRun run;
  run.run["suite"] = "paraphrases";
  for (const char* method : {"lga", "gcbc_dart"}) {
    run.add(paraphrased(method, "clear", 20, 18, 10, false));
    Spec open = paraphrased(method, "open", 16, 16, 0, true);
    open.selected[1] = {{"object_types", {"heart"}}, {"textures", {"red"}}};
    run.add(open);
  }
  const Json rows = rows_of(run);
  EXPECT_NEAR(rows.at("clear lga synonym").at("shift").at("difference"), -.1, 1e-12);
  EXPECT_EQ(rows.at("clear lga synonym").at("shift").at("selected_otherwise"), 0.);
  EXPECT_EQ(rows.at("open lga synonym").at("shift").at("selected_otherwise"), 1.);
  EXPECT_EQ(rows.at("(mean) lga synonym").at("shift").at("selected_otherwise"), .5);
  EXPECT_FALSE(rows.at("(mean) gcbc_dart synonym").at("shift").contains("selected_otherwise")) << "selects nothing";
  EXPECT_EQ(rows.at("open lga implied").at("marks"), Json{"ambiguous"});
  EXPECT_EQ(rows.at("open lga implied").at("success"), 0.) << "shown";
  EXPECT_EQ(rows.at("(mean) lga implied").at("success"), .5) << "in no mean";
  EXPECT_EQ(rows.at("(mean) lga implied").at("marks"), Json::array());
  EXPECT_NEAR(rows.at("(mean) lga implied").at("shift").at("difference"), -.5, 1e-12);
  const std::string text = table_text(run.path);
  EXPECT_SAYS(text, "implied (1 of 2): the mean is over clear; in the others its words are ambiguous (?).");
  EXPECT_SAYS(text, "? ambiguous words, by which a person might mean something else: shown, in no mean.");
  EXPECT_SAYS(text, "commands for which something else was selected than in original, share");
}

TEST(Arms, ThatOneScenarioHasAloneHaveTheirMeanOverIt) {
  FabricatedRun run;
  run.run["suite"] = "q3";
  for (const char* method : {"lga", "gcbc_dart"}) {
    run.add(ambiguous(method, 20, 15));
    Spec utensil = ambiguous(method, 16, 12);
    utensil.scenario = "q3_utensil";
    utensil.arms.insert(utensil.arms.begin() + 1, {"seen_varied", 12, {0, 1}, .25});
    run.add(utensil);
  }
  const Json rows = rows_of(run);
  EXPECT_EQ(rows.at("q3_utensil lga seen_varied").at("success"), .6);
  EXPECT_EQ(rows.at("q3_utensil lga seen_varied").at("marks"), Json::array());
  EXPECT_NEAR(rows.at("q3_utensil lga seen_varied").at("shift").at("difference"), -.2, 1e-12);
  EXPECT_EQ(rows.at("(mean) lga seen_varied").at("success"), .6);
  EXPECT_EQ(rows.at("(mean) lga seen_varied").at("marks"), Json::array()) << "it lacks no scenario that has the arm";
  EXPECT_FALSE(rows.contains("q3_fruit lga seen_varied"));
  EXPECT_EQ(rows.at("(mean) lga unseen").at("marks"), Json::array());
  const std::string text = table_text(run.path);
  EXPECT_SAYS(text, "seen, varied (1 of 2): the mean is over q3_utensil; no other scenario has this arm.");
  EXPECT_SILENT(text, "‡");
  Spec utensil = ambiguous("human", 16, 12);  // and no q3_fruit, which has the arm
  utensil.scenario = "q3_utensil";
  run.add(utensil);
  EXPECT_EQ(rows_of(run).at("(mean) human seen").at("marks"), Json{"incomplete"});
}

TEST(Arms, SayHowManyDemonstrationsSeveralCommandsHad) {
  EXPECT_EQ(statistics::Table().demonstrations_text(1), "1 demonstration");
  FabricatedRun run;
  run.run["suite"] = "q3";
  run.add(ambiguous("lga", 20, 15));
  rows_of(run);
  EXPECT_SAYS(read_file(run.path / "report.md"), "### demonstrations: 50 per command, 100 in all");
  EXPECT_SAYS(table_text(run.path), "\ndemonstrations: 50 per command, 100 in all");
}

TEST(Paper, BarsBelongToTheirScenarios) {
  const statistics::PaperValues q2 = statistics::paper_values("q2"), q3 = statistics::paper_values("q3");
  for (const auto& [scenario, rate] :
       std::map<std::string, double>{{"q2_heart", .18}, {"q2_letter", .07}, {"q2_bowl", .18}, {"q2_block", 0}})
    EXPECT_EQ(q2.find(scenario, "GCBC-DART", 50), rate) << scenario;
  EXPECT_EQ(q2.find("q2_bowl", "LGA-S", 50), .97);
  for (const auto& [scenario, rate] :
       std::map<std::string, double>{{"q3_fruit", .13}, {"q3_food", .18}, {"q3_utensil", .35}})
    EXPECT_EQ(q3.find(scenario, "GCBC-DART", 50), rate) << scenario;
  EXPECT_EQ(q3.find("q3_fruit", "LGA", 10), std::nullopt);
  EXPECT_TRUE(statistics::paper_values("factorial").rates.empty());

  const statistics::PaperValues q1 = statistics::paper_values("q1");
  EXPECT_EQ(q1.find(statistics::mean_scenario, "LGA", 50), .747);
  EXPECT_EQ(q1.error(statistics::mean_scenario, "LGA", 50), .078);
  EXPECT_EQ(q1.error(statistics::mean_scenario, "GCBC-SEG", 10), .012);
  for (const int n : {10, 20, 30, 40, 50})
    EXPECT_FALSE(q1.find(statistics::mean_scenario, "GCBC-DART", n))
        << "the figure's curve is another row's error bars";
  EXPECT_FALSE(q2.error("q2_heart", "LGA", 50)) << "the figure has none";
}

TEST(Commands, EachHasItsOwnSelection) {
  FabricatedRun run;
  run.add(ambiguous("lga", 20, 15));
  const Json rows = rows_of(run);
  const Json seen = rows.at("q3_fruit lga seen").at("phi"), unseen = rows.at("q3_fruit lga unseen").at("phi");
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen.at(1).at("utterance"), "Bring me an apple.");
  EXPECT_TRUE(seen.at(1).at("seen"));
  ASSERT_EQ(unseen.size(), 1u);
  EXPECT_EQ(unseen.at(0).at("utterance"), "Bring me a fruit.");
  EXPECT_FALSE(unseen.at(0).at("seen"));
}

TEST(Figures, OneNumberOfDemonstrationsPutsTheArmsBeside) {
  FabricatedRun run;
  run.add(shifted("lga", "q2_heart", 0, 20, 20, 10));
  run.add(shifted("gcbc_dart", "q2_heart", 0, 8, 4, 2));
  const report::Report report = report::write_report(run.save().path);
  ASSERT_EQ(report.document.charts().size(), 2u);  // and the learning curves
  const document::Chart& chart = *report.document.charts().front();
  ASSERT_EQ(chart.ticks.size(), 3u);
  EXPECT_EQ(chart.ticks[1].label, "texture");
  const document::Series& gcbc = chart.series.at(1);
  EXPECT_EQ(gcbc.name, "GCBC-DART");
  EXPECT_FALSE(gcbc.joined);
  EXPECT_EQ(gcbc.points.at(1).x, 1);
  EXPECT_EQ(gcbc.points.at(1).y, .2);
}

// In every figure of a run; and a variant is told from the method that it is one of.
TEST(Figures, AMethodHasOneColourAndOneMark) {
  FabricatedRun run;
  for (const char* scenario : {"heart", "letter"})
    for (const int n : {10, 50}) {
      if (scenario == std::string("letter")) run.add({"lga", 15, scenario, n});
      run.add({"lga+instances=first", 12, scenario, n});
      run.add({"gcbc_dart", 2, scenario, n});
      run.add({"my_method", 2, scenario, n});
    }
  const report::Report report = report::write_report(run.save().path);
  std::map<std::string, std::set<std::string>> styles;  // of each method, over all charts
  for (const document::Section& section : report.document.sections)
    for (const document::Block& block : section.blocks)
      if (const auto* charts = std::get_if<document::Charts>(&block.content))
        for (const document::Chart& chart : charts->charts)
          for (const document::Series& series : chart.series)
            if (series.kind == document::Series::measured) styles[series.name].insert(document::svg_mark(series.style));
  ASSERT_EQ(styles.size(), 4u);
  std::set<std::string> different;
  for (const auto& [name, marks] : styles) {
    EXPECT_EQ(marks.size(), 1u) << name;
    different.insert(*marks.begin());
  }
  EXPECT_EQ(different.size(), 4u);
}

// WCAG's contrast of a line against the sheet that charts lie on, light and (a quarter nearer to white) dark.
TEST(Figures, EveryColourIsSeen) {
  const auto light_of = [](long code, double lift) {
    double luminance = 0;
    for (const auto& [shift, weight] : {std::pair(16, .2126), {8, .7152}, {0, .0722}}) {
      const double value = static_cast<double>(code >> shift & 255) / 255, lifted = value + lift * (1 - value);
      luminance += weight * (lifted <= .04045 ? lifted / 12.92 : std::pow((lifted + .055) / 1.055, 2.4));
    }
    return luminance + .05;
  };
  const std::vector<std::string> methods{"lga", "lga_hill", "human", "lga_s", "lga_l", "gcbc_dart", "a", "b", "c", "d"};
  const statistics::MethodStyles styles(methods);
  for (const std::string& method : methods) {
    const long code = std::stol(styles(method).colour.substr(1), nullptr, 16);
    EXPECT_GE(light_of(0xf6f7f9, 0) / light_of(code, 0), 3) << method;
    EXPECT_GE(light_of(code, .25) / light_of(0x1d2126, 0), 3) << method;
  }
}

TEST(Figures, SeveralNumbersMakeCurvesOfEachArm) {
  FabricatedRun run;
  Spec spec = shifted("lga", "q2_heart", 0, 20, 20, 10);
  run.add(spec);
  spec.demonstrations = 10;
  run.add(spec);
  run.save();
  report::write_report(run.path);
  for (const char* arm : {"control", "texture", "hard"})
    EXPECT_TRUE(fs::exists(run.path / (std::string("figures/success_cells_mujoco_") + arm + ".svg"))) << arm;
  const std::string page = read_file(run.path / "report.md");
  EXPECT_LT(page.find("### 10 demonstrations"), page.find("### 50 demonstrations"));
}

}  // namespace
}  // namespace lgabench

// Reports of fabricated runs with several arms and several commands.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include <lgabench/report/paper.hpp>
#include <lgabench/report/report.hpp>

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

std::string line_with(const std::string& text, const std::string& part) {
  const std::size_t at = text.find(part);
  if (at == std::string::npos) return "";
  const std::size_t begin = text.rfind('\n', at) + 1;
  return text.substr(begin, text.find('\n', at) - begin);
}

TEST(Arms, StandSideBySideInTheScenariosOrder) {
  FabricatedRun run;
  run.run["suite"] = "q2";
  run.add(shifted("lga", "q2_heart", 0, 20, 20, 10));
  run.add(shifted("gcbc_dart", "q2_heart", 0, 8, 4, 2));
  rows_of(run);
  const std::string page = read_file(run.path / "report.md"), text = table_text(run.path);
  EXPECT_SAYS(page, "| scenario | method | control | texture | hard |\n");
  EXPECT_SAYS(page,
              "| q2_heart | **GCBC-DART** | 0.40 [0.22, 0.61] | 0.20 [0.08, 0.42] | 0.10 [0.03, 0.30] | *0.18* |");
  EXPECT_SAYS(page, "| scenario | method | texture | hard |\n");
  EXPECT_SAYS(text, "\n50 demonstrations  control ");
  EXPECT_LT(text.find("control"), text.find("texture"));
  EXPECT_SAYS(text, "q2, layout cells, engine mujoco: change against control [95 % interval]");
  EXPECT_SAYS(line_with(text, "GCBC-DART"), "0.40 [0.22, 0.61]    0.20 [0.08, 0.42]");
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
  EXPECT_SAYS(line_with(text, "  LGA"), "] =  ");
  EXPECT_SILENT(line_with(text, "best constant"), "=");
  EXPECT_SAYS(text, "= same actions as in control: the policy saw the same input.");

  // One policy of three that acts otherwise, in all its scenes: not the same.
  other.seed = 2;
  other.arms[1].action = 0.51;
  run.add(other);
  rows = rows_of(run);
  EXPECT_FALSE(rows.at("q2_heart lga texture").at("shift").at("same_actions"));
  EXPECT_SILENT(table_text(run.path), "same actions");
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
  const std::string page = read_file(run.path / "report.md"), text = table_text(run.path);
  EXPECT_SILENT(page, "Change against");
  EXPECT_SILENT(text, "change against");
  EXPECT_SAYS(page, "| scenario | method | seen | unseen | *the paper, its arms pooled* |\n");
  EXPECT_SAYS(line_with(page, "| q3_fruit | **LGA**"), "| *0.95* |");
  EXPECT_SILENT(line_with(page, "| mean over 1 scenario | **LGA**"), "*0.95*");  // the paper gives no mean
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
  const std::string page = read_file(run.path / "report.md"), text = table_text(run.path);
  EXPECT_SAYS(page, "| scenario | method | seen | unseen | seen_varied (1 of 2) |");
  EXPECT_SAYS(line_with(page, "| q3_fruit | **LGA**"), "|  |");
  EXPECT_SAYS(text, "  seen_varied (1 of 2)\n");
  EXPECT_SAYS(read_file(run.path / "report.html"), "<th scope=col>seen_varied (1 of 2)</th>");
  const std::string note = "seen_varied (1 of 2): the mean is over q3_utensil; no other scenario has this arm.";
  for (const std::string& said : {text, read_file(run.path / "report.html")}) {
    EXPECT_SAYS(said, note);
    EXPECT_SILENT(said, "‡");
  }
  Spec utensil = ambiguous("human", 16, 12);  // and no q3_fruit, which has the arm
  utensil.scenario = "q3_utensil";
  run.add(utensil);
  EXPECT_EQ(rows_of(run).at("(mean) human seen").at("marks"), Json{"incomplete"});
}

TEST(Arms, SayHowManyDemonstrationsSeveralCommandsHad) {
  FabricatedRun run;
  run.run["suite"] = "q3";
  run.run["version"] = "0.2.0";
  run.add(ambiguous("lga", 20, 15));
  rows_of(run);
  EXPECT_SAYS(read_file(run.path / "report.md"), "### demonstrations: 50 per command, 100 in all");
  EXPECT_SAYS(table_text(run.path), "\ndemonstrations: 50 per command, 100 in all");
  run.run["version"] = "0.1.0";  // which divided them among the commands
  rows_of(run);
  EXPECT_SAYS(read_file(run.path / "report.md"), "### 50 demonstrations");
}

TEST(Paper, BarsBelongToTheirScenarios) {
  const report::PaperValues q2 = report::paper_values("q2"), q3 = report::paper_values("q3");
  for (const auto& [scenario, rate] :
       std::map<std::string, double>{{"q2_heart", .18}, {"q2_letter", .07}, {"q2_bowl", .18}, {"q2_block", 0}})
    EXPECT_EQ(q2.find(scenario, "GCBC-DART", 50), rate) << scenario;
  EXPECT_EQ(q2.find("q2_bowl", "LGA-S", 50), .97);
  for (const auto& [scenario, rate] :
       std::map<std::string, double>{{"q3_fruit", .13}, {"q3_food", .18}, {"q3_utensil", .35}})
    EXPECT_EQ(q3.find(scenario, "GCBC-DART", 50), rate) << scenario;
  EXPECT_EQ(q3.find("q3_fruit", "LGA", 10), std::nullopt);
  EXPECT_TRUE(report::paper_values("factorial").rates.empty());

  const report::PaperValues q1 = report::paper_values("q1");
  EXPECT_EQ(q1.find(report::mean_scenario, "LGA", 50), .747);
  EXPECT_EQ(q1.error(report::mean_scenario, "LGA", 50), .078);
  EXPECT_EQ(q1.error(report::mean_scenario, "GCBC-SEG", 10), .012);
  for (const int n : {10, 20, 30, 40, 50})
    EXPECT_FALSE(q1.find(report::mean_scenario, "GCBC-DART", n)) << "the figure's curve is another row's error bars";
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
  const std::string page = read_file(run.path / "report.md");
  EXPECT_SAYS(page, "| q3_fruit | Bring me a fruit. (unseen) |\n");
  EXPECT_SAYS(page, "| q3_fruit | Bring me a tomato. (seen) | LGA | target |");
  EXPECT_SAYS(page, "| q3_fruit | Bring me a fruit. (unseen) | LGA | target |");
}

TEST(Figures, OneNumberOfDemonstrationsMakesBarsOfTheArms) {
  FabricatedRun run;
  run.add(shifted("lga", "q2_heart", 0, 20, 20, 10));
  run.add(shifted("gcbc_dart", "q2_heart", 0, 8, 4, 2));
  rows_of(run);
  const std::string script = read_file(run.path / "figures/success_cells_mujoco.gp");
  EXPECT_SAYS(script, "set xtics ('control' 0, 'texture' 1, 'hard' 2)");
  EXPECT_SAYS(script, "with boxerrorbars");
  EXPECT_SAYS(script, "\n1.2 0.2 0.08");  // GCBC-DART in the arm texture
  EXPECT_SAYS(read_file(run.path / "figures/success_cells_mujoco.svg"), "GCBC-DART");
  EXPECT_SAYS(read_file(run.path / "report.md"), "![success](figures/success_cells_mujoco.svg)");
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

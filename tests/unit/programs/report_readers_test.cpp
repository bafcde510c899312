// What a reader needs before the numbers: the suite's question, its arms, what rows are, the result as a difference.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>

#include <lgabench/plugin/loader.hpp>
#include <lgabench/report/report.hpp>
#include <lgabench/statistics/about_suite.hpp>
#include <lgabench/statistics/names.hpp>
#include <lgabench/statistics/settings.hpp>

#include "report_run.hpp"

namespace lgabench {
namespace {

using Spec = FabricatedRun::Spec;

std::string page_of(FabricatedRun& run) {
  report::write_report(run.save().path);
  return read_file(run.path / "report.html");
}

TEST(Readers, AnOptionThatTwoRowsDifferInStandsAtEachThatHasIt) {
  FabricatedRun run;
  for (const auto& [method, policy] : {std::pair("erase+policy=heat_map", ""),
                                       {"erase_gated", "heat_map"},
                                       {"lga", "regression"},
                                       {"gcbc_dart", ""}}) {
    Spec spec{method, 10};
    if (*policy) spec.options = {{"policy", policy}};
    run.add(spec);
  }
  const auto names = statistics::told_names(statistics::read_run(run.save().path));
  EXPECT_EQ(names.at("erase_gated"), "erase_gated+policy=heat_map");
  EXPECT_EQ(names.at("erase+policy=heat_map"), "erase+policy=heat_map");
  EXPECT_EQ(names.at("lga"), "lga+policy=regression");
  EXPECT_EQ(names.at("gcbc_dart"), "gcbc_dart") << "has no such option";
  const std::string page = page_of(run);
  EXPECT_SAYS(page, "erase gated with a heat map</b>");
  EXPECT_SAYS(read_file(run.path / "tables/cells_mujoco_mean.csv"), "erase_gated policy=heat_map");
}

TEST(Readers, AnOptionBesideTheDefaultIsNamedAtItsRowOrOnceForAll) {
  FabricatedRun run;
  for (const char* method : {"lga", "gcbc_dart"}) {
    Spec spec{method, 10};
    spec.options = {{"policy", "heat_map"}};
    if (std::string(method) == "gcbc_dart") spec.options["dart"] = "none";
    run.run["settings"][method] = spec.options;
    run.add(spec);
  }
  const std::string page = page_of(run);
  EXPECT_SAYS(page, "GCBC-DART without noise</b>");
  EXPECT_SAYS(page, "All rows: with a heat map. Every other option has the plugin’s default.");
  EXPECT_SILENT(page, "LGA with a heat map");
}

TEST(Readers, RowsOfSeveralRunsThatDifferHaveDifferentNames) {
  FabricatedRun first, second;
  for (auto& [run, epochs] : {std::pair(&first, 750), {&second, 20}}) {
    Spec spec{"lga", 10};
    spec.options = {{"epochs", epochs}, {"policy", "regression"}};
    run->add(spec);
  }
  std::vector<report::Report> reports;
  for (FabricatedRun* run : {&first, &second}) reports.push_back(report::write_report(run->save().path));
  report::write_index(reports, first.path / "index.html");
  const std::string page = read_file(first.path / "index.html");
  EXPECT_SAYS(page, "LGA epochs 750</b>");
  EXPECT_SAYS(page, "LGA epochs 20</b>");
  EXPECT_SILENT(page, "with a regressed action");
}

TEST(Readers, ThePageSaysWhatTheSuiteAsksAndWhatItsArmsAre) {
  FabricatedRun run;
  run.run["suite"] = "q2";
  Spec spec{"lga", 0, "q2_heart"};
  spec.arms = {{"control", 10}, {"hard", 5}};
  run.add(spec);
  const statistics::AboutSuite about = statistics::about_suite("q2");
  ASSERT_FALSE(about.question.empty());
  const std::string page = page_of(run);
  for (const std::string& text : {about.question, about.arm("control"), about.arm("hard")}) EXPECT_SAYS(page, text);
  EXPECT_SILENT(page, about.arm("texture")) << "an arm that the run does not have";
  EXPECT_EQ(statistics::about_suite("few_members").arm("seen_near_members_2"),
            statistics::about_suite("few_members").arm("seen_near"));
  EXPECT_EQ(statistics::about_suite("none").question, "");
  EXPECT_EQ(statistics::about_suite("../suites/q1").question, "") << "a name, no path";
}

TEST(Readers, EveryShippedSuiteHasAQuestionAndWordsForEachOfItsArms) {
  for (const auto& file : fs::directory_iterator(data_directory() / "suites")) {
    if (file.is_directory()) continue;  // their claims
    const statistics::AboutSuite about = statistics::about_suite(file.path().stem().string());
    EXPECT_FALSE(about.question.empty()) << file.path();
    EXPECT_NE(about.title, file.path().stem()) << "a title";
    const Json suite = read_json(file.path());
    const auto expect_words = [&](const std::string& arm) {
      EXPECT_FALSE(about.arm(arm).empty()) << file.path() << arm;
      EXPECT_EQ(about.arm_title(arm).find('_'), std::string::npos) << file.path() << arm << " has no title";
      EXPECT_LE(about.arm_title(arm).size(), 28U) << file.path() << arm << ": too long for a column";
    };
    for (const Json& arm : suite.value("arms", Json::array())) expect_words(arm.at("arm"));
    const Json variants = suite.value("variants", Json::object());
    for (const auto& [variant, members] : variants.items())
      for (const Json& arm : members.value("arms", suite.value("arms", Json::array())))
        expect_words(arm.at("arm").get<std::string>() + "_" + variant);
    for (const Json& id : suite.at("scenarios")) {
      if (suite.value("only_arms", false)) break;
      const Json scenario = read_json(data_directory() / "scenarios" / (id.get<std::string>() + ".json"));
      for (const Json& arm : scenario.at("tests")) expect_words(arm.at("arm"));
    }
  }
}

TEST(Readers, ASuiteOfOnesOwnIsNamedByItsFile) {
  FabricatedRun run;
  run.run["suite"] = "mine";
  Spec spec{"lga", 0, "heart"};
  spec.arms = {{"control", 10}, {"test_2", 5}};
  run.add(spec);
  EXPECT_SAYS(page_of(run), "The suite has no title");
  run.run["about"] = {{"title", "My crowd"}, {"question", "Why?"}, {"arm_titles", {{"test_2", "two <others>"}}}};
  const std::string page = page_of(run);
  for (const char* text : {"<h1>My crowd: ", "two &lt;others&gt; ", "Why?"}) EXPECT_SAYS(page, text);
  EXPECT_SILENT(page, "The suite has no title");
  EXPECT_SILENT(read_file(run.path / "summary.json"), "two <others>") << "ids are for machines";
  run.run["about"]["arm_titles"]["test_2"] = 2;
  EXPECT_THROW(page_of(run), InputError);
}

TEST(Readers, IdsBecomeWords) {
  for (const auto& [text, words] : std::map<std::string, std::string>{
           {"LGA policy=heat_map, GCBC-DART dart=none.", "LGA with a heat map, GCBC-DART without noise."},
           {"errand how=words moment=each sets=truth policy=point, above",
            "errand goes by key words by pointing, above"},
           {"LGA, with instances=first, above", "LGA, with a mask of the first instance, above"},
           {"no row gcbc_seg; needs random_object", "no row GCBC-SEG; needs random visible object"},
           {"in plain_colored_vessel, my_option=0.5", "in plain colored vessel, my option 0.5"},
           {"got \"feature_space\" in cells/a_b/log_file.txt, lga_x.so, --an_option, lga.a_b=1, MY_KEY", ""},
           {"p = 0.03, a = b, _, =, φ̂_", ""}})
    EXPECT_EQ(statistics::readable(text), words.empty() ? text : words);
}

// 15 of 20 against 5 of the same 20 scenes, in the suite's main arm, not its last.
TEST(Readers, TheHeadlineIsThePairedDifferenceInTheMainArm) {
  FabricatedRun run;
  run.run["suite"] = "mobile";
  for (const auto& [method, won] : {std::pair("lga", 15), {"gcbc_seg", 5}})
    for (const int n : {1, 10}) {
      Spec spec{method, 0, "heart", n};
      spec.arms = {{"same_place", n == 1 ? won : 20}, {"moved", 0}};
      run.add(spec);
    }
  Spec random{"random_object", 0, "heart", 0, 0, "reference"};
  random.arms = {{"same_place", 18}, {"moved", 3}};
  run.add(random);
  const std::string page = page_of(run);
  const std::size_t begin = page.find("<p class=headline>");
  ASSERT_NE(begin, page.npos);
  const std::string line =
      std::regex_replace(page.substr(begin, page.find("</p>", begin) - begin), std::regex("<[^>]*>"), "");
  EXPECT_SAYS(line, "1 demonstration, arm &quot;same place&quot;: LGA succeeds in 0.75 of the episodes: 0.50 [");
  EXPECT_SAYS(line, "] more than GCBC-SEG, 0.15 [");
  EXPECT_SAYS(line, "] less than the random visible object (95 % intervals of the paired differences)");
}

TEST(Readers, ATableOfZerosIsOneLineAndAMeasuredColumnStays) {
  for (const int seen : {0, 3}) {
    FabricatedRun run;
    for (const char* scenario : {"heart", "letter"}) {
      Spec spec{"lga", 10, scenario};
      spec.inputs_seen = seen;
      spec.attribution = "policy";
      run.add(spec);
    }
    const std::string page = page_of(run);
    EXPECT_EQ(page.find("No test input occurred in training.") != page.npos, seen == 0);
    EXPECT_EQ(page.find("cells_mujoco_seen") != page.npos || page.find("Test inputs that occurred") != page.npos,
              seen > 0);
    EXPECT_SAYS(page, "<th scope=col>types: recall</th>");
  }
}

TEST(Readers, MarksSayWhatTheyMeanAndNoTableHasAHeadTwice) {
  FabricatedRun run;
  Spec lga{"lga", 4};
  lga.arms = {{"control", 4}, {"hard", 4}};
  run.add(lga);
  Spec random{"random_object", 0, "heart", 0, 0, "reference"};
  random.arms = {{"control", 9}, {"hard", 9}};
  run.add(random);
  const std::string page = page_of(run);
  EXPECT_SAYS(page, "<span title=\"below the random visible object, which needs no demonstration\">§</span>");
  EXPECT_SAYS(page, "<span title=\"the same actions as in control\">=</span>");
  const std::regex table("<thead>(.*?)</thead>"), head("<th scope=col>(.*?)</th>");
  int tables = 0;
  for (std::sregex_iterator it(page.begin(), page.end(), table), end; it != end; ++it, ++tables) {
    std::set<std::string> heads;
    const std::string row = it->str(1);
    for (std::sregex_iterator cell(row.begin(), row.end(), head), last; cell != last; ++cell)
      EXPECT_TRUE(heads.insert(cell->str(1)).second) << cell->str(1) << " twice in " << row;
  }
  EXPECT_GT(tables, 3);
}

TEST(Readers, EveryClassOfThePageIsInTheStyleSheetOrTheScript) {
  FabricatedRun run;
  Spec lga{"lga", 4};
  lga.attribution = "perception";
  run.add(lga);
  run.add({"constant_action", 3, "heart", 20, 0, "reference"});
  run.add_failed({"lga", 0, "heart", 10, 2}, "host");
  const std::string page = page_of(run),
                    body = page.substr(page.find("<body>"), page.find("<script") - page.find("<body>"));
  std::string rules = read_file(data_directory() / "page/page.css");
  for (const char* script : {"page.js", "episodes.js"}) rules += read_file(data_directory() / "page" / script);
  std::set<std::string> classes;
  const std::regex quoted("class=(\"([^\"]*)\"|([\\w-]+))"), word("[\\w-]+");
  for (std::sregex_iterator it(body.begin(), body.end(), quoted), end; it != end; ++it) {
    const std::string all = it->str(2) + it->str(3);
    for (std::sregex_iterator one(all.begin(), all.end(), word), last; one != last; ++one) classes.insert(one->str());
  }
  EXPECT_EQ(classes.count("perception"), 1u);
  // Drawn by attributes alone: a file of a figure has no style sheet.
  for (const char* drawn : {"s-none", "f-none", "s-series", "f-series", "s-ink", "s-paper"}) classes.erase(drawn);
  for (const std::string& name : classes)
    EXPECT_TRUE(std::regex_search(rules, std::regex("\\." + name + "\\b")) ||
                std::regex_search(rules, std::regex("[\"' ]" + name + "[\"' ]")))
        << name;
}

}  // namespace
}  // namespace lgabench

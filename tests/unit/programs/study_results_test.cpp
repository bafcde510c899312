// What a study says. statistics_reference.py computes the reference values with SciPy and statsmodels, but where
// another source is named.
#include <lgabench/study/report.hpp>

#include <cmath>

#include <lgabench/core/hash.hpp>
#include <lgabench/document/writers.hpp>

#include "../../schemas.hpp"
#include "study_people.hpp"

namespace lgabench::study {
namespace {

TEST(CrossoverModel, SennsAsthmaTrial) {
  // Senn (2002), Cross-over Trials in Clinical Research, table 3.1: peak expiratory flow (l/min) of 13 children after
  // formoterol and salbutamol (Graff-Lonnevig and Browaldh 1990). Adjusted for period: 46.6, standard error 10.8.
  const std::vector<std::pair<double, double>> formoterol_first{{310, 270}, {310, 260}, {370, 300}, {410, 390},
                                                                {250, 210}, {380, 350}, {330, 365}};
  const std::vector<std::pair<double, double>> salbutamol_first{{370, 385}, {310, 400}, {380, 410},
                                                                {290, 320}, {260, 340}, {90, 220}};
  std::vector<std::vector<double>> rows;
  std::vector<double> differences;
  for (const auto& [first, second] : formoterol_first) rows.push_back({1, 1}), differences.push_back(first - second);
  for (const auto& [first, second] : salbutamol_first) rows.push_back({-1, 1}), differences.push_back(first - second);
  const std::vector<statistics::Change> effects = statistics::least_squares(rows, differences);
  ASSERT_EQ(effects.size(), 2u);
  EXPECT_NEAR(effects[0].difference, 46.6, .05);
  const double t_975 = 2.200985160082949;  // of 11 degrees of freedom
  EXPECT_NEAR((effects[0].interval.high - effects[0].difference) / t_975, 10.8, .05);
  // The same as two samples of differences, by SciPy.
  EXPECT_NEAR(effects[0].p, 0.0012048475398269902, 1e-10);
}

TEST(CrossoverModel, ThreeColumnsByStatsmodels) {
  std::vector<CrossoverPerson> people;
  for (int i = 0; i < 12; ++i)
    people.push_back({i % 2 == 0, i % 4 < 2,
                      (i % 2 == 0 ? 1 : -1) * 1.05 + .1 * (i % 4 < 2 ? 1 : -1) - .2 + .3 * std::sin(1 + 5. * i)});
  const std::vector<statistics::Change> effects = crossover_model(people);
  ASSERT_EQ(effects.size(), 3u);
  const double expected[3][4] = {
      {1.080050178769362, 0.9621508138787723, 1.1979495436599517, 6.636198826663245e-09},
      {-0.1907649148439191, -0.3086642797345087, -0.07286554995332951, 0.0052335511488879275},
      {0.2359866775673555, 0.11808731267676591, 0.3538860424579451, 0.0014304541564456417}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(effects[i].difference, expected[i][0], 1e-12) << i;
    EXPECT_NEAR(effects[i].interval.low, expected[i][1], 1e-10) << i;
    EXPECT_NEAR(effects[i].interval.high, expected[i][2], 1e-10) << i;
    EXPECT_NEAR(effects[i].p, expected[i][3], 1e-10) << i;
  }
  people.resize(3);
  EXPECT_TRUE(crossover_model(people).empty()) << "as many columns as people";
  for (CrossoverPerson& person : people = std::vector<CrossoverPerson>(8, people[0])) person.human_first = true;
  EXPECT_TRUE(crossover_model(people).empty()) << "all began with one condition";
}

TEST(WelchT, ReferenceValues) {
  const statistics::Change c =
      statistics::welch_t({1.2, 2.4, 1.3, 1.3, 0, 1, 1.8, .8, 4.6, 1.4}, {0.1, -1.2, 0.4, 0.9});
  EXPECT_NEAR(c.difference, 1.53, 1e-12);
  EXPECT_NEAR(c.interval.low, 0.15406721446535832, 1e-10);
  EXPECT_NEAR(c.interval.high, 2.9059327855346413, 1e-10);
  EXPECT_NEAR(c.p, 0.03354244024469957, 1e-12);
}

// A study of people whose seconds are given: paper, every trial of a person in a condition takes that long.
class StudyResultsTest : public testing::Test, public TemporaryDirectory {
 protected:
  fs::path data = path / "data";

  void person(Study& study, const std::string& key, double human_s, double edit_s, std::size_t trials = 99,
              const std::string& words = "") {
    const std::string id = study.begin(key, sha256_file(path / "consent.txt"), false);
    Page page;
    const auto post = [&](const std::string& kind, const Json& more = Json::object()) {
      return study.post(id, page.event(kind, more), static_cast<std::int64_t>(page.ms)).value();
    };
    post("opened"), post("familiarised");
    Json state = post("example_seen");
    for (std::size_t i = 0; state.at("step") != "debriefing" && i < trials + 2; ++i) {
      if (state.at("step") == "questionnaire") {
        const bool last = state.at("last");
        const double seconds = state.at("condition") == "human" ? human_s : edit_s;
        const int load = static_cast<int>(seconds / 2) % 101;
        state = post("questionnaire", {{"tlx", tlx(load)}, {"free_text", last ? words : ""}});
        continue;
      }
      post("start"), post("shown");
      page.ms += 1000 * (state.at("trial").at("condition") == "human" ? human_s : edit_s);
      state = post("submit", submitted({"heart"}, {"red"}));
    }
  }
};

TEST_F(StudyResultsTest, ComparesPeoplesMeansAndSaysWhoIsLeftOut) {
  {
    const fs::path file =
        ready_protocol(path, "paper", {{"exclusions", {{"fewest_trials", 5}, {"longest_seconds", 900}}}});
    Study study(data, read_protocol(file), file, Kind::people);
    person(study, "a", 150, 50), person(study, "b", 160, 59), person(study, "c", 170, 71, 99, "a | b <b>c</b>\n# d");
    person(study, "d", 10, 10, 4);  // left
    person(study, "e", 1000, 50);   // too long, all of one condition
  }
  const Record record = read_study(data);
  const StudyResults results = results_of(record);
  EXPECT_EQ(results.used(), 3);
  EXPECT_EQ(results.people[3].excluded, "did not finish");
  EXPECT_EQ(results.people[4].excluded, "0 trials of human count, 5 needed");
  EXPECT_EQ(results.too_long, 9);
  EXPECT_NEAR(results.seconds[0]->mean, 160, 1e-9);
  EXPECT_NEAR(results.seconds[0]->sd.value(), 10, 1e-9);
  EXPECT_NEAR(results.seconds[0]->se.value(), 10 / std::sqrt(3.), 1e-9);
  // Differences 100, 101, 99: mean 100, s = 1; t_.975 = 4.3027 of 2 degrees of freedom.
  ASSERT_TRUE(results.primary.has_value());
  EXPECT_NEAR(results.primary->difference, 100, 1e-9);
  EXPECT_NEAR(results.primary->interval.high, 100 + 4.302653 / std::sqrt(3.), 1e-4);
  ASSERT_EQ(results.commands.size(), 9u);
  for (const CommandResult& command : results.commands) {
    EXPECT_NEAR(command.change->p, results.primary->p, 1e-12);
    EXPECT_NEAR(command.p_holm, 9 * command.change->p, 1e-12);
  }
  // Loads 75, 80, 85 against 25, 29, 35: differences 50, 51, 50.
  ASSERT_EQ(results.tlx.size(), 7u);
  for (const ScaleResult& row : results.tlx) {
    EXPECT_NEAR(row.change->difference, 151 / 3., 1e-9) << row.scale;
    EXPECT_NEAR(row.p_holm, 7 * row.change->p, 1e-12);
  }
  // {heart} x {red}, mean over nine truths: types of two of the nine and of "tiger", textures of all but two.
  EXPECT_NEAR(*results.phi[0].object_types.precision, 3 / 9., 1e-12);
  EXPECT_NEAR(*results.phi[0].object_types.recall, (1 + 1 + 1 / 29.) / 9, 1e-12);

  EXPECT_TRUE(fs::exists(data / "participants/p03.json"));
  EXPECT_FALSE(fs::exists(data / "participants/p05.json")) << "left out of every test, those of a run's claims too";

  write_report(data);
  const std::string text = read_file(data / "report.md");
  EXPECT_SAYS(text, "p05 is left out: 0 trials of human count");
  EXPECT_SAYS(text, "p03: a \\| b \\<b>c\\</b> # d");
  EXPECT_SILENT(text, "\n# d");
  EXPECT_SAYS(text, "figures/seconds.svg");
  EXPECT_SAYS(text, "| mean of the six | 3 | 80.0 | 29.7 | +50.3 ");
  EXPECT_SAYS(read_file(data / "figures/seconds.svg"), "p02, LGA-HILL: 59.0 s");
  const std::string page = read_file(data / "report.html");
  EXPECT_SAYS(page,
              "<p class=headline>3 people took 160.0 s a command from empty lists (Human), 60.0 s with a model's");
  EXPECT_SAYS(page, "a | b &lt;b&gt;c&lt;/b&gt; # d");
  EXPECT_SAYS(page, "<caption><span>Seconds a command: over people");
  EXPECT_SAYS(page, "<svg");
  EXPECT_SILENT(page, ">0.000<");
  EXPECT_SILENT(page, "src=\"http");
  EXPECT_EQ(read_json(data / "results.json").at("used"), 3);
  EXPECT_EQ(complaints("study_results", read_json(data / "results.json")), std::vector<std::string>());
  EXPECT_SAYS(read_file(data / "trials.csv"), "\np01,,");
}

TEST_F(StudyResultsTest, NobodyTookNoTime) {
  {
    const fs::path file = ready_protocol(path, "paper");
    Study study(data, read_protocol(file), file, Kind::people);
    person(study, "a", 150, 50, 1);  // left
  }
  write_report(data);
  const Json json = read_json(data / "results.json");
  EXPECT_EQ(json.at("used"), 0);
  EXPECT_EQ(json.at("/conditions/human/seconds"_json_pointer), nullptr);
  EXPECT_EQ(json.at("/conditions/lga_hill/active_seconds"_json_pointer), nullptr);
  EXPECT_EQ(complaints("study_results", json), std::vector<std::string>());
  EXPECT_SAYS(read_file(data / "tables/seconds.csv"), "Human,0,–,–,–,–,");
}

TEST_F(StudyResultsTest, OnePersonHasNoSpread) {
  {
    const fs::path file = ready_protocol(path, "paper");
    Study study(data, read_protocol(file), file, Kind::people);
    person(study, "a", 150, 50);
  }
  write_report(data);
  const Json json = read_json(data / "results.json"), seconds = json.at("/conditions/human/seconds"_json_pointer);
  EXPECT_NEAR(seconds.at("mean").get<double>(), 150, 1e-9);
  EXPECT_EQ(seconds.at("sd"), nullptr);
  EXPECT_EQ(seconds.at("se"), nullptr);
  EXPECT_EQ(complaints("study_results", json), std::vector<std::string>());
  EXPECT_SAYS(read_file(data / "tables/seconds.csv"), "Human,1,150.0,–,–,");
  EXPECT_SILENT(read_file(data / "report.md"), "(sd ");
}

TEST_F(StudyResultsTest, ARehearsalSaysSo) {
  {
    const fs::path file = ready_protocol(path, "crossover");
    Study study(data, read_protocol(file), file, Kind::rehearsal);
    for (int i = 0; i < 8; ++i) person(study, std::to_string(i), 100 + i * i, 50 + i);
  }
  const Record record = read_study(data);
  const StudyResults results = results_of(record);
  EXPECT_EQ(results.log_model.size(), 3u);
  EXPECT_EQ(results.commands.size(), 10u);
  EXPECT_EQ(complaints("study_results", to_json(results)), std::vector<std::string>());
  const std::string text = document::terminal(document_of(results), data);
  EXPECT_SAYS(text, "rehearsal, not people");
  write_report(data);
  EXPECT_SAYS(read_file(data / "report.html"), "<p class=headline>Rehearsal, not people, so no result: 8 people took");
  EXPECT_SAYS(text, "condition: Human / LGA-HILL");
}

}  // namespace
}  // namespace lgabench::study

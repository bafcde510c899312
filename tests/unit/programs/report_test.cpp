// Reports of fabricated runs, whose numbers are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <regex>
#include <set>

#include <lgabench/report/report.hpp>
#include <lgabench/statistics/statistics.hpp>

#include "report_run.hpp"

namespace lgabench {
namespace {

Json summary_of(const FabricatedRun& run) {
  report::write_report(run.save().path);
  return read_json(run.path / "summary.json");
}

// The only row of a scenario and method; null if there is none.
Json row_of(const Json& summary, const std::string& scenario, const std::string& method, int demonstrations = 20) {
  Json found;
  for (const Json& row : summary.at("rows"))
    if (row.at("scenario") == scenario && row.at("method") == method && row.at("demonstrations") == demonstrations) {
      EXPECT_TRUE(found.is_null()) << "twice";
      found = row;
    }
  return found;
}

TEST(Summary, VariantsOfAMethodAreRowsOfTheirOwn) {
  FabricatedRun run;
  run.add({"lga", 15});
  run.add({"lga+learning_rate=1e+30+network=released", 5});
  run.add({"gcbc_dart", 2});
  const Json summary = summary_of(run);
  EXPECT_EQ(row_of(summary, "heart", "lga").at("successes"), 15);
  EXPECT_EQ(row_of(summary, "heart", "lga+learning_rate=1e+30+network=released").at("successes"), 5);
  const std::string text = table_text(run.path);
  const std::size_t variant = text.find("LGA learning_rate=1e+30 network=released");
  EXPECT_LT(text.find("  LGA  "), variant);
  EXPECT_LT(variant, text.find("GCBC-DART")) << "a variant stands with its method";
}

TEST(Summary, TheHeadRemarksOnRowsThatThePapersMethodsNames) {
  FabricatedRun run;
  run.add({"lga", 15});
  run.add({"lga_s", 15});
  summary_of(run);
  EXPECT_EQ(table_text(run.path).find("one method under two names"), std::string::npos) << "LGA sees no picture here";
  run.add({"lga+network=plain+picture=rgb", 15});
  summary_of(run);
  EXPECT_SAYS(table_text(run.path), "one method under two names, as with picture=rgb LGA sees the picture too: LGA");
  EXPECT_SAYS(table_text(run.path), "network=plain has no batch normalisation");
}

TEST(Summary, RowsHaveTheExactCounts) {
  FabricatedRun run;
  run.add({"lga", 15, "heart", 20, 0});
  run.add({"gcbc_dart", 2, "heart", 20, 0});
  run.add({"lga", 5, "letter", 20, 0, "method", "cells", "wrong_object"});
  run.add({"constant_action", 6, "heart", 20, 0, "reference"});
  run.add({"oracle", 20, "heart", 0, 0, "reference"});
  const Json summary = summary_of(run);
  EXPECT_EQ(summary.at("suite"), "q1");
  EXPECT_EQ(summary.at("failed_cells"), Json::array());
  EXPECT_EQ(summary.at("rows").size(), 9u);  // five, and a mean of each of four

  const Json lga = row_of(summary, "heart", "lga");
  EXPECT_EQ(lga.at("seeds"), 1);
  EXPECT_EQ(lga.at("episodes"), 20);
  EXPECT_EQ(lga.at("successes"), 15);
  EXPECT_EQ(lga.at("success"), 0.75);
  EXPECT_NEAR(lga.at("low"), .5313, 5e-5);
  EXPECT_NEAR(lga.at("high"), .8881, 5e-5);
  EXPECT_EQ(lga.at("failures"), (Json{{"missed_object", 5}}));
  EXPECT_EQ(lga.at("marks"), Json::array());
  ASSERT_EQ(lga.at("phi").size(), 1u);
  EXPECT_EQ(lga.at("phi").at(0).at("provenance"), "recorded");
  EXPECT_EQ(lga.at("phi").at(0).at("lm_queries"), 112);
  EXPECT_EQ(lga.at("phi").at(0).at("quality").at("target").at("textures").at("recall"), 0.75);
  EXPECT_EQ(lga.at("shift"), nullptr);
  EXPECT_EQ(row_of(summary, "heart", "gcbc_dart").at("phi"), nullptr);

  const Json mean = row_of(summary, "(mean)", "lga");
  EXPECT_EQ(mean.at("success"), 0.5);
  EXPECT_EQ(mean.at("episodes"), 40);
  EXPECT_EQ(mean.at("failures"), (Json{{"missed_object", 5}, {"wrong_object", 15}}));
  // The scenarios are fixed: 40 scenes, of which each has a chance of .75 or .25, not two draws from .75 and .25.
  EXPECT_EQ(mean.at("scenes"), 40);
  EXPECT_NEAR(mean.at("low").get<double>(), .5 - 1.96 * std::sqrt(.1875 / 40), .02);
  EXPECT_NEAR(mean.at("high").get<double>(), .5 + 1.96 * std::sqrt(.1875 / 40), .02);
  EXPECT_EQ(mean.at("phi"), nullptr);
}

TEST(Summary, CountsWhatFailuresAreAttributedTo) {
  FabricatedRun run;
  for (int seed = 0; seed < 3; ++seed) {
    FabricatedRun::Spec lga{"lga", 15 + seed, "heart", 20, seed};
    lga.attribution = seed == 0 ? "abstraction" : "policy";
    run.add(lga);
  }
  run.add({"lga", 20, "letter"});
  run.add({"gcbc_dart", 2});
  FabricatedRun::Spec human{"human", 14};
  human.attribution = "perception";
  run.add(human);
  const Json summary = summary_of(run), attributed{{"abstraction", 5}, {"policy", 4 + 3}};
  EXPECT_EQ(row_of(summary, "heart", "lga").at("attribution"), attributed);
  EXPECT_EQ(row_of(summary, "(mean)", "lga").at("attribution"), attributed);
  EXPECT_EQ(row_of(summary, "heart", "gcbc_dart").at("attribution"), (Json{{"abstraction", 0}, {"policy", 0}}));
  EXPECT_EQ(row_of(summary, "heart", "human").at("attribution"),
            (Json{{"abstraction", 0}, {"policy", 0}, {"perception", 6}}));
}

TEST(Summary, SharesTheTestInputsThatStoodInTraining) {
  FabricatedRun run;
  for (int seed = 0; seed < 2; ++seed) {
    FabricatedRun::Spec lga{"lga", 15, "heart", 20, seed};
    lga.inputs_seen = 5 + seed;
    run.add(lga);
  }
  FabricatedRun::Spec letter{"lga", 15, "letter"};
  letter.inputs_seen = 20;
  run.add(letter);
  run.add({"human", 15});
  run.add({"oracle", 20, "heart", 0, 0, "reference"});
  const Json summary = summary_of(run);
  EXPECT_EQ(row_of(summary, "heart", "lga").at("inputs_seen"), 11 / 40.0);
  EXPECT_EQ(row_of(summary, "(mean)", "lga").at("inputs_seen"), 31 / 60.0);
  EXPECT_EQ(row_of(summary, "heart", "human").at("inputs_seen"), nullptr);
  EXPECT_EQ(row_of(summary, "heart", "oracle", 0).at("inputs_seen"), nullptr);
}

TEST(Summary, SeveralSeedsAreAveraged) {
  FabricatedRun run;
  run.add({"lga", 20, "heart", 20, 0});
  run.add({"lga", 10, "heart", 20, 1});
  run.add({"lga", 0, "heart", 20, 2});
  const Json row = row_of(summary_of(run), "heart", "lga");
  EXPECT_EQ(row.at("seeds"), 3);
  EXPECT_EQ(row.at("episodes"), 60);
  EXPECT_EQ(row.at("success"), 0.5);
  // Means of three draws from 0, 1/2, 1: P(0) = 1/27 is above 2.5 %; the imagined scenes keep the ends from certainty.
  EXPECT_LT(row.at("low"), .06);
  EXPECT_GT(row.at("high"), .94);
}

TEST(Summary, SeedsOnTheSameScenesAreNoMoreScenes) {
  FabricatedRun shared, apart;
  for (int seed = 0; seed < 3; ++seed) {
    shared.add({"lga", 15, "heart", 20, seed});
    FabricatedRun::Spec own{"lga", 15, "heart", 20, seed};
    own.first_scene = 20 * seed;
    apart.add(own);
  }
  const Json one = row_of(summary_of(shared), "heart", "lga"), other = row_of(summary_of(apart), "heart", "lga");
  EXPECT_EQ(one.at("episodes"), other.at("episodes"));
  EXPECT_EQ(one.at("scenes"), 20);
  EXPECT_EQ(other.at("scenes"), 60);
  EXPECT_LT(one.at("low"), statistics::wilson(45, 60).low - .04) << "60 episodes would be narrower";
  EXPECT_NEAR(one.at("low").get<double>(), statistics::wilson(15, 20).low, .05);
  EXPECT_GT(other.at("low").get<double>(), one.at("low").get<double>() + .03);
}

TEST(Summary, SeveralParticipantsAreAveragedEachOverTheirSeeds) {
  FabricatedRun run;  // invented people
  const auto add = [&run](const std::string& id, int won, int seed, double seconds) {
    FabricatedRun::Spec spec{"human", won, "heart", 20, seed};
    spec.provenance = "human";
    spec.participant = id;
    spec.human_seconds = seconds;
    run.add(spec);
  };
  for (int seed = 0; seed < 3; ++seed) add("p01", 20, seed, 100);
  add("p02", 0, 0, 50);
  const Json summary = summary_of(run), row = row_of(summary, "heart", "human");
  EXPECT_EQ(row.at("success"), 0.5) << "not 3/4: p01 is one person with three seeds";
  EXPECT_EQ(row.at("seeds"), 3);
  EXPECT_EQ(row.at("participants"), 2);
  EXPECT_EQ(row.at("episodes"), 80);
  EXPECT_EQ(row.at("low"), 0.0) << "one of the two is drawn twice in a quarter of all resamples";
  EXPECT_EQ(row.at("high"), 1.0);
  EXPECT_EQ(row.at("phi").at(0).at("source"), "2 participants");
  EXPECT_EQ(row.at("phi").at(0).at("human_seconds"), 87.5);

  FabricatedRun one;  // is no level of its own
  for (int seed = 0; seed < 2; ++seed) {
    FabricatedRun::Spec spec{"human", 20 * seed, "heart", 20, seed};
    spec.participant = "p01";
    one.add(spec);
  }
  EXPECT_EQ(row_of(summary_of(one), "heart", "human").at("low"), 0.0);
}

TEST(Summary, MarksWhatIsBelowAReferenceRow) {
  FabricatedRun run;
  run.add({"constant_action", 6, "heart", 20, 0, "reference"});
  run.add({"constant_action", 2, "heart", 50, 0, "reference"});
  run.add({"random_object", 9, "heart", 0, 0, "reference"});          // whatever the demonstrations
  run.add({"lga", 9, "heart", 20, 0});                                // as good: not below
  run.add({"gcbc_dart", 5, "heart", 20, 0});                          // below both
  run.add({"gcbc_dart", 5, "heart", 50, 0});                          // below the random object alone
  run.add({"gcbc_dart", 1, "heart", 20, 0, "method", "continuous"});  // no reference in that layout
  const Json summary = summary_of(run);
  std::map<std::string, Json> marks;
  for (const Json& row : summary.at("rows"))
    if (row.at("marks") != Json::array())
      marks[row.at("scenario").get<std::string>() + " " + row.at("method").get<std::string>() + " " +
            row.at("demonstrations").dump() + " " + row.at("layout").get<std::string>()] = row.at("marks");
  const Json both{"baseline_not_learned", "below_random_object"}, random{"below_random_object"};
  EXPECT_EQ(marks, (std::map<std::string, Json>{{"heart gcbc_dart 20 cells", both},
                                                {"(mean) gcbc_dart 20 cells", both},
                                                {"heart gcbc_dart 50 cells", random},
                                                {"(mean) gcbc_dart 50 cells", random}}));
}

TEST(Summary, FailedCellsAreListedAndNeverCounted) {
  FabricatedRun run;
  run.add({"lga", 15, "heart", 20, 0});
  run.add_failed({"lga", 0, "heart", 20, 1}, "host");
  run.add_failed({"gcbc_dart", 0, "heart", 20, 0}, "plugin");
  const Json summary = summary_of(run);
  const Json lga = row_of(summary, "heart", "lga"), gcbc = row_of(summary, "heart", "gcbc_dart");
  EXPECT_EQ(lga.at("episodes"), 20);
  EXPECT_EQ(lga.at("success"), 0.75);
  EXPECT_EQ(lga.at("n_error"), 20);
  EXPECT_EQ(lga.at("marks"), Json{"incomplete"});
  EXPECT_EQ(gcbc.at("episodes"), 0);
  EXPECT_EQ(gcbc.at("success"), nullptr);
  EXPECT_EQ(gcbc.at("low"), nullptr);
  EXPECT_EQ(gcbc.at("n_error"), 0);  // the plugin's own fault
  EXPECT_EQ(summary.at("failed_cells").size(), 2u);
}

TEST(Summary, EpisodesThatTheMethodsCodeFailedInAreSaidLoudly) {
  FabricatedRun run;
  FabricatedRun::Spec bad{"lga", 15, "heart", 20, 0};
  bad.failure = "method_error";
  const fs::path cell = run.add(bad), log = cell / "log.txt";
  Json status = read_json(cell / "status.json");
  status["method_error"] = "plugin lga: its | own <b>words</b>\x1b[31m";
  write_file(cell / "status.json", canonical(status));
  run.add({"lga", 20, "letter", 20, 0});
  run.add({"gcbc_dart", 15, "heart", 20, 0});
  const Json summary = summary_of(run);
  for (const char* scenario : {"heart", "(mean)"})
    EXPECT_EQ(row_of(summary, scenario, "lga").at("marks"), Json{"method_error"}) << scenario;
  EXPECT_EQ(row_of(summary, "letter", "lga").at("marks"), Json::array());
  EXPECT_EQ(row_of(summary, "heart", "gcbc_dart").at("marks"), Json::array());
  const std::string text = table_text(run.path), page = read_file(run.path / "report.md");
  EXPECT_SAYS(text, "0.89]!");
  EXPECT_SAYS(text, "! the method's own code failed");
  EXPECT_SAYS(text, "5 of 40 episodes of LGA are method_error: plugin lga: its | own <b>words</b>\\x1b[31m (" +
                        log.string() + ")");
  EXPECT_SAYS(page, "5 of 40 episodes of LGA are method_error: plugin lga: its \\| own \\<b>");
  EXPECT_SAYS(page, "(cells/");
  EXPECT_SAYS(read_file(run.path / "report.html"), "own &lt;b&gt;words&lt;/b&gt;");
}

TEST(Summary, AMeanThatLacksAScenarioSaysSo) {
  FabricatedRun run;
  run.add({"lga", 20, "heart"});
  run.add({"lga", 10, "letter"});
  run.add({"gcbc_dart", 10, "heart"});
  const Json summary = summary_of(run);
  EXPECT_EQ(row_of(summary, "(mean)", "lga").at("marks"), Json::array());
  EXPECT_EQ(row_of(summary, "(mean)", "gcbc_dart").at("marks"), Json{"incomplete"});
}

// At 10 demonstrations the paper has LGA .096 (error bar .047), Human .135 (.045) and GCBC-SEG .046 (.012).
TEST(Summary, CountsThePointsThatLieNearThePapers) {
  FabricatedRun run;
  run.add({"lga", 3, "heart", 10});
  run.add({"human", 20, "heart", 10});
  EXPECT_EQ(summary_of(run).at("near_paper"), Json::array()) << "gcbc_seg is missing";
  run.add({"gcbc_seg", 1, "heart", 10});
  const Json near = summary_of(run).at("near_paper").at(0);
  EXPECT_EQ(near.at("points"), 3);
  EXPECT_EQ(near.at("near"), 2);
  EXPECT_NEAR(near.at("mean_distance"), (.054 + .865 + .004) / 3, 1e-3);
}

TEST(Report, TwiceGivesTheSameBytes) {
  FabricatedRun run;
  for (const char* layout : {"cells", "continuous"})
    for (int seed = 0; seed < 2; ++seed)
      for (int n : {10, 20}) {
        run.add({"lga", 10 + seed, "heart", n, seed, "method", layout});
        run.add({"constant_action", 5 + seed, "heart", n, seed, "reference", layout});
      }
  run.save();
  const std::vector<std::string> files{"summary.json", "summary.csv", "report.md", "figures/success_cells_mujoco.svg",
                                       "figures/success_continuous_mujoco.pdf"};
  const auto written = [&] {
    report::write_report(run.path);
    std::vector<std::string> bytes;
    for (const std::string& file : files) {
      bytes.push_back(read_file(run.path / file));
      fs::remove(run.path / file);
    }
    return bytes;
  };
  const auto first = written(), second = written();
  for (std::size_t i = 0; i < files.size(); ++i) EXPECT_EQ(first[i], second[i]) << files[i];
  EXPECT_SAYS(first[3], "<svg");
  EXPECT_SAYS(first[3], "LGA");
}

TEST(Report, FiguresAndTablesOfAnotherShapeAreRemoved) {
  FabricatedRun run;
  for (int n : {10, 20}) run.add({"lga", 10, "heart", n});
  run.save();
  report::write_report(run.path);
  const fs::path success = run.path / "figures/success_cells_mujoco";
  for (const char* file : {"figures/success_continuous_mujoco.svg", "figures/success_continuous_mujoco.pdf",
                           "tables/continuous_mujoco.tex", "tables/continuous_mujoco.csv", "tables/notes.txt"})
    write_file(run.path / file, "old");
  report::write_report(run.path);
  EXPECT_TRUE(fs::exists(success.string() + ".svg") && fs::exists(success.string() + ".pdf"));
  EXPECT_FALSE(fs::exists(run.path / "figures/success_continuous_mujoco.svg"));
  EXPECT_FALSE(fs::exists(run.path / "figures/success_continuous_mujoco.pdf"));
  EXPECT_FALSE(fs::exists(run.path / "tables/continuous_mujoco.tex"));
  EXPECT_FALSE(fs::exists(run.path / "tables/continuous_mujoco.csv"));
  EXPECT_TRUE(fs::exists(run.path / "tables/notes.txt"));
}

TEST(Report, EveryNumberOfItsTablesStandsInTheSummary) {
  FabricatedRun run;
  for (int seed = 0; seed < 3; ++seed)
    for (int n : {10, 20, 50})
      for (const char* scenario : {"heart", "letter"}) {
        run.add({"lga", 3 + n / 5 + seed, scenario, n, seed});
        run.add({"gcbc_dart", seed, scenario, n, seed});
        run.add({"constant_action", 2 + seed, scenario, n, seed, "reference"});
      }
  run.add({"oracle", 20, "heart", 0, 0, "reference"});
  const Json summary = summary_of(run);
  std::set<std::string> known;
  for (const Json& row : summary.at("rows")) {
    char text[64];
    std::snprintf(text, sizeof text, "%.2f [%.2f, %.2f]", row.at("success").get<double>(), row.at("low").get<double>(),
                  row.at("high").get<double>());
    known.insert(text);
  }
  const std::regex number(R"([+-]?\d\.\d\d \[[^\]]*\])");
  const auto numbers = [&number](const std::string& page) {
    std::set<std::string> shown;
    for (std::sregex_iterator it(page.begin(), page.end(), number), end; it != end; ++it) shown.insert(it->str());
    return shown;
  };
  EXPECT_EQ(numbers(table_text(run.path)), known);
  const Json claims = read_json(run.path / "claims.json");
  for (const Json& d : claims.at("claims").at(0).at("differences"))
    if (d.at("below") == "gcbc_dart") {
      char text[64];
      std::snprintf(text, sizeof text, "%+.2f [%+.2f, %+.2f]", d.at("difference").get<double>(),
                    d.at("these_scenarios").at("low").get<double>(), d.at("these_scenarios").at("high").get<double>());
      known.insert(text);
    }
  EXPECT_EQ(numbers(read_file(run.path / "report.md")), known);
}

TEST(Report, EpisodesHaveALineEach) {
  FabricatedRun run;
  FabricatedRun::Spec lga{"lga", 15};
  lga.attribution = "policy";
  lga.inputs_seen = 3;
  const fs::path cell = run.add(lga);
  run.add({"oracle", 20, "heart", 0, 0, "reference"});
  run.add_failed({"lga", 0, "letter"}, "host");
  summary_of(run);
  const std::string csv = read_file(run.path / "episodes.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 20 + 20);
  EXPECT_SAYS(csv, "\n" + cell.filename().string() +
                       ",heart,cells,mujoco,lga,method,20,0,,test,19,Bring me the heart.," + hex(19) +
                       ",false,missed_object,policy,false\n");
}

TEST(Report, AnIdCannotLeaveItsTextOrDirectory) {
  FabricatedRun run;
  run.add({"a</text><script>", 15, "heart", 20, 0, "method", "../../up"});
  run.save();
  report::write_report(run.path);
  const std::string figure = read_file(run.path / "figures/success_______up_mujoco.svg");
  EXPECT_SAYS(figure, "a&lt;/text&gt;&lt;script&gt;");
  EXPECT_SILENT(figure, "<script");
  EXPECT_TRUE(fs::exists(run.path / "figures/success_______up_mujoco.pdf"));
  EXPECT_TRUE(fs::exists(run.path / "tables/______up_mujoco_mean.csv"));
}

TEST(Run, WithoutACellSaysSo) {
  FabricatedRun run;
  run.run["cells"] = {"0123456789abcdef"};
  run.save();
  EXPECT_SAYS(message_of<InputError>([&] { report::write_report(run.path); }),
              "no cell of the run has been played yet");
  EXPECT_SAYS(message_of<InputError>([&] { table_text(run.path / "elsewhere"); }),
              "elsewhere/run.json: cannot be read");
}

TEST(Run, UnfinishedAndForeignDirectoriesAreNoCells) {
  FabricatedRun run;
  run.add({"lga", 15});
  fs::create_directories(run.path / "cells/.0123456789abcdef.77");
  fs::rename(run.add({"gcbc_dart", 5}), run.path / "cells/.fedcba9876543210.78");  // asked for, not there
  run.add({"lga", 1, "letter"});
  run.run["cells"].erase(2);  // there, not asked for
  const Json summary = summary_of(run);
  EXPECT_EQ(summary.at("rows").size(), 2u);
  const std::string text = table_text(run.path);
  EXPECT_SAYS(text, "1 of 2 cells have not run yet");
  EXPECT_SAYS(text, "1 cell directories that run.json does not list were left out");
}

// Bad input is named with file and place.
TEST(Run, CorruptFilesAreNamedWithTheirPlace) {
  const auto broken = [](const std::string& file, const std::function<std::string(std::string)>& change) {
    FabricatedRun run;
    const fs::path cell = run.add({"lga", 15});
    run.save();
    write_file(cell / file, change(read_file(cell / file)));
    return statistics::read_run(run.path).unreadable.at(0);
  };
  const auto half = [](const std::string& text) { return text.substr(0, text.size() / 2); };
  const auto replacing = [](const std::string& from, const std::string& to) {
    return [=](std::string text) { return text.replace(text.find(from), from.size(), to); };
  };
  EXPECT_SAYS(broken("episodes.jsonl", half), "episodes.jsonl: line 11: byte ");
  EXPECT_SAYS(broken("cell.json", half), "cell.json: byte ");
  EXPECT_SAYS(broken("status.json", half), "status.json: byte ");
  EXPECT_SAYS(broken("selection.json", [](auto) { return "[]\n"; }), "selection.json: /: expected an object");
  EXPECT_SAYS(broken("timing.json", replacing("learn_s", "slept_s")), "timing.json: /: expected a member \"learn_s\"");
  EXPECT_SAYS(broken("episodes.jsonl", replacing("missed_object", "bad_luck")),
              "episodes.jsonl: line 16: /failure: expected none, missed_object");
  EXPECT_SAYS(broken("episodes.jsonl", replacing("missed_object", "none")),
              "line 16: /failure: expected \"none\" exactly");
  EXPECT_SAYS(broken("episodes.jsonl", [](auto text) { return text.substr(0, text.find('\n') + 1); }),
              "episodes.jsonl: line 1: expected 20 episodes of arm \"test\", got 1");
  EXPECT_SAYS(broken("episodes.jsonl", replacing("\"attribution\":null", "\"attribution\":\"policy\"")),
              "line 1: /attribution: expected abstraction, policy, perception, reading on a method's failure, or null");
  EXPECT_SAYS(broken("episodes.jsonl", replacing("\"attribution\":null,", "")),
              "line 1: /: expected a member \"attribution\"");
  EXPECT_SAYS(broken("episodes.jsonl", replacing("\"index\":3", "\"index\":4")),
              "episodes.jsonl: line 5: /index: expected each index once");
  EXPECT_SAYS(broken("episodes.jsonl", replacing("\"command\":0", "\"command\":1")),
              "episodes.jsonl: line 1: /command: expected");
  EXPECT_SAYS(broken("selection.json", replacing("me the heart", "it")),
              "selection.json: /commands/0/utterance: expected the scenario's command \"Bring me the heart.\"");
  EXPECT_SAYS(broken("selection.json", [](auto) { return "{\"commands\":[]}\n"; }),
              "selection.json: /commands: expected an entry for each of the scenario's 1 commands");
  EXPECT_SAYS(broken("episodes.jsonl", replacing("0.5", "0.25")),
              "episodes.jsonl: differs from its checksum in status.json");
}

TEST(Run, ACellThatCannotBeReadTakesNothingFromOtherRows) {
  FabricatedRun run;
  run.add({"gcbc_dart", 5});
  const fs::path torn = run.add({"lga", 15, "heart", 50, 0}), nameless = run.add({"lga", 15, "heart", 50, 1});
  run.add({"lga", 10, "heart", 50, 2});
  run.save();
  write_file(torn / "episodes.jsonl", "{}\n");
  write_file(nameless / "cell.json", "{}\n");
  const Json summary = summary_of(run);
  ASSERT_EQ(summary.at("failed_cells").size(), 1u);
  EXPECT_EQ(summary.at("failed_cells")[0],
            (Json{{"cell", torn.filename().string()},
                  {"fault", "host"},
                  {"reason", "cannot be read: episodes.jsonl: line 1: /: expected a member \"arm\""}}));
  for (const Json& row : summary.at("rows")) {
    const bool whole = row.at("method") == "gcbc_dart";
    EXPECT_EQ(row.at("success"), whole ? .25 : .5);
    EXPECT_EQ(row.at("marks").dump().find("incomplete") == std::string::npos, whole) << row.at("marks");
  }
  EXPECT_SAYS(table_text(run.path), "2 of 4 cells cannot be read, and were left out.");
  for (const char* file : {"report.md", "report.html"}) {
    const std::string report = read_file(run.path / file);
    EXPECT_SAYS(report, torn.filename().string() + "/episodes.jsonl: line 1: /: expected a member");
    EXPECT_SAYS(report, nameless.filename().string() + "/cell.json: /: expected a member");
  }
  fs::remove_all(torn);
  write_file(run.path / "cells" / run.run["cells"][0].get<std::string>() / "cell.json", "");
  write_file(run.path / "cells" / run.run["cells"][3].get<std::string>() / "cell.json", "");
  EXPECT_SAYS(message_of<InputError>([&] { report::write_report(run.path); }), "cell.json: ");
}

TEST(Run, TwoCellsOfOneMeasurementAreRefused) {
  FabricatedRun run;
  run.add({"lga", 15});
  const fs::path twin = run.path / "cells/0123456789abcdef";
  fs::copy(run.path / "cells" / run.run["cells"][0].get<std::string>(), twin);
  run.run["cells"].push_back("0123456789abcdef");
  run.save();
  EXPECT_SAYS(message_of<InputError>([&] { report::write_report(run.path); }), "0123456789abcdef");
  EXPECT_SAYS(message_of<InputError>([&] { report::write_report(run.path); }), "measure the same");
}

}  // namespace
}  // namespace lgabench

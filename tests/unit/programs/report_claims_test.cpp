// The paper's claims on fabricated runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include <lgabench/report/report.hpp>
#include <lgabench/statistics/claims.hpp>

#include "report_run.hpp"

namespace lgabench {
namespace {

using statistics::Claim;
using statistics::ClaimedDifference;
using statistics::Verdict;
using Spec = FabricatedRun::Spec;

Claim claim_of(const FabricatedRun& run, const std::string& id, const std::string& layout = "cells") {
  Claim found;
  for (Claim& claim : statistics::test_claims(statistics::read_run(run.save().path)))
    if (claim.id == id && claim.layout == layout) {
      EXPECT_EQ(found.id, "") << "twice";
      found = std::move(claim);
    }
  EXPECT_EQ(found.id, id);
  return found;
}

const ClaimedDifference& between(const Claim& claim, const std::string& above, const std::string& below,
                                 const std::string& arm = "test", int n = 20) {
  for (const ClaimedDifference& d : claim.differences)
    if (d.above == above && d.below == below && d.arm == arm && d.demonstrations == n) return d;
  ADD_FAILURE() << "no difference " << above << " " << below << " " << arm << " " << n;
  static const ClaimedDifference none;
  return none;
}

std::string text_of(const Claim& claim) {
  return document::terminal(report::claims_section({claim}, statistics::MethodStyles(), "claims"));
}

// Three seeds of two scenarios; `won` of 20 in each.
void add_row(FabricatedRun& run, const std::string& method, int won, int demonstrations = 20) {
  for (const char* scenario : {"heart", "letter"})
    for (int seed = 0; seed < 3; ++seed) run.add({method, won, scenario, demonstrations, seed});
}

TEST(Claims, C1HeldAtEveryNumberOfDemonstrations) {
  FabricatedRun run;
  for (const int n : {10, 20}) {
    add_row(run, "lga", 18, n);
    add_row(run, "gcbc_seg", 9, n);
    add_row(run, "gcbc_dart", 2, n);
  }
  const Claim c1 = claim_of(run, "C1");
  EXPECT_EQ(c1.verdict, Verdict::held);
  EXPECT_EQ(c1.differences.size(), 4u);
  const ClaimedDifference& d = between(c1, "lga", "gcbc_seg", "test", 10);
  EXPECT_NEAR(d.these.change->difference, .45, 1e-12);
  EXPECT_EQ(d.scenarios, 2);
  EXPECT_EQ(d.policies, 6);
  EXPECT_EQ(claim_of(run, "C3").verdict, Verdict::not_tested);
  EXPECT_EQ(claim_of(run, "C3").reason, "needs a run of suite q2");
  EXPECT_EQ(claim_of(run, "C5").reason, "no human data");
}

TEST(Claims, AnyTwoRowsPaired) {
  FabricatedRun run;
  for (const int n : {10, 20}) {
    add_row(run, "mine+epochs=5", n == 10 ? 18 : 9, n);
    add_row(run, "gcbc_seg", 9, n);
  }
  add_row(run, "gcbc_dart", 2, 20);
  const auto results = statistics::read_run(run.save().path);
  const std::vector<Claim> claims = statistics::test_difference(results, "mine+epochs=5", "gcbc_seg");
  ASSERT_EQ(claims.size(), 1u);
  EXPECT_EQ(claims[0].verdict, Verdict::undecided);
  EXPECT_EQ(claims[0].differences.size(), 2u);
  EXPECT_EQ(between(claims[0], "mine+epochs=5", "gcbc_seg", "test", 10).these.verdict, Verdict::held);
  EXPECT_EQ(between(claims[0], "mine+epochs=5", "gcbc_seg", "test", 20).these.verdict, Verdict::undecided);
  EXPECT_EQ(between(claims[0], "mine+epochs=5", "gcbc_seg", "test", 10).policies, 6);
  EXPECT_EQ(statistics::test_difference(results, "gcbc_dart", "gcbc_seg")[0].verdict, Verdict::reversed);
  EXPECT_THROW(statistics::test_difference(results, "mine", "gcbc_seg"), InputError);
}

TEST(Claims, OneReversedDifferenceReversesTheClaim) {
  FabricatedRun run;
  add_row(run, "lga", 18, 10);
  add_row(run, "gcbc_seg", 9, 10);
  add_row(run, "gcbc_dart", 2, 10);
  add_row(run, "lga", 5, 20);
  add_row(run, "gcbc_seg", 15, 20);
  add_row(run, "gcbc_dart", 2, 20);
  const Claim c1 = claim_of(run, "C1");
  EXPECT_EQ(c1.verdict, Verdict::reversed);
  EXPECT_EQ(between(c1, "lga", "gcbc_seg", "test", 20).these.verdict, Verdict::reversed);
  EXPECT_EQ(between(c1, "lga", "gcbc_seg", "test", 10).these.verdict, Verdict::held);
}

TEST(Claims, UndecidedWhereChanceMayHaveDoneIt) {
  FabricatedRun run;
  run.add({"lga", 12});
  run.add({"gcbc_seg", 9});
  run.add({"gcbc_dart", 2});
  const Claim c1 = claim_of(run, "C1");
  EXPECT_EQ(c1.verdict, Verdict::undecided);
  EXPECT_EQ(between(c1, "lga", "gcbc_dart").these.verdict, Verdict::held);
}

// Six scenes that one alone won: McNemar's p is .03125, beyond chance alone, but not as one of two.
TEST(Claims, HolmCountsTheRowsCompared) {
  FabricatedRun run;
  run.add({"lga", 12});
  run.add({"gcbc_seg", 6});
  EXPECT_EQ(between(claim_of(run, "C1"), "lga", "gcbc_seg").these.verdict, Verdict::held);
  run.add({"gcbc_dart", 6});
  const ClaimedDifference d = between(claim_of(run, "C1"), "lga", "gcbc_seg");
  EXPECT_NEAR(d.these.change->p, .03125, 1e-12);
  EXPECT_NEAR(d.these.p_holm, .0625, 1e-12);
  EXPECT_EQ(d.these.verdict, Verdict::undecided);
}

TEST(Claims, NotTestedSaysWhatIsMissing) {
  FabricatedRun run;
  add_row(run, "lga", 18);
  add_row(run, "gcbc_dart", 2);
  EXPECT_EQ(claim_of(run, "C1").verdict, Verdict::not_tested);
  EXPECT_EQ(claim_of(run, "C1").reason, "no row gcbc_seg");
  // A variant is not the method as the paper has it.
  add_row(run, "gcbc_seg+dart=none", 2);
  EXPECT_EQ(claim_of(run, "C1").reason, "no row gcbc_seg");
  // A policy that failed has no pair: who fails on hard scenarios would gain by it.
  add_row(run, "gcbc_seg", 2);
  EXPECT_EQ(claim_of(run, "C1").verdict, Verdict::held);
  run.add({"lga", 18, "bowl"});
  run.add({"gcbc_dart", 2, "bowl"});
  run.add_failed({"gcbc_seg", 18, "bowl"}, "plugin");
  EXPECT_EQ(claim_of(run, "C1").verdict, Verdict::not_tested);
  EXPECT_EQ(claim_of(run, "C1").reason, "6 of 7 policies finished in both rows");
}

TEST(Claims, OfEachLayout) {
  FabricatedRun run;
  for (const auto& [method, cells, continuous] :
       {std::tuple("lga", 18, 2), {"gcbc_seg", 2, 18}, {"gcbc_dart", 2, 18}}) {
    run.add({method, cells});
    run.add({method, continuous, "heart", 20, 0, "method", "continuous"});
  }
  EXPECT_EQ(claim_of(run, "C1", "cells").verdict, Verdict::held);
  EXPECT_EQ(claim_of(run, "C1", "continuous").verdict, Verdict::reversed);
}

void add_human(FabricatedRun& run, const std::string& provenance, int lga, int human) {
  for (const auto& [method, won] : {std::pair("lga", lga), {"human", human}})
    for (const char* scenario : {"heart", "letter", "bowl", "ring", "star"})
      for (int seed = 0; seed < 3; ++seed) {
        Spec spec{method, won, scenario, 50, seed};
        if (spec.method == "human") spec.provenance = provenance;
        run.add(spec);
      }
}

TEST(Claims, C2NeedsPeople) {
  FabricatedRun run;
  add_human(run, "", 18, 18);  // the truth, standing in for a person
  EXPECT_EQ(claim_of(run, "C2").verdict, Verdict::not_tested);
  EXPECT_EQ(claim_of(run, "C2").reason, "no human data at 50 demonstrations");
}

TEST(Claims, C2IsAnEquivalenceWithinATenth) {
  for (const auto& [human, verdict] :
       {std::pair(18, Verdict::held), {14, Verdict::reversed}, {16, Verdict::undecided}}) {
    FabricatedRun run;
    add_human(run, "human", 18, human);
    EXPECT_EQ(claim_of(run, "C2").verdict, verdict) << human;
  }
}

// People's rows, invented: `won` of 20 and `seconds` a command of each participant, in five scenarios.
void add_person(FabricatedRun& run, const std::string& method, const std::string& id, int won, double seconds) {
  for (const char* scenario : {"heart", "letter", "bowl", "ring", "star"})
    for (int seed = 0; seed < 2; ++seed) {
      Spec spec{method, won, scenario, 50, seed};
      spec.provenance = "human";
      spec.participant = id;
      spec.human_seconds = seconds;
      run.add(spec);
    }
}

TEST(Claims, C2PairsEveryParticipantWithThePolicyOfTheSameSeed) {
  FabricatedRun run;
  for (const char* scenario : {"heart", "letter", "bowl", "ring", "star"})
    for (int seed = 0; seed < 2; ++seed) run.add({"lga", 18, scenario, 50, seed});
  add_person(run, "human", "p01", 18, 150);
  add_person(run, "human", "p02", 17, 160);
  add_person(run, "human", "p03", 19, 170);
  const Claim c2 = claim_of(run, "C2");
  EXPECT_EQ(c2.verdict, Verdict::held);
  const ClaimedDifference& d = between(c2, "lga", "human", "test", 50);
  EXPECT_NEAR(d.these.change->difference, 0, 1e-12);
  EXPECT_EQ(d.participants, 3);
  EXPECT_EQ(d.policies, 5 * 2 * 3);
  // People differ more than training seeds do: their own level of the bootstrap, with the floor of one's episodes.
  EXPECT_GT(d.these.change->interval.high, .02);

  // A participant whose policy failed has no pair, and no one gains by it.
  Spec failed{"human", 18, "heart", 50, 0};
  failed.participant = "p04";
  run.add_failed(failed, "plugin");
  EXPECT_EQ(claim_of(run, "C2").reason, "30 of 31 policies finished in both rows");
}

TEST(Claims, C2IsReversedWherePeopleDoMuchBetter) {
  FabricatedRun run;
  for (const char* scenario : {"heart", "letter", "bowl", "ring", "star"})
    for (int seed = 0; seed < 2; ++seed) run.add({"lga", 8, scenario, 50, seed});
  add_person(run, "human", "p01", 18, 150);
  add_person(run, "human", "p02", 17, 160);
  EXPECT_EQ(claim_of(run, "C2").verdict, Verdict::reversed);
}

TEST(Claims, C5TestsTheSecondsOfEachParticipant) {
  const auto verdict = [](double edited_1, double edited_2, double edited_3) {
    FabricatedRun run;
    add_person(run, "human", "p01", 18, 150);
    add_person(run, "human", "p02", 18, 160);
    add_person(run, "human", "p03", 18, 170);
    add_person(run, "lga_hill", "p01", 18, edited_1);
    add_person(run, "lga_hill", "p02", 18, edited_2);
    add_person(run, "lga_hill", "p03", 18, edited_3);
    add_person(run, "lga_hill", "p04", 18, 1);  // who did not specify anything from scratch
    return claim_of(run, "C5");
  };
  const Claim held = verdict(50, 59, 71);
  EXPECT_EQ(held.verdict, Verdict::held);
  ASSERT_EQ(held.differences.size(), 1u);
  const ClaimedDifference& d = held.differences[0];
  EXPECT_EQ(d.unit, "seconds");
  EXPECT_EQ(d.participants, 3);
  EXPECT_EQ(d.scenarios, 5);
  // Differences 100, 101, 99: mean 100, s = 1, t = 100 / (1 / sqrt(3)) with 2 degrees of freedom; t_.975 = 4.3027.
  EXPECT_NEAR(d.these.change->difference, 100, 1e-9);
  EXPECT_NEAR(d.these.change->interval.high, 100 + 4.302653 / std::sqrt(3.0), 1e-4);
  EXPECT_LT(d.these.change->p, .001);
  EXPECT_EQ(verdict(250, 261, 269).verdict, Verdict::reversed);
  EXPECT_EQ(verdict(50, 300, 170).verdict, Verdict::undecided);
}

TEST(Claims, C5NeedsPeopleInBothRows) {
  FabricatedRun run;
  add_human(run, "human", 18, 18);  // nobody by name
  EXPECT_EQ(claim_of(run, "C5").reason, "no human data");
  add_person(run, "human", "p01", 18, 150);
  EXPECT_EQ(claim_of(run, "C5").reason, "no human data");
  add_person(run, "lga_hill", "p01", 18, 50);
  EXPECT_EQ(claim_of(run, "C5").verdict, Verdict::not_tested);
  EXPECT_EQ(claim_of(run, "C5").reason, "expected 2 or more participants who answered in both ways, got 1");
}

TEST(Claims, C5OfACrossoverComparesPeoplesMeans) {
  FabricatedRun run;
  const auto answered = [&run](const char* method, const char* scenario, const char* id, double seconds) {
    Spec spec{method, 18, scenario, 50, 0};
    spec.provenance = "human";
    spec.participant = id;
    spec.human_seconds = seconds;
    run.add(spec);
  };
  for (const auto& [id, slow, fast] : {std::tuple("p01", 150., 50.), {"p02", 160., 59.}, {"p03", 170., 71.}}) {
    const bool first = std::string(id) == "p02";  // nobody saw a command twice
    for (const char* scenario : {"heart", "letter"})
      answered(first ? "human" : "lga_hill", scenario, id, first ? slow : fast);
    for (const char* scenario : {"bowl", "ring"})
      answered(first ? "lga_hill" : "human", scenario, id, first ? fast : slow);
  }
  const Claim c5 = claim_of(run, "C5");
  EXPECT_EQ(c5.verdict, Verdict::held);
  EXPECT_NEAR(c5.differences.at(0).these.change->difference, 100, 1e-9);
  EXPECT_EQ(c5.differences.at(0).scenarios, 4);
}

TEST(Claims, C2IsOnTheCommandsThatPeopleWereAsked) {
  FabricatedRun run;
  for (const char* scenario : {"heart", "letter", "bowl", "ring", "star", "pan", "line"})
    for (int seed = 0; seed < 2; ++seed) run.add({"lga", 18, scenario, 50, seed});
  add_person(run, "human", "p01", 18, 150);
  add_person(run, "human", "p02", 17, 160);
  const Claim c2 = claim_of(run, "C2");
  EXPECT_EQ(c2.verdict, Verdict::held) << c2.reason;
  EXPECT_EQ(c2.differences.at(0).by_scenario.size(), 5u);
  EXPECT_FALSE(c2.rehearsal);

  Spec spec{"human", 17, "star", 50, 0};
  spec.provenance = "human", spec.participant = "p03", spec.rehearsal = true;
  run.add(spec);
  EXPECT_TRUE(claim_of(run, "C2").rehearsal);
  EXPECT_FALSE(claim_of(run, "C1").rehearsal);
}

// As q2: three seeds of two scenarios, two arms.
void add_shifted(FabricatedRun& run, const std::string& method, int control, int texture,
                 const Json& options = Json::object()) {
  for (const char* scenario : {"q2_heart", "q2_bowl"})
    for (int seed = 0; seed < 3; ++seed) {
      Spec spec{method, 0, scenario, 50, seed};
      spec.arms = {{"control", control}, {"texture", texture}};
      spec.options = options;
      run.add(spec);
    }
}

TEST(Claims, C3ComparesWithLgaLThatSeesThePicture) {
  FabricatedRun run;
  run.run["suite"] = "q2";
  add_shifted(run, "lga", 2, 20);
  add_shifted(run, "lga_s", 2, 19);
  add_shifted(run, "gcbc_dart", 20, 1);
  add_shifted(run, "lga_l+image=none", 12, 20);
  EXPECT_EQ(claim_of(run, "C3").verdict, Verdict::not_tested);
  EXPECT_EQ(claim_of(run, "C3").reason, "no row lga_l with image=rgb");
  add_shifted(run, "lga_l", 20, 9, {{"image", "rgb"}});
  const Claim c3 = claim_of(run, "C3");
  EXPECT_EQ(c3.verdict, Verdict::held) << "the control arm, where nothing shifts and which is reversed, is no part, "
                                          "nor the row without the picture";
  EXPECT_EQ(c3.differences.size(), 4u);
  EXPECT_NEAR(between(c3, "lga_s", "lga_l", "texture", 50).these.change->difference, .5, 1e-12);
  EXPECT_EQ(c3.alike, Verdict::not_tested);
  EXPECT_EQ(c3.reason_alike, "none, six needed");
}

TEST(Claims, C3FindsThePictureWhereARowNamesIt) {  // as 0.1.0 did
  FabricatedRun run;
  run.run["suite"] = "q2";
  add_shifted(run, "lga", 2, 20);
  add_shifted(run, "lga_s", 2, 19);
  add_shifted(run, "gcbc_dart", 20, 1);
  add_shifted(run, "lga_l", 20, 20, {{"image", "none"}});
  add_shifted(run, "lga_l+image=rgb", 20, 9);
  EXPECT_EQ(claim_of(run, "C3").verdict, Verdict::held);
}

void add_ambiguous(FabricatedRun& run, const std::string& method, int seen, int unseen,
                   const Json& options = Json::object()) {
  for (int seed = 0; seed < 3; ++seed) {
    Spec spec{method, 0, "q3_fruit", 50, seed};
    spec.arms = {{"named", seen, {0, 1}}, {"kind", unseen, {2}}};
    spec.commands = {{"Bring me a tomato.", true}, {"Bring me an apple.", true}, {"Bring me a fruit.", false}};
    spec.options = options;
    run.add(spec);
  }
}

TEST(Claims, C4LooksAtUnseenCommandsWithOneInstance) {
  FabricatedRun run;
  run.run["suite"] = "q3";
  for (const char* method : {"lga", "lga_s"}) add_ambiguous(run, method, 20, 0, {{"instances", "all"}});
  add_ambiguous(run, "gcbc_dart", 20, 3);
  add_ambiguous(run, "lga_l", 20, 5, {{"image", "rgb"}});
  EXPECT_EQ(claim_of(run, "C4").verdict, Verdict::not_tested);
  EXPECT_EQ(claim_of(run, "C4").reason, "no row with instances=first");
  add_ambiguous(run, "lga+epochs=5+instances=first", 2, 0);  // no LGA as shipped
  EXPECT_EQ(claim_of(run, "C4").reason, "no row with instances=first");
  add_ambiguous(run, "lga+instances=first", 2, 20);
  EXPECT_EQ(claim_of(run, "C4").reason, "no row lga_s with instances=first") << "half of it is tested";
  EXPECT_EQ(between(claim_of(run, "C4"), "lga_s", "lga_l", "kind", 50).these.reason,
            "no row lga_s with instances=first");
  add_ambiguous(run, "lga_s+instances=first", 2, 20);
  const Claim c4 = claim_of(run, "C4");
  EXPECT_EQ(c4.verdict, Verdict::held);
  EXPECT_EQ(c4.differences.size(), 4u);
  EXPECT_NEAR(between(c4, "lga+instances=first", "lga_l", "kind", 50).these.change->difference, .75, 1e-12);
}

TEST(Claims, AreTestedOnTheseScenariosAndOnScenariosLikeThem) {
  FabricatedRun run;
  // One scenario in which LGA is far above, five in which it is a little below.
  const std::vector<const char*> scenarios{"tiger", "heart", "letter", "bowl", "ring", "star"};
  for (std::size_t i = 0; i < scenarios.size(); ++i)
    for (int seed = 0; seed < 3; ++seed) {
      run.add({"lga", i == 0 ? 20 : 9, scenarios[i], 20, seed});
      for (const char* baseline : {"gcbc_seg", "gcbc_dart"})
        run.add({baseline, i == 0 ? 0 : 10, scenarios[i], 20, seed});
    }
  const Claim c1 = claim_of(run, "C1");
  EXPECT_EQ(c1.verdict, Verdict::held);
  EXPECT_EQ(c1.alike, Verdict::undecided);
  const ClaimedDifference& d = between(c1, "lga", "gcbc_seg");
  EXPECT_EQ(d.scenarios, 6);
  EXPECT_EQ(d.scenes, 120);
  EXPECT_EQ(d.seeds, 3);
  ASSERT_EQ(d.by_scenario.size(), 6u);
  const std::map<std::string, double> by_scenario(d.by_scenario.begin(), d.by_scenario.end());
  EXPECT_EQ(by_scenario.at("tiger"), 1);
  // Differences 1 and five times -.05: mean .125, s = .42866; t with 5 degrees of freedom, t_.975 = 2.5706.
  EXPECT_NEAR(d.alike.change->interval.low, .125 - 2.570582 * .428661 / std::sqrt(6.0), 1e-4);
  EXPECT_NEAR(d.alike.p_holm, std::min(1.0, 2 * d.alike.change->p), 1e-12) << "Holm's over the two baselines";

  EXPECT_SAYS(text_of(c1), "these scenarios: held\n      scenarios like these: undecided\n");
  report::write_report(run.save().path);
  const Json json = read_json(run.path / "claims.json").at("claims").at(0);
  EXPECT_EQ(json.at("scenarios_like_these").at("verdict"), "undecided");
  EXPECT_EQ(json.at("differences").at(0).at("by_scenario").size(), 6u);
  EXPECT_EQ(json.at("differences").at(0).at("scenarios_like_these").at("p"), d.alike.change->p);
}

TEST(Claims, OfOneSeedSaySo) {
  FabricatedRun run;
  for (const char* scenario : {"heart", "letter"})
    for (const auto& [method, won] : {std::pair("lga", 18), {"gcbc_seg", 9}, {"gcbc_dart", 2}})
      run.add({method, won, scenario});
  EXPECT_EQ(claim_of(run, "C1").verdict, Verdict::held);
  EXPECT_SAYS(text_of(claim_of(run, "C1")), "2 policies, 2 scenarios, 40 scenes, for this training seed");
  add_row(run, "lga", 18, 50);
  add_row(run, "gcbc_seg", 9, 50);
  EXPECT_SAYS(text_of(claim_of(run, "C1")), "6 policies, 2 scenarios, 40 scenes\n");
}

// Another file of claims, another verdict: none of them is in the program.
TEST(Claims, AreWhatTheirFileSays) {
  TemporaryDirectory data;
  fs::copy(data_directory() / "paper", data.path / "paper", fs::copy_options::recursive);
  Json file = read_json(data.path / "paper/claims.json");
  file["claims"] = {{{"id", "X"},
                     {"statement", "my method above LGA"},
                     {"test", "ordering"},
                     {"arms", "all"},
                     {"above", {"my_method+size=2"}},
                     {"below", {"lga"}}}};
  write_file(data.path / "paper/claims.json", canonical(file));
  FabricatedRun run;
  add_row(run, "lga", 2);
  add_row(run, "my_method+size=2", 18);
  run.save();
  ::setenv("LGABENCH_DATA", data.path.c_str(), 1);
  const std::vector<Claim> claims = statistics::test_claims(statistics::read_run(run.path));
  file["claims"][0]["test"] = "guess";
  write_file(data.path / "paper/claims.json", canonical(file));
  const std::string refused = message_of<InputError>([&] { statistics::test_claims(statistics::read_run(run.path)); });
  ::unsetenv("LGABENCH_DATA");
  ASSERT_EQ(claims.size(), 1u);
  EXPECT_EQ(claims[0].id, "X");
  EXPECT_EQ(claims[0].verdict, Verdict::held);
  EXPECT_NEAR(between(claims[0], "my_method+size=2", "lga").these.change->difference, .8, 1e-12);
  EXPECT_SAYS(refused, "claims.json: /claims/0/test: expected ordering, equivalence, seconds");
}

TEST(Claims, StandInTheReportAndInClaimsJson) {
  FabricatedRun run;
  run.add({"lga", 20});
  run.add({"gcbc_seg", 2});
  run.add({"gcbc_dart", 2});
  report::write_report(run.save().path);
  const Json json = read_json(run.path / "claims.json");
  EXPECT_EQ(json.at("claims").at(0).at("verdict"), "held");
  EXPECT_NEAR(json.at("claims").at(0).at("differences").at(0).at("difference").get<double>(), .9, 1e-12);
  const std::string before = read_file(run.path / "claims.json");
  report::write_report(run.path);
  EXPECT_EQ(read_file(run.path / "claims.json"), before);
}

}  // namespace
}  // namespace lgabench

// A suite's own claims on fabricated runs: each form held, refuted and undecided, and the file refused with its place.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include <lgabench/record/suite_claims.hpp>
#include <lgabench/report/report.hpp>
#include <lgabench/statistics/claims.hpp>

#include "report_run.hpp"

namespace lgabench {
namespace {

using statistics::Claim;
using statistics::Verdict;

Json claim(const std::string& id, const std::string& test, const Json& more = Json::object()) {
  Json json{{"id", id},         {"statement", "A " + id}, {"refuted_if", "it is not so"},
            {"test", test},     {"above", "lga"},         {"below", "gcbc_seg"},
            {"arms", {"test"}}, {"demonstrations", {20}}};
  json.update(more);
  return json;
}

Json claims_of(const std::vector<Json>& claims) { return {{"claims", claims}}; }

// Three seeds of two scenarios; `won` of 20 in each, of scenes of each seed's own.
void add_row(FabricatedRun& run, const std::string& method, int won, int demonstrations = 20,
             const Json& errors = nullptr) {
  for (const char* scenario : {"heart", "letter"})
    for (int seed = 0; seed < 3; ++seed) {
      FabricatedRun::Spec spec{method, won, scenario, demonstrations, seed};
      spec.first_scene = 100 * seed;
      spec.selection_errors = errors;
      run.add(spec);
    }
}

std::map<std::string, Claim> tested(FabricatedRun& run, const std::vector<Json>& claims) {
  run.run["claims"] = claims_of(claims);
  std::map<std::string, Claim> all;
  for (Claim& one : statistics::test_claims(statistics::read_run(run.save().path))) all[one.id] = std::move(one);
  return all;
}

Verdict verdict_of(int lga, int gcbc_seg, const Json& one) {
  FabricatedRun run;
  add_row(run, "lga", lga);
  add_row(run, "gcbc_seg", gcbc_seg);
  return tested(run, {one}).begin()->second.verdict;
}

TEST(SuiteClaims, AnOrdering) {
  EXPECT_EQ(verdict_of(18, 4, claim("K", "ordering")), Verdict::held);
  EXPECT_EQ(verdict_of(4, 18, claim("K", "ordering")), Verdict::reversed);
  EXPECT_EQ(verdict_of(10, 10, claim("K", "ordering")), Verdict::undecided);
}

TEST(SuiteClaims, BetterByAMarginAtMost) {
  const Json one = claim("K", "at_most", {{"margin", .2}});
  EXPECT_EQ(verdict_of(10, 10, one), Verdict::held);
  EXPECT_EQ(verdict_of(4, 18, one), Verdict::held) << "worse is no more than a margin better";
  EXPECT_EQ(verdict_of(18, 4, one), Verdict::reversed);
  EXPECT_EQ(verdict_of(14, 10, one), Verdict::undecided);
}

TEST(SuiteClaims, WithinAMarginOfEachOther) {
  const Json one = claim("K", "equivalence", {{"margin", .2}});
  EXPECT_EQ(verdict_of(10, 10, one), Verdict::held);
  EXPECT_EQ(verdict_of(4, 18, one), Verdict::reversed);
  EXPECT_EQ(verdict_of(18, 4, one), Verdict::reversed);
  EXPECT_EQ(verdict_of(10, 14, one), Verdict::undecided);
}

// Success of both rows where no feature is missing, a tenth of them, and two.
Claim slope_of(const std::array<int, 3>& lga, const std::array<int, 3>& gcbc_seg) {
  FabricatedRun run;
  for (const auto& [row, won] : {std::pair("lga", lga), {"gcbc_seg", gcbc_seg}}) {
    add_row(run, row, won[0]);
    add_row(run, row + std::string("+missing=0.1"), won[1], 20, {{"missing", .1}});
    add_row(run, row + std::string("+missing=0.2"), won[2], 20, {{"missing", .2}});
  }
  return tested(run, {claim("K", "slope", {{"option", "missing"}, {"levels", {0, .1, .2}}})}).at("K");
}

TEST(SuiteClaims, LosesLessPerTenthOfAnError) {
  const Claim held = slope_of({18, 17, 16}, {18, 10, 2});
  EXPECT_EQ(held.verdict, Verdict::held);
  ASSERT_EQ(held.differences.size(), 1u);
  // A loses 1 of 20 a tenth, B 8.
  EXPECT_NEAR(held.differences[0].these.change->difference, -1. / 20 + 8. / 20, 1e-9);
  EXPECT_EQ(held.differences[0].unit, "success per 0.1 of missing");
  for (const auto& [scenario, difference] : held.differences[0].by_scenario) EXPECT_NEAR(difference, .35, 1e-9);
  EXPECT_EQ(slope_of({18, 10, 2}, {18, 17, 16}).verdict, Verdict::reversed);
  EXPECT_EQ(slope_of({18, 15, 12}, {15, 12, 9}).verdict, Verdict::undecided) << "lower, and as steep";
}

TEST(SuiteClaims, ASlopeOfAMethodsOwnOption) {
  FabricatedRun run;
  for (const auto& [row, won] : {std::pair("lga+missing=0", 18),
                                 {"lga+missing=0.4", 16},
                                 {"gcbc_seg+missing=0.0", 18},
                                 {"gcbc_seg+missing=0.4", 2}}) {
    for (int seed = 0; seed < 3; ++seed) {
      FabricatedRun::Spec spec{row, won, "heart", 20, seed};
      spec.options["missing"] = std::string(row).find("0.4") == std::string::npos ? 0. : .4;
      run.add(spec);
    }
  }
  const Json one = claim("K", "slope", {{"option", "missing"}, {"levels", {0, .4}}});
  EXPECT_EQ(tested(run, {one}).at("K").verdict, Verdict::held);
  const Json another = claim("K", "slope", {{"option", "missing"}, {"levels", {0, .2}}});
  EXPECT_EQ(tested(run, {another}).at("K").reason, "no row lga with missing=0.2");
}

TEST(SuiteClaims, NoNumberOfDemonstrationsAtWhichTheOtherIsBetter) {
  const Json one = claim("K", "at_most", {{"above", "gcbc_seg"}, {"below", "lga"}, {"margin", 0}});
  Json everywhere = one;
  everywhere.erase("demonstrations");
  FabricatedRun run;
  for (const int n : {5, 20}) {
    add_row(run, "lga", 16, n);
    add_row(run, "gcbc_seg", n == 5 ? 4 : 8, n);
  }
  const Claim held = tested(run, {everywhere}).at("K");
  EXPECT_EQ(held.differences.size(), 2u);
  EXPECT_EQ(held.verdict, Verdict::held);
  FabricatedRun other;
  for (const int n : {5, 20}) {
    add_row(other, "lga", n == 5 ? 16 : 4, n);
    add_row(other, "gcbc_seg", n == 5 ? 4 : 16, n);
  }
  EXPECT_EQ(tested(other, {everywhere}).at("K").verdict, Verdict::reversed) << "at 20";
  EXPECT_EQ(tested(other, {everywhere, claim("at_5", "ordering", {{"demonstrations", {5}}})}).at("at_5").verdict,
            Verdict::held);
}

TEST(SuiteClaims, AreCorrectedForEachOther) {
  FabricatedRun run;
  // One scenario, one policy: McNemar's p of 6 scenes to none is .031.
  run.add({"lga", 12, "heart", 20});
  run.add({"gcbc_seg", 6, "heart", 20});
  EXPECT_EQ(tested(run, {claim("K1", "ordering")}).at("K1").verdict, Verdict::held);
  const auto both = tested(run, {claim("K1", "ordering"), claim("K2", "ordering")});
  EXPECT_NEAR(both.at("K1").differences[0].these.p_holm, .0625, 1e-12);
  EXPECT_EQ(both.at("K1").verdict, Verdict::undecided);
}

TEST(SuiteClaims, SayWhatIsMissing) {
  FabricatedRun run;
  add_row(run, "lga", 18);
  EXPECT_EQ(tested(run, {claim("K", "ordering")}).at("K").reason, "no row gcbc_seg");
  add_row(run, "gcbc_seg", 4);
  EXPECT_EQ(tested(run, {claim("K", "ordering", {{"arms", {"moved"}}})}).at("K").reason, "no arm moved");
  EXPECT_EQ(tested(run, {claim("K", "ordering", {{"scenarios", {"bowl"}}})}).at("K").verdict, Verdict::not_tested);
  EXPECT_EQ(tested(run, {claim("K", "ordering", {{"scenarios", {"heart"}}})}).at("K").differences[0].scenarios, 1);
}

TEST(SuiteClaims, StandInThePlaceOfThePapers) {
  FabricatedRun run;
  add_row(run, "lga", 18);
  add_row(run, "gcbc_seg", 4);
  run.run["claims"] = claims_of({claim("K", "ordering")});
  const report::Report report = report::write_report(run.save().path);
  const std::string page = read_file(run.path / "report.html"), text = read_file(run.path / "report.md");
  EXPECT_SAYS(text, "## The suite's claims");
  EXPECT_SILENT(text, "The paper's claims");
  EXPECT_SAYS(text, "it is not so");
  EXPECT_SAYS(page, "The suite’s claims");
  const Json claims = read_json(run.path / "claims.json").at("claims");
  ASSERT_EQ(claims.size(), 1u);
  EXPECT_EQ(claims[0].at("refuted_if"), "it is not so");
}

TEST(SuiteClaims, AreRefusedWithFileAndPlace) {
  const auto complaint = [](const char* merge_patch) {
    Json one = claim("K", "at_most", {{"margin", .1}});
    one.merge_patch(Json::parse(merge_patch));
    return message_of<InputError>([&] { read_suite_claims(claims_of({one}), "mine.json"); });
  };
  EXPECT_SAYS(complaint(R"({"test": "better"})"),
              "mine.json: /claims/0/test: expected one of: ordering, at_most, equivalence, slope");
  EXPECT_SAYS(complaint(R"({"margin": null})"), "/claims/0");
  EXPECT_SAYS(complaint(R"({"margin": -0.1})"), "/claims/0/margin: expected a difference of success below 1");
  EXPECT_SAYS(complaint(R"({"test": "ordering"})"), "margin");
  EXPECT_SAYS(complaint(R"({"test": "slope", "margin": null})"), "option");
  EXPECT_SAYS(complaint(R"({"test": "slope", "margin": null, "option": "missing", "levels": [0.1]})"), "two levels");
  EXPECT_SAYS(complaint(R"({"test": "slope", "margin": null, "option": "missing", "levels": [0.1, 0]})"), "which grow");
  EXPECT_SAYS(complaint(R"({"refuted_if": ""})"), "/claims/0/refuted_if: expected a sentence");
  EXPECT_SAYS(complaint(R"({"refuted_if": null})"), "refuted_if");
  EXPECT_SAYS(complaint(R"({"below": "lga"})"), "another row");
  EXPECT_SAYS(complaint(R"({"below": "lga+picture"})"), "/claims/0/below: expected a row");
  EXPECT_SAYS(complaint(R"({"demonstrations": [5, 5]})"), "/claims/0/demonstrations/1: expected each once");
  EXPECT_SAYS(complaint(R"({"arms": []})"), "/claims/0/arms: expected one or more");
  EXPECT_SAYS(complaint(R"({"surprise": 1})"), "surprise");
  EXPECT_SAYS(message_of<InputError>([] {
                read_suite_claims(claims_of({claim("K", "ordering"), claim("K", "ordering")}), "mine.json");
              }),
              "mine.json: /claims/1/id: expected each id once");
}

TEST(SuiteClaims, LieBesideTheSuite) {
  const TemporaryDirectory directory;
  EXPECT_TRUE(claims_beside(directory.path / "mine.json").is_null());
  fs::create_directory(directory.path / "claims");
  write_file(directory.path / "claims" / "mine.json", canonical(claims_of({claim("K", "ordering")})));
  EXPECT_EQ(claims_beside(directory.path / "mine.json").at("claims").size(), 1u);
  write_file(directory.path / "claims" / "mine.json", "{}");
  EXPECT_SAYS(message_of<InputError>([&] { claims_beside(directory.path / "mine.json"); }), "claims/mine.json");
}

}  // namespace
}  // namespace lgabench

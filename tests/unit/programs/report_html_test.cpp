// report.html of fabricated runs: what stands in it is what was measured, and nothing comes from outside.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <set>

#include <lgabench/core/environments.hpp>
#include <lgabench/document/writers.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/report/report.hpp>
#include <lgabench/statistics/names.hpp>
#include <lgabench/statistics/tables.hpp>

#include "report_run.hpp"

namespace lgabench {
namespace {

// Two numbers of demonstrations, two seeds, arms, Selections, attributed failures, a failed cell.
void fill(FabricatedRun& run) {
  for (int seed = 0; seed < 2; ++seed)
    for (const int n : {10, 50})
      for (const char* scenario : {"heart", "letter"}) {
        FabricatedRun::Spec lga{"lga", 0, scenario, n, seed};
        lga.arms = {{"control", 10 + n / 10 + seed, {0}, .5}, {"hard", 5 + seed, {0}, .5}};
        lga.attribution = seed == 0 ? "abstraction" : "policy";
        lga.inputs_seen = 3 + seed;
        run.add(lga);
        FabricatedRun::Spec gcbc{"gcbc_dart", 0, scenario, n, seed, "method", "cells", "wrong_object"};
        gcbc.arms = {{"control", 3, {0}, .4}, {"hard", seed, {0}, .6}};
        run.add(gcbc);
        FabricatedRun::Spec constant{"constant_action", 0, scenario, n, seed, "reference"};
        constant.arms = {{"control", 5, {0}, .5}, {"hard", 4, {0}, .5}};
        run.add(constant);
      }
  run.add_failed({"lga", 0, "heart", 10, 2}, "host");
}

std::string page_of(const FabricatedRun& run) {
  report::write_report(run.save().path);
  return read_file(run.path / "report.html");
}

Json data_of(const std::string& page) {
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const std::size_t begin = page.find(open) + open.size();
  return Json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

// The sections whose tables are made of summary.json.
std::string measured(const std::string& page) {
  std::string text;
  for (const char* id : {"success", "phi", "failures", "attribution"}) {
    const std::size_t begin = page.find(std::string("<section id=\"") + id + "\"");
    if (begin != std::string::npos) text += page.substr(begin, page.find("</section>", begin) - begin);
  }
  return text;
}

TEST(Html, EveryNumberOfATableStandsInTheSummary) {
  for (const bool several_arms : {true, false}) {
    FabricatedRun run;
    if (several_arms) {
      fill(run);
    } else {
      FabricatedRun::Spec lga{"lga", 15};
      lga.inputs_seen = 7;
      run.add(lga);
      run.add({"lga", 12, "letter", 50});
      run.add({"oracle", 20, "heart", 0, 0, "reference"});
    }
    const std::string page = page_of(run);
    const Json summary = read_json(run.path / "summary.json");

    const std::regex value("<span data-value=\"([^\"]*)\">([^<]*)</span>");
    std::set<std::string> shown;
    for (std::sregex_iterator it(page.begin(), page.end(), value), end; it != end; ++it) {
      const std::string pointer = it->str(1), text = it->str(2);
      if (pointer.rfind("/claims/", 0) == 0) continue;  // the next test's
      const Json& number = summary.at(Json::json_pointer(pointer));
      const std::size_t dot = text.find('.');
      const double half = dot == std::string::npos ? 0 : .5 * std::pow(10, -static_cast<double>(text.size() - dot - 1));
      EXPECT_NEAR(std::stod(text), number.get<double>(), half + 1e-9) << pointer;
      shown.insert(pointer);
    }
    // No number of a row is left out ...
    for (std::size_t i = 0; i < summary.at("rows").size(); ++i) {
      const Json& row = summary.at("rows")[i];
      if (row.at("success").is_null()) continue;
      const std::string place = "/rows/" + std::to_string(i) + "/";
      for (const char* member : {"success", "low", "high"}) EXPECT_EQ(shown.count(place + member), 1u) << place;
      EXPECT_EQ(shown.count(place + "inputs_seen"), row.at("inputs_seen").is_null() ? 0u : 1u) << place;
      if (!row.at("shift").is_null()) {
        for (const char* member : {"difference", "low", "high"})
          EXPECT_EQ(shown.count(place + "shift/" + member), 1u) << place;
      }
      if (row.at("scenario") != "(mean)") continue;
      for (const auto& item : row.at("failures").items()) EXPECT_EQ(shown.count(place + "failures/" + item.key()), 1u);
      const int blamed =
          row.at("attribution").at("abstraction").get<int>() + row.at("attribution").at("policy").get<int>();
      EXPECT_EQ(shown.count(place + "attribution/policy"), blamed > 0 ? 1u : 0u);
    }
    EXPECT_EQ(shown.count("/rows/0/phi/0/quality/target/textures/recall"), 1u);

    // ... and none stands there that is not the summary's, but for the paper's.
    std::string cells = std::regex_replace(measured(page), value, "");
    cells = std::regex_replace(cells, std::regex("<i class=paper>[^<]*</i>"), "");
    const std::regex cell("<td>(.*?)</td>"), tag("<[^>]*>"), number("(^|[\\s\\[])[+-]?\\d");
    int seen = 0;
    for (std::sregex_iterator it(cells.begin(), cells.end(), cell), end; it != end; ++it, ++seen) {
      const std::string text = std::regex_replace(it->str(1), tag, "");
      EXPECT_FALSE(text != "0" && std::regex_search(text, number)) << text;  // no member for a failure that was none
    }
    EXPECT_GT(seen, 15);
  }
}

// Those of claims.json, in the same way.
TEST(Html, EveryNumberOfAClaimStandsInClaimsJson) {
  FabricatedRun run;
  fill(run);
  for (const char* id : {"p01", "p02"})
    for (const char* method : {"human", "lga_hill"}) {  // invented people
      FabricatedRun::Spec person{method, 18, "heart", 50, 0};
      person.arms = {{"control", 18}, {"hard", 17}};
      person.provenance = "human";
      person.participant = id;
      person.human_seconds = (*method == 'h' ? 150 : 50) + id[2];
      run.add(person);
    }
  const std::string page = page_of(run);
  const Json claims = read_json(run.path / "claims.json");
  const std::regex value("<span data-value=\"(/claims/[^\"]*)\">([^<]*)</span>");
  std::set<std::string> shown;
  for (std::sregex_iterator it(page.begin(), page.end(), value), end; it != end; ++it) {
    const std::string text = it->str(2);
    const std::size_t dot = text.find('.');
    const double half = dot == std::string::npos ? 0 : .5 * std::pow(10, -static_cast<double>(text.size() - dot - 1));
    EXPECT_NEAR(std::stod(text), claims.at(Json::json_pointer(it->str(1))).get<double>(), half + 1e-9) << it->str(1);
    shown.insert(it->str(1));
  }
  int tested = 0;
  for (std::size_t c = 0; c < claims.at("claims").size(); ++c) {
    const Json& claim = claims.at("claims")[c];
    EXPECT_SAYS(page, statistics::readable(claim.at("statement")));
    for (std::size_t d = 0; d < claim.at("differences").size(); ++d) {
      if (claim.at("differences")[d].at("difference").is_null()) continue;
      ++tested;
      const std::string place = "/claims/" + std::to_string(c) + "/differences/" + std::to_string(d) + "/";
      for (const char* member : {"difference", "these_scenarios/low", "these_scenarios/high", "participants",
                                 "policies", "scenarios", "scenes"}) {
        const Json& number = claims.at(Json::json_pointer(place + member));
        const bool nothing = number.is_number_integer() && number == 0;  // such a count is left out
        EXPECT_EQ(shown.count(place + member), nothing ? 0u : 1u) << place << member;
      }
    }
  }
  EXPECT_GE(tested, 1);  // C5
  EXPECT_SILENT(page, "no human data.");
}

TEST(Html, NothingIsFetched) {
  FabricatedRun run;
  fill(run);
  std::string page = page_of(run);
  const std::string icon = "<link rel=\"icon\" href=\"data:image/svg+xml,";
  ASSERT_EQ(page.find("<link"), page.find(icon));
  page.erase(page.find(icon), icon.size());
  for (const char* outside : {"http://", "https://", " src=", "<link", "@import", "url(", "fetch(", "import("})
    EXPECT_SILENT(page, outside);
}

TEST(Html, TheSameRunGivesTheSameBytes) {
  FabricatedRun run;
  fill(run);
  const std::string first = page_of(run);
  EXPECT_EQ(first, page_of(run));
}

TEST(Html, TextOfFilesStaysText) {
  FabricatedRun run;
  FabricatedRun::Spec odd{"<script>alert(1)</script>", 5, "a&b"};
  odd.commands = {{"</script><b>bold</b> \"quoted\"", true}};
  run.add(odd);
  const std::string page = page_of(run);
  EXPECT_SILENT(page, "<script>alert");
  EXPECT_SILENT(page, "<b>bold");
  EXPECT_SAYS(page, "&lt;script&gt;alert(1)&lt;/script&gt;");
  EXPECT_SAYS(page, "a&amp;b");
  EXPECT_EQ(data_of(page).at("cells")[0].at("commands")[0], "</script><b>bold</b> \"quoted\"");
}

// What a click on a number lists adds up to the number.
TEST(Html, ANumberLeadsToItsEpisodes) {
  FabricatedRun run;
  fill(run);
  const Json data = data_of(page_of(run)), summary = read_json(run.path / "summary.json");
  std::map<std::size_t, std::pair<int, int>> counted;  // row -> episodes, won
  std::map<std::size_t, int> blamed;
  for (const Json& cell : data.at("cells"))
    for (const Json& arm : cell.at("arms")) {
      const std::string outcomes = arm.at("outcomes"), attribution = arm.at("attribution");
      EXPECT_EQ(data.at("scenes").at(arm.at("scenes").get<std::size_t>()).size(), outcomes.size());
      EXPECT_EQ(arm.at("commands").size(), outcomes.size());
      for (const std::size_t row : arm.at("rows")) {
        counted[row].first += static_cast<int>(outcomes.size());
        counted[row].second += static_cast<int>(std::count(outcomes.begin(), outcomes.end(), '.'));
        blamed[row] += static_cast<int>(std::count(attribution.begin(), attribution.end(), 'a'));
      }
    }
  EXPECT_EQ(counted.size(), summary.at("rows").size());
  for (const auto& [row, numbers] : counted) {
    EXPECT_EQ(summary.at("rows")[row].at("episodes"), numbers.first);
    EXPECT_EQ(summary.at("rows")[row].at("successes"), numbers.second);
    EXPECT_EQ(summary.at("rows")[row].at("attribution").at("abstraction"), blamed[row]);
  }
}

// Of episodes of so many steps, the last of which has a picture of its scene.
std::string page_of_steps(std::size_t steps) {
  FabricatedRun run;
  FabricatedRun::Spec spec{"lga", 19};
  spec.arms = {{"test", 19, {0}, .3}};
  spec.arms.front().steps = steps;
  run.add(spec);
  const statistics::RunResults results = statistics::read_run(run.save().path);
  report::Pictures pictures;
  pictures.wanted = 1;
  pictures.scenes[hex(19)] = "PNG";
  const statistics::Summary summary = statistics::summarize(results);
  const std::vector<statistics::Claim> claims = statistics::test_claims(results);
  const std::vector<statistics::EngineAgreement> agreements;
  const statistics::PaperValues paper = statistics::paper_values("q1");
  const report::Material material{results, summary, claims, agreements, paper, pictures};
  return document::html(report::report_document(material), report::page_data(material));
}

TEST(Html, ActionsAreDrawnWhereTheyWere) {
  const std::string page = page_of_steps(1);
  // x = .3 lies .05/.5 of the way down, y = .3 .8 of the way to the right.
  const Json places{{204.8, 12.8}, {204.8, 12.8}};
  const Json arm = data_of(page).at("cells")[0].at("arms")[0];
  EXPECT_EQ(arm.at("actions"), (Json{{"19", places}}));
  EXPECT_FALSE(arm.contains("then"));
  EXPECT_SAYS(page, "Pictures: 1 of the 1 scenes");
  const Json of_three = data_of(page_of_steps(3)).at("cells")[0].at("arms")[0];
  EXPECT_EQ(of_three.at("actions"), arm.at("actions"));
  EXPECT_EQ(of_three.at("then"), (Json{{"19", Json::array({places, places})}}));
}

TEST(Html, EveryFailureAndEveryCauseHasAColour) {
  const std::string style = read_file(data_directory() / "page" / "page.css");
  EXPECT_LE(failure_words().size(), static_cast<std::size_t>(document::failure_colours)) << "two would look alike";
  for (std::ptrdiff_t i = 0; i < document::failure_colours; ++i) EXPECT_SAYS(style, fmt::format(".f{} {{ --c: #", i));
  for (const char* cause : attributions) EXPECT_SAYS(style, fmt::format(".{} {{ --c: #", cause));
}

}  // namespace
}  // namespace lgabench

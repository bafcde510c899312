#include <gtest/gtest.h>

#include <lgabench/report/report.hpp>

#include "../../schemas.hpp"
#include "report_run.hpp"

namespace lgabench {
namespace {

using Complaints = std::vector<std::string>;

// Every file of a run with finished cells (one of them with several arms) and a failed one, as schema name and
// document.
std::vector<std::pair<std::string, Json>> run_documents() {
  FabricatedRun run;
  run.add({"lga", 15});
  FabricatedRun::Spec arms{"lga", 0, "letter"};
  arms.arms = {{"test", 15}, {"hard", 10}};
  run.add(arms);
  FabricatedRun::Spec elsewhere{"lga", 12};
  elsewhere.engine = "bullet";
  run.add(elsewhere);
  FabricatedRun::Spec perturbed{"lga", 0, "letter", 10};
  perturbed.arms = {{"test", 15}, {"sensor_noise_2", 5}};
  perturbed.arms.back().perturbation = {{"sensor_noise", 2}};
  perturbed.train_on = {{"sensor_noise", "any"}};
  run.add(perturbed);
  run.add_failed({"gcbc_dart", 0}, "plugin");
  run.add({"gcbc_dart", 5, "heart", 10});  // a claim's difference that is tested, and others that are not
  run.add({"lga", 15, "heart", 10});
  for (const auto& [method, id, seconds] :  // invented people: seconds that are tested
       {std::tuple("human", "p01", 150.), {"human", "p02", 170.}, {"lga_hill", "p01", 50.}, {"lga_hill", "p02", 60.}}) {
    FabricatedRun::Spec person{method, 18};
    person.provenance = "human";
    person.participant = id;
    person.human_seconds = seconds;
    run.add(person);
  }
  run.run["answers"] = {
      {{"name", std::string(64, 'd') + ".json"}, {"file", "people/p01.json"}, {"participant", "p01"}}};
  run.save();
  report::write_report(run.path);
  std::vector<std::pair<std::string, Json>> all;
  for (const fs::path& file : files_with_schema(run.path))
    for (const Json& document : documents(file)) all.emplace_back(file.stem().string(), document);
  return all;
}

TEST(Schemas, AcceptTheFilesOfARun) {
  for (const auto& [schema, document] : run_documents())
    EXPECT_EQ(complaints(schema, document), Complaints()) << schema;
}

TEST(Schemas, DemandEveryMemberOfARow) {
  for (const auto& [schema, document] : run_documents())
    if (schema == "summary")
      for (const auto& item : document.at("rows").at(0).items()) {
        Json broken = document;
        broken["rows"][0].erase(item.key());
        EXPECT_NE(complaints(schema, broken), Complaints()) << "without " << item.key();
      }
}

TEST(Schemas, DescribeTheShiftOfAnArm) {
  int shifts = 0;
  for (const auto& [schema, document] : run_documents())
    if (schema == "summary")
      for (const Json& row : document.at("rows")) shifts += row.at("shift").is_object() ? 1 : 0;
  EXPECT_EQ(shifts, 4);  // of two arms the scenario's and the mean's: AcceptTheFilesOfARun has seen one
}

TEST(Schemas, AcceptEveryShippedScenarioAndSuite) {
  for (const auto& [folder, schema] : {std::pair{"scenarios", "scenario"}, std::pair{"suites", "suite"}}) {
    int files = 0;
    for (const auto& entry : fs::directory_iterator(data_directory() / folder)) {
      if (entry.is_directory()) continue;  // suites' claims
      ++files;
      Json document = read_json(entry.path());
      EXPECT_EQ(complaints(schema, document), Complaints()) << entry.path();
      document["surprise"] = 1;
      EXPECT_NE(complaints(schema, document), Complaints());
    }
    EXPECT_GT(files, 3);
  }
}

TEST(Schemas, DescribeASuitesOwnClaims) {
  const Json one{{"id", "K"},
                 {"statement", "LGA loses less."},
                 {"refuted_if", "it loses more"},
                 {"test", "slope"},
                 {"above", "lga"},
                 {"below", "gcbc_seg"},
                 {"option", "missing"},
                 {"levels", {0, .1}}};
  const Json good{{"claims", {one}}};
  EXPECT_EQ(complaints("suite_claims", good), Complaints());
  for (const char* patch : {R"({"test": "ordering"})", R"({"margin": 0.1})", R"({"levels": null})",
                            R"({"surprise": 1})", R"({"refuted_if": null})"}) {
    Json broken = good;
    broken["claims"][0].merge_patch(Json::parse(patch));
    EXPECT_NE(complaints("suite_claims", broken), Complaints()) << patch;
  }
}

TEST(Schemas, DescribeACue) {
  Json scenario = read_json(data_directory() / "scenarios" / "heart.json");
  scenario["train"] = {{"cue", {{"object_type", "block"}, {"texture", "blue"}, {"count", 2}}},
                       {"as_method_asks", false}};
  scenario["tests"] = {{{"arm", "moved"}, {"cue", "moved"}}};
  EXPECT_EQ(complaints("scenario", scenario), Complaints());
  for (const char* patch : {R"({"train": {"cue": {"count": 4}}})", R"({"train": {"cue": {"texture": null}}})",
                            R"({"train": {"cue": "moved"}})", R"({"tests": [{"arm": "moved", "cue": true}]})"}) {
    Json broken = scenario;
    broken.merge_patch(Json::parse(patch));
    EXPECT_NE(complaints("scenario", broken), Complaints()) << patch;
  }
}

TEST(Schemas, AcceptTheShippedLexicon) {
  const Json document = read_json(data_directory() / "lexicons" / "household.json");
  EXPECT_EQ(complaints("lexicon", document), Complaints());
  for (const char* where : {"/surprise", "/names/0/surprise", "/looks/0/surprise", "/orders/0/surprise"}) {
    Json broken = document;
    broken[Json::json_pointer(where)] = 1;
    EXPECT_NE(complaints("lexicon", broken), Complaints()) << where;
  }
}

TEST(Schemas, AcceptThePapersMethods) {
  const Json document = read_json(data_directory() / "paper" / "methods.json");
  EXPECT_EQ(complaints("paper_methods", document), Complaints());
  for (const auto& [where, value] : std::vector<std::pair<const char*, Json>>{{"/methods/0/mark", "star"},
                                                                              {"/methods/0/colour", "blue"},
                                                                              {"/remarks/0/rows", Json::array()},
                                                                              {"/remarks/0/rows/0", Json::object()},
                                                                              {"/surprise", 1}}) {
    Json broken = document;
    broken[Json::json_pointer(where)] = value;
    EXPECT_NE(complaints("paper_methods", broken), Complaints()) << where;
  }
}

TEST(Schemas, AcceptThePapersClaims) {
  Json document = read_json(data_directory() / "paper" / "claims.json");
  EXPECT_EQ(complaints("paper_claims", document), Complaints());
  document["claims"][0]["arms"] = "some";
  EXPECT_NE(complaints("paper_claims", document), Complaints());
}

// What each kind of file may not be: a JSON pointer and the value put there.
TEST(Schemas, RefuseBrokenFiles) {
  const std::vector<std::tuple<std::string, std::string, Json>> faults{
      {"run", "/cells/0", "not a key"},
      {"run", "/smoke", "yes"},
      {"run", "/answers/0/name", "p01.json"},
      {"cell", "/method/kind", "baseline"},
      {"cell", "/answers", "cassette:tape.jsonl"},
      {"cell", "/participant", {{"id", "p01"}}},
      {"cell", "/episodes", 0},
      {"cell", "/extra", 1},
      {"cell", "/scenario/commands", Json::array()},
      {"cell", "/scenario/commands/0/seen", "yes"},
      {"selection", "/commands", Json::array()},
      {"selection", "/commands/0/utterance", 1},
      {"selection", "/commands/0/selection/provenance", "guessed"},
      {"selection", "/commands/0/quality/target/textures/recall", 1.5},
      {"training", "/loss", "low"},
      {"training", "/epoch", 0.5},
      {"episodes", "/failure", "Bad luck"},
      {"episodes", "/success", true},  // and a failure
      {"episodes", "/action", {1, "2", 3}},
      {"episodes", "/action", Json::array()},
      {"episodes", "/command", -1},
      {"episodes", "/attribution", "luck"},
      {"episodes", "/input_seen", "yes"},
      {"timing", "/learn_s", -1.0},
      {"timing", "/load_s", "long"},
      {"status", "/state", "done"},
      {"status", "/fault", "nobody"},
      {"status", "/files", {{"cell.json", "abc"}}},
      {"summary", "/rows/0/success", 1.5},
      {"summary", "/rows/0/inputs_seen", 1.5},
      {"summary", "/rows/0/marks", {"good"}},
      {"summary", "/rows/0/shift", {{"difference", 0.5}}},
      {"summary", "/rows/0/phi", {{"quality", nullptr}}},
      {"summary", "/rows/0/failures", {{"bad_luck", 0}}},
      {"summary", "/rows/0/attribution", {{"policy", 1}}},
      {"cell", "/train_on", {{"sensor_noise", 0}}},
      {"summary", "/failed_cells/0/fault", nullptr},
      {"summary", "/perturbations/0/levels/0/p_holm", 2},
      {"summary", "/perturbations/0/levels/0/lost", nullptr},
      {"summary", "/perturbations/0/area", {{"relative", 1}}},
      {"perturbed", "/axis", 1},
      {"claims", "/claims/0/verdict", "maybe"},
      {"claims", "/claims/0/claim", ""},
      {"claims", "/claims/0/scenarios_like_these/verdict", "maybe"},
      {"claims", "/claims/0/differences/0/these_scenarios/p", 2},
      {"claims", "/claims/0/differences/0/scenarios_like_these", nullptr},
      {"claims", "/claims/0/differences/0/by_scenario", {{{"scenario", "heart"}, {"difference", 2}}}},
      {"claims", "/claims/0/differences/0/difference", 2},
      {"claims", "/claims/0/differences/0/unit", "hours"},
      {"claims", "/claims/4/differences/0/participants", -1},
      {"claims", "/claims/0/differences/0/policies", nullptr}};
  const auto all = run_documents();
  for (const auto& [schema, where, value] : faults) {
    int tried = 0;
    for (const auto& [name, document] : all) {
      if (name != schema) continue;
      if (where == "/success" && document.at("failure") == "none") continue;
      Json broken = document;
      broken[Json::json_pointer(where)] = value;
      EXPECT_NE(complaints(schema, broken), Complaints()) << schema << " " << where;
      ++tried;
    }
    EXPECT_GT(tried, 0) << schema;
  }
}

}  // namespace
}  // namespace lgabench

#include <gtest/gtest.h>

#include <functional>
#include <sstream>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include <lgabench/report/report.hpp>

#include "report_run.hpp"

namespace lgabench {
namespace {

using Adapter = valijson::adapters::NlohmannJsonAdapter;

// "" if `document` is what the schema asks for, else the complaints.
std::string complaints(const std::string& schema_name, const Json& document) {
  const Json text = read_json(data_directory() / "formats" / (schema_name + ".schema.json"));
  valijson::Schema schema;
  valijson::SchemaParser().populateSchema(Adapter(text), schema);
  valijson::Validator validator(valijson::Validator::kStrongTypes);
  valijson::ValidationResults results;
  if (validator.validate(schema, Adapter(document), &results)) return "";
  std::string all = schema_name + ": ";
  for (valijson::ValidationResults::Error error; results.popError(error);) {
    for (const std::string& part : error.context) all += part;
    all += ": " + error.description + "; ";
  }
  return all;
}

Json lines(const fs::path& file) {
  Json all = Json::array();
  std::istringstream text(read_file(file));
  for (std::string line; std::getline(text, line);) all.push_back(Json::parse(line));
  return all;
}

// Every file of a run with a finished and a failed cell, as schema name and document.
std::vector<std::pair<std::string, Json>> documents() {
  FabricatedRun run;
  const fs::path cell = run.add({"lga", 15});
  const fs::path failed = run.add_failed({"gcbc_dart", 0}, "plugin");
  run.save();
  report::write_report(run.path);
  std::vector<std::pair<std::string, Json>> all{
      {"run", read_json(run.path / "run.json")},         {"cell", read_json(cell / "cell.json")},
      {"selection", read_json(cell / "selection.json")}, {"timing", read_json(cell / "timing.json")},
      {"status", read_json(cell / "status.json")},       {"status", read_json(failed / "status.json")},
      {"summary", read_json(run.path / "summary.json")}};
  for (const Json& line : lines(cell / "training.jsonl")) all.emplace_back("training", line);
  for (const Json& line : lines(cell / "episodes.jsonl")) all.emplace_back("episodes", line);
  return all;
}

TEST(Schemas, AcceptTheFilesOfARun) {
  for (const auto& [schema, document] : documents()) EXPECT_EQ(complaints(schema, document), "");
}

TEST(Schemas, DemandEveryMemberOfARow) {
  for (const auto& [schema, document] : documents())
    if (schema == "summary")
      for (const auto& item : document.at("rows").at(0).items()) {
        Json broken = document;
        broken["rows"][0].erase(item.key());
        EXPECT_NE(complaints(schema, broken), "") << "without " << item.key();
      }
}

// What each kind of file may not be: a JSON pointer and the value put there.
TEST(Schemas, RefuseBrokenFiles) {
  const std::vector<std::tuple<std::string, std::string, Json>> faults{
      {"run", "/cells/0", "not a key"},
      {"run", "/smoke", "yes"},
      {"cell", "/method/kind", "baseline"},
      {"cell", "/episodes", 0},
      {"cell", "/extra", 1},
      {"selection", "/selection/provenance", "guessed"},
      {"selection", "/quality/target/textures/recall", 1.5},
      {"training", "/loss", "low"},
      {"training", "/epoch", 0.5},
      {"episodes", "/failure", "bad_luck"},
      {"episodes", "/success", true},  // and a failure
      {"episodes", "/action", {1, 2, 3}},
      {"timing", "/learn_s", -1.0},
      {"status", "/state", "done"},
      {"status", "/fault", "nobody"},
      {"status", "/files", {{"cell.json", "abc"}}},
      {"summary", "/rows/0/success", 1.5},
      {"summary", "/rows/0/marks", {"good"}},
      {"summary", "/rows/0/failures", {{"bad_luck", 1}}},
      {"summary", "/failed_cells/0/fault", nullptr}};
  const auto all = documents();
  for (const auto& [schema, where, value] : faults) {
    int tried = 0;
    for (const auto& [name, document] : all) {
      if (name != schema) continue;
      if (where == "/success" && document.at("failure") == "none") continue;
      Json broken = document;
      broken[Json::json_pointer(where)] = value;
      EXPECT_NE(complaints(schema, broken), "") << schema << " " << where;
      ++tried;
    }
    EXPECT_GT(tried, 0) << schema;
  }
}

}  // namespace
}  // namespace lgabench

// Files of a run against the JSON Schemas of docs/formats: episodes.jsonl has episodes.schema.json.
#pragma once
#include <algorithm>
#include <sstream>
#include <string>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>
#include <vector>

#include <lgabench/core/files.hpp>
#include <lgabench/core/json.hpp>

namespace lgabench {

/// In what `document` is not as the schema asks; empty if it is.
inline std::vector<std::string> complaints(const std::string& schema_name, const Json& document) {
  using Adapter = valijson::adapters::NlohmannJsonAdapter;
  const Json text = read_json(data_directory() / "formats" / (schema_name + ".schema.json"));
  valijson::Schema schema;
  valijson::SchemaParser().populateSchema(Adapter(text), schema);
  valijson::Validator validator(valijson::Validator::kStrongTypes);
  valijson::ValidationResults results;
  std::vector<std::string> all;
  if (validator.validate(schema, Adapter(document), &results)) return all;
  for (valijson::ValidationResults::Error error; results.popError(error);) {
    std::string place;
    for (const std::string& part : error.context) place += part;
    all.push_back(place + ": " + error.description);
  }
  if (all.empty()) all.push_back("not valid");  // refused is refused, with a reason or without
  return all;
}

/// Every file that a run must have and that has a schema.
inline std::vector<fs::path> files_with_schema(const fs::path& run) {
  std::vector<fs::path> files{run / "run.json", run / "summary.json", run / "claims.json"};
  for (const auto& entry : fs::directory_iterator(run / "cells")) {
    const fs::path& cell = entry.path();
    if (cell.filename().string()[0] == '.') continue;  // a worker's, not yet kept
    std::vector<std::string> names{"cell.json", "status.json"};
    // Broken JSON is no failed cell; it is complained of when the file is checked.
    const Json status = Json::parse(read_file(cell / "status.json"), nullptr, false);
    if (!status.contains("state") || status["state"] != "failed")
      names.insert(names.end(), {"selection.json", "training.jsonl", "episodes.jsonl", "timing.json"});
    for (const char* name : {"shown.json", "perturbed.jsonl"})
      if (fs::exists(cell / name)) names.emplace_back(name);
    for (const std::string& name : names) files.push_back(cell / name);
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// The documents of a file: the one of a .json, each line of a .jsonl.
inline std::vector<Json> documents(const fs::path& file) {
  if (file.extension() == ".json") return {read_json(file)};
  std::vector<Json> all;
  std::istringstream lines(read_file(file));
  for (std::string line; std::getline(lines, line);) all.push_back(Json::parse(line));
  return all;
}

}  // namespace lgabench

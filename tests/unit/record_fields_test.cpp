// Schemas of docs/formats against the records that are declared by fields(). LGABENCH_WRITE_GOLDEN=1 writes into a
// schema what its record declares, and keeps what it says beyond: descriptions, patterns, and all of a member that is
// any JSON.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <set>

#include <lgabench/core/version.hpp>
#include <lgabench/record/cell_status.hpp>
#include <lgabench/record/episode.hpp>
#include <lgabench/record/fields.hpp>
#include <lgabench/record/perturbed.hpp>
#include <lgabench/record/run_record.hpp>
#include <lgabench/record/shown.hpp>

#include "../schemas.hpp"

namespace lgabench {

void fields(CellStatus& status, Fields& field);
void fields(Episode& episode, Fields& field);
void fields(PerturbedEpisode& episode, Fields& field);
void fields(RunRecord& record, Fields& field);
void fields(ShownScene& scene, Fields& field);

namespace {

using Ordered = nlohmann::ordered_json;

// Whether a schema may keep what it says under `key`: it takes no value that the record does not.
bool narrows(const std::string& key, const Ordered& said, const Ordered& declared) {
  if (key == "type" && (said.contains("enum") || said.contains("const"))) return true;
  if (key == "enum" && said.contains("const")) return true;
  if (!said.contains(key)) return false;
  const Ordered& own = said.at(key);
  if (key == "minimum") return own >= declared;
  if (key == "maximum") return own <= declared;
  if (key != "type" && key != "enum") return own == declared;
  const Ordered all = declared.is_array() ? declared : Ordered::array({declared});
  const Ordered some = own.is_array() ? own : Ordered::array({own});
  return std::all_of(some.begin(), some.end(),
                     [&](const Ordered& one) { return std::find(all.begin(), all.end(), one) != all.end(); });
}

// A schema that says what it said and what is declared; without members that no longer are.
Ordered completed(Ordered said, const Ordered& declared) {
  if (said.is_null()) said = Ordered::object();
  for (const auto& [key, value] : declared.items()) {
    if (key == "properties") {
      Ordered members = Ordered::object();
      for (const auto& [name, member] : said[key].items())
        if (value.contains(name)) members[name] = completed(member, value.at(name));
      for (const auto& [name, member] : value.items())
        if (!members.contains(name)) members[name] = completed({}, member);
      said[key] = members;
    } else if (key == "required") {
      for (const Ordered& name : value)
        if (std::find(said[key].begin(), said[key].end(), name) == said[key].end()) said[key].push_back(name);
    } else if (value.is_object()) {
      said[key] = completed(said[key], value);
    } else if (!value.is_null() && !narrows(key, said, value)) {
      said[key] = value;
    }
  }
  return said;
}

// `place`: of what is declared, in the schema.
void expect_schema(const std::string& name, const Ordered& declared, const std::string& place = "") {
  const fs::path file = fs::path(LGABENCH_FORMATS) / (name + ".schema.json");
  const Ordered said = Ordered::parse(read_file(file));
  Ordered wanted = said;
  Ordered& part = wanted[Ordered::json_pointer(place)];
  part = completed(part, declared);
  if (std::getenv("LGABENCH_WRITE_GOLDEN") && Json(said) != Json(wanted)) write_file(file, wanted.dump(2) + "\n");
  EXPECT_EQ(Json(said).dump(1), Json(wanted).dump(1)) << name << ": LGABENCH_WRITE_GOLDEN=1 writes it";
}

TEST(Fields, SchemasSayWhatRecordsDeclare) {
  expect_schema("cell", schema_of<Cell>().first);
  expect_schema("episodes", schema_of<Episode>(false).first);
  expect_schema("perturbed", schema_of<PerturbedEpisode>(false).first);
  expect_schema("run", schema_of<RunRecord>(false).first);
  expect_schema("shown", schema_of<ShownScene>(false).first, "/properties/scenes/items");
  CellStatus failed;
  failed.failed = true;
  expect_schema("status", schema_of<CellStatus>(false).first, "/oneOf/0");
  expect_schema("status", schema_of<CellStatus>(false, failed).first, "/oneOf/1");
}

// A document with every member, and its reader.
struct Record {
  const char* schema;
  Json document;
  std::function<void(const Json&)> read;
};

std::vector<Record> records() {
  const std::string hash(64, '0'), short_hash(16, '0');
  Cell cell;
  cell.scenario = std::make_shared<const Json>(
      Json{{"id", "heart"},
           {"environment", "tabletop"},
           {"task", "pick"},
           {"commands", {{{"utterance", "take it"}, {"truth", {{"target", Json::object()}}}}}},
           {"tests", {{{"arm", "test"}}}}});
  cell.method.asks = "edit";
  cell.method.acts = ActingMethod{"lga", "1", Json::object()};
  cell.episodes = 1;
  cell.participant = CellParticipant{"p1", hash, true};
  cell.selection_errors = {.25, .5};
  cell.train_on = TrainOn{"blur", 2};
  cell.reading = {"read", Reading::difference};
  cell.data = {{"answers", hash}};
  Episode won{"test", 0, 0, short_hash}, lost{"test", 1, 0, short_hash, "dropped", {.5}, "policy", true, "own", 0};
  won.action = {.5};
  PerturbedEpisode perturbed{"blur_2", 0, "blur", 2, {}, short_hash, 1.5, short_hash};
  perturbed.hashes.fill(short_hash);
  RunRecord run;
  run.suite = "q1";
  run.cells = {short_hash, std::string(16, '1')};
  run.version = LGABENCH_VERSION;
  run.plugins = {{"method", "lga", "1", hash, "edit"}};
  run.machine = {{"processor", "one"}, {"instructions", "AVX2"}, {"cores", 1}, {"memory_gib", 1}, {"system", "Debian"}};
  run.shard = RunRecord::Shard{1, 2, 1};
  const auto read_line = [](auto read) { return [read](const Json& json) { read(JsonReader(json, "file")); }; };
  return {{"cell", to_json(cell), [](const Json& json) { read_cell(json, "file"); }},
          {"episodes", to_json(won), read_line(read_episode)},
          {"episodes", to_json(lost), read_line(read_episode)},
          {"perturbed", to_json(perturbed), read_line(read_perturbed_episode)},
          {"run", to_json(run), [](const Json& json) { read_run_record(json, "file"); }}};
}

// What a member may be may depend on another one, which no schema says.
const std::set<std::string> of_others{"perturbed/axis", "run/cells", "run/shard/cells", "run/shard/index"};

TEST(Fields, WhatAReaderRefusesItsSchemaRefuses) {
  const std::vector<Json> others{nullptr, true, -1, .5, 7, "", "other", Json::array(), Json::object()};
  for (const auto& [schema, document, read] : records()) {
    ASSERT_EQ(complaints(schema, document), std::vector<std::string>()) << document.dump(1);
    ASSERT_NO_THROW(read(document));
    std::set<std::string> places;
    const Json leaves = document.flatten();
    for (const auto& [place, leaf] : leaves.items())
      for (Json::json_pointer at(place); !at.empty(); at = at.parent_pointer()) places.insert(at.to_string());
    int refused = 0;
    const auto expect_refusal = [&, &name = schema, &reads = read](const Json& changed, const std::string& what) {
      try {
        reads(changed);
      } catch (const InputError& e) {
        ++refused;
        EXPECT_FALSE(complaints(name, changed).empty()) << name << ": " << what << ": " << e.what();
      }
    };
    for (const std::string& place : places) {
      const Json::json_pointer at(place);
      for (const Json& other : others) {
        Json changed = document;
        changed[at] = other;
        if (of_others.count(schema + place) == 0) expect_refusal(changed, place + " is " + other.dump());
      }
      if (!document[at.parent_pointer()].is_object()) continue;
      Json without = document, more = document;
      without[at.parent_pointer()].erase(at.back());
      expect_refusal(without, "without " + place);
      more[at.parent_pointer()]["unknown"] = 1;
      expect_refusal(more, "more beside " + place);
    }
    EXPECT_GT(refused, 20) << schema;
  }
}

}  // namespace
}  // namespace lgabench

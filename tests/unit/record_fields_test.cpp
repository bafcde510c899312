// A run's records against their schemas in docs/formats.
#include <gtest/gtest.h>

#include <functional>
#include <set>

#include <lgabench/abstraction/cassette.hpp>
#include <lgabench/abstraction/quality.hpp>
#include <lgabench/core/version.hpp>
#include <lgabench/host/messages.hpp>
#include <lgabench/job/check_report.hpp>
#include <lgabench/record/cell_status.hpp>
#include <lgabench/record/episode.hpp>
#include <lgabench/record/fields.hpp>
#include <lgabench/record/perturbed.hpp>
#include <lgabench/record/run_record.hpp>
#include <lgabench/record/shown.hpp>

#include "../described.hpp"
#include "../schemas.hpp"

namespace lgabench {

void fields(CassetteLine& line, Fields& field);
void fields(CellStatus& status, Fields& field);
void fields(CheckReport& report, Fields& field);
void fields(Command& command, Fields& field);
void fields(Episode& episode, Fields& field);
void fields(FeatureSpace& space, Fields& field);
void fields(NameQuality& names, Fields& field);
void fields(Needs& needs, Fields& field);
void fields(PerturbedEpisode& episode, Fields& field);
void fields(Placed& placed, Fields& field);
void fields(ProcessState& state, Fields& field);
void fields(RunRecord& record, Fields& field);
void fields(SelectionCost& cost, Fields& field);
void fields(SetQuality& set, Fields& field);
void fields(ShownScene& scene, Fields& field);

namespace {

TEST(Fields, WriteTheSchemasOfARun) {
  CellStatus failed;
  failed.failed = true;
  expect_schema("cassette", schema_of<CassetteLine>());
  expect_schema("cell", schema_of<Cell>());
  expect_schema("check_plugin", schema_of<CheckReport>());
  expect_schema("episodes", schema_of<Episode>());
  expect_schema("perturbed", schema_of<PerturbedEpisode>());
  expect_schema("run", schema_of<RunRecord>());
  expect_schema("selection", schema_of<NameQuality>(), "/definitions/quality");
  expect_schema("selection", schema_of<SetQuality>(), "/definitions/groups");
  expect_schema("shown", schema_of<ShownScene>(), "/properties/scenes/items");
  expect_schema("status", schema_of<CellStatus>(), "/oneOf/0");
  expect_schema("status", schema_of(failed), "/oneOf/1");
}

TEST(Fields, WriteTheSchemasOfMessages) {
  expect_schema("host_message", schema_of<Command>(), "/definitions/command");
  expect_schema("host_message", schema_of<SelectionCost>(), "/definitions/cost");
  expect_schema("host_message", schema_of<Placed>(), "/definitions/placed");
  expect_schema("host_message", schema_of<FeatureSpace>(), "/definitions/space");
  expect_schema("host_message", schema_of<ProcessState>(), "/definitions/state");
  expect_schema("host_message", schema_of<Needs>(), "/definitions/wants");
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

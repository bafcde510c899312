// What a run and its workers say to each other is read as it was written.
#include <lgabench/job/check_report.hpp>
#include <lgabench/job/job.hpp>
#include <lgabench/record/shown.hpp>

#include "../engine_under_test.hpp"
#include "testing.hpp"

namespace lgabench {
namespace {

CellJob reference_job() {
  CellJob job;
  job.cell.suite = "q1";
  job.cell.scenario = std::make_shared<const Json>(load_scenario("heart").json);
  job.cell.method = {"reference", "oracle", "oracle", "1", Json::object()};
  job.cell.episodes = 3;
  job.cell.data = job.build = Json::object();
  job.engine = engine_under_test();
  job.directory = job.cache = job.answers = job.scratch = "/somewhere";
  job.limits = {60, 1 << 30};
  return job;
}

TEST(Jobs, OfCellsAreReadAsTheyWereWritten) {
  CellJob job = reference_job();
  job.confined = false;
  job.live = LiveModel{"/tape.jsonl", false, 7};
  job.debugger = {"gdb", "--args"};
  const Json json = to_json(job);
  const CellJob read = read_cell_job(JsonReader(json, "job"));
  EXPECT_EQ(to_json(read), json);
  EXPECT_EQ(read.live->max_queries, 7);
  EXPECT_EQ(read.limits.data_bytes, 1 << 30);
  EXPECT_FALSE(read.method);
}

TEST(Jobs, OfAMethodNeedItsPlugin) {
  CellJob job = reference_job();
  job.cell.method.kind = "method";
  const Json json = to_json(job);
  EXPECT_SAYS(message_of<InputError>([&] { read_cell_job(JsonReader(json, "job")); }),
              "\"method\" beside it exactly where a method runs");
}

TEST(Jobs, NameThePluginsThatTheyWereWrittenWith) {
  CellJob job = reference_job();
  job.engine->sha256 = std::string(64, '0');
  const Json json = to_json(job);
  EXPECT_SAYS(message_of<PluginError>([&] { read_cell_job(JsonReader(json, "job")); }), "changed since the run began");
}

TEST(ShownScenes, AreReadAsTheyWereWrittenAndRefusedWhereTheyAreNone) {
  const TemporaryDirectory cell;
  EXPECT_TRUE(read_shown_scenes(cell.path).empty()) << "a cell of 0.2 has none";
  const ShownScene scene{"test", 3, {{"goal mask, 36 × 72", "iVBORw0KGgo="}}, {"the command's words"}, {"picture"}};
  write_file(cell.path / "shown.json", to_text({scene}));
  const std::vector<ShownScene> read = read_shown_scenes(cell.path);
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(to_text(read), to_text({scene}));
  const auto refused = [&](const std::string& text) {
    write_file(cell.path / "shown.json", text);
    return message_of<InputError>([&] { read_shown_scenes(cell.path); });
  };
  ShownScene script = scene;
  script.pictures[0].second = "\"><script>";
  EXPECT_SAYS(refused(to_text({script})), "shown.json: /scenes/0/pictures/0/png: expected a PNG in base64");
  EXPECT_SAYS(refused("{}"), "shown.json: /: expected a member \"scenes\"");
}

TEST(Jobs, OfPicturesAreReadAsTheyWereWritten) {
  PictureRequest request{"cells/KEY/cell.json", "test", 4, "0123456789abcdef"};
  request.selections = {{{"distribution", {{"target", 1}}}, {"instances", "all"}}};
  request.ends = {{"mujoco", {{.1, .2}}}, {"bullet", {{.3}, {.4}, {}}}};
  const Json json = to_json(request);
  EXPECT_EQ(to_json(read_picture_request(JsonReader(json, "pictures"))), json);
}

TEST(Messages, OfWorkersAreReadAsTheyWereWritten) {
  const auto complaint = read_complaint(to_json(Complaint{"signal 11", true, 11, true}));
  ASSERT_TRUE(complaint);
  EXPECT_EQ(complaint->reason, "signal 11");
  EXPECT_TRUE(complaint->by_plugin && complaint->refused);
  EXPECT_EQ(complaint->signal, 11);
  const auto at = read_phase_count(to_json(PhaseCount{"learn", 40}));
  ASSERT_TRUE(at);
  EXPECT_EQ(at->phase, "learn");
  EXPECT_EQ(at->count, 40);
}

TEST(Messages, OfSomeoneElseAreNone) {
  for (const char* line : {"null", "3", "[]", "\"reason\"", "{\"signal\": 9}"}) {
    EXPECT_FALSE(read_complaint(Json::parse(line))) << line;
    EXPECT_FALSE(read_phase_count(Json::parse(line))) << line;
  }
  EXPECT_EQ(read_complaint(Json{{"reason", 3}, {"signal", "x"}})->signal, 0);
}

}  // namespace
}  // namespace lgabench

// `lgabench list` and `lgabench info` as programs.
#include <sys/wait.h>

#include <cstdio>

#include <lgabench/core/json.hpp>

#include "../plugin_fixtures.hpp"

namespace lgabench {
namespace {

struct Outcome {
  int status = -1;
  std::string out, err;
};

Outcome lgabench(const std::string& arguments) {
  const TemporaryDirectory directory;
  const std::string out = (directory.path / "out").string(), err = (directory.path / "err").string();
  const int status = std::system(("'" LGABENCH_PROGRAM "' " + arguments + " >'" + out + "' 2>'" + err + "'").c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out), read_file(err)};
}

std::string plugin_path(const std::string& kind) {
  return " --plugin-path '" + (fs::path(LGABENCH_TEST_PLUGINS) / kind).string() + "'";
}

Json ids(const Json& rows) {
  Json all = Json::array();
  for (const Json& row : rows) all.push_back(row.at("id"));
  return all;
}

bool holds(const Json& list, const std::string& id) { return std::find(list.begin(), list.end(), id) != list.end(); }

TEST(ListCommand, JsonHoldsEverythingAndRunsNothing) {
  const Outcome outcome =
      lgabench("list --json" + plugin_path("good") + plugin_path("faulty") + plugin_path("refused"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Json all = Json::parse(outcome.out);
  EXPECT_TRUE(holds(ids(all.at("methods")), "fixture_constant"));
  EXPECT_TRUE(holds(ids(all.at("methods")), "aborting_constructor"));
  EXPECT_TRUE(holds(ids(all.at("suites")), "q1"));
  EXPECT_TRUE(holds(ids(all.at("scenarios")), "red_heart"));
  bool wrong_sdk = false;
  for (const Json& row : all.at("refused"))
    if (fs::path(row.at("file").get<std::string>()).stem() == "wrong_sdk") {
      wrong_sdk = true;
      EXPECT_SAYS(row.at("reason").get<std::string>(), "SDK");
    }
  EXPECT_TRUE(wrong_sdk);
}

TEST(ListCommand, RefusalsGoToStandardError) {
  const Outcome outcome = lgabench("list" + plugin_path("refused"));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_SAYS(outcome.out, "aborting_constructor");
  EXPECT_SILENT(outcome.out, "wrong_sdk");
  EXPECT_SAYS(outcome.err, "wrong_sdk.so: built with SDK");
}

TEST(InfoCommand, MethodWithItsOptions) {
  const Outcome text = lgabench("info" + plugin_path("good") + " fixture_constant");
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_SAYS(text.out, "mode = \"plain\"");
  EXPECT_SAYS(text.out, "one of [\"plain\",\"other\"]");
  EXPECT_SAYS(text.out, "architecture=");
  const Json members = Json::parse(lgabench("info fixture_constant --json" + plugin_path("good")).out);
  EXPECT_EQ(members.at("kind"), "method");
  EXPECT_EQ(members.at("options").at("scale").at("default"), 1.0);
}

TEST(InfoCommand, WorksWithAConstructorThatAborts) {
  const Outcome outcome = lgabench("info aborting_constructor" + plugin_path("refused"));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_SAYS(outcome.out, "aborts when it is opened");
}

TEST(InfoCommand, ScenarioAndSuite) {
  EXPECT_SAYS(lgabench("info heart").out, "Bring me the heart.");
  EXPECT_EQ(Json::parse(lgabench("info heart --json").out).at("kind"), "scenario");
  EXPECT_SAYS(lgabench("info q1").out, "preset smoke");
  EXPECT_EQ(Json::parse(lgabench("info q1 --json").out).at("grid").at("engines"), Json({"mujoco"}));
}

TEST(InfoCommand, AnEnvironmentsTasksAndTheNumbersOfItsActions) {
  const std::string said = lgabench("info tabletop").out;
  EXPECT_SAYS(said, "task        sweep");
  EXPECT_SAYS(said, "second set  avoid, the object to be avoided");
  EXPECT_SAYS(said, "pose1.y   -0.5 to 0.5 m");
  const Json json = Json::parse(lgabench("info tabletop --json").out);
  EXPECT_EQ(json["action"]["numbers"].size(), 12u);
  EXPECT_EQ(json["action"]["numbers"][2], (Json{{"name", "pose0.qx"}, {"unit", ""}, {"low", -1}, {"high", 1}}));
  EXPECT_EQ(json["tasks"][0]["id"], "pick_and_place");
}

TEST(InfoCommand, RefusedAndUnknownNames) {
  const Outcome refused = lgabench("info wrong_sdk" + plugin_path("refused"));
  EXPECT_EQ(refused.status, 4);
  EXPECT_EQ(refused.out, "");
  EXPECT_SAYS(refused.err, "SDK \"0.0.9\"");
  const Outcome unknown = lgabench("info nothing_of_that_name");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_SAYS(unknown.err, "no method, engine, perturbation, suite, scenario or environment \"nothing_of_that_name\"");
}

}  // namespace
}  // namespace lgabench

// Participants' files. The people here are invented.
#include <gtest/gtest.h>

#include <lgabench/abstraction/participant.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/harness/answers.hpp>

#include "../schemas.hpp"
#include "testing.hpp"

namespace lgabench {
namespace {

Json red_hearts() { return {{"target", {{"object_types", {"heart"}}, {"textures", {"dark red", "red"}}}}}; }

Json invented() {
  Json lines = red_hearts();
  lines["avoid"] = {{"object_types", {"line"}}, {"textures", "ALL"}};
  return {{"participant", "made-up-01"},
          {"study", "no study: an invented person of a test"},
          {"consent", {{"given", true}, {"statement", "invented"}, {"ethics", "none needed"}}},
          {"license", "CC0-1.0"},
          {"answers",
           {{{"scenario", "red_heart"},
             {"command", "Bring me the red heart."},
             {"asked_as", "Please fetch a heart that is red."},
             {"specified", {{"selection", red_hearts()}, {"seconds", 93.5}}},
             {"edited",
              {{"proposal", {{"target", {{"object_types", {"heart"}}, {"textures", {"red"}}}}}},
               {"proposed_by", "gpt-4"},
               {"selection", red_hearts()},
               {"seconds", 21}}}},
            {{"scenario", "sweep_block_without_touching_line"},
             {"command", load_scenario("sweep_block_without_touching_line").commands[0].utterance},
             {"specified", {{"selection", lines}, {"seconds", 140}}}}}}};
}

class ParticipantFile : public testing::Test, public TemporaryDirectory {
 protected:
  fs::path file() const { return path / "p01.json"; }
  Participant read(const Json& json) const {
    write_file(file(), json.dump());
    return read_participant(file());
  }
  std::string complaint(const char* pointer, const Json& value) const {
    Json broken = invented();
    broken[Json::json_pointer(pointer)] = value;
    return message_of<InputError>([&] { read(broken); });
  }
};

TEST_F(ParticipantFile, IsReadAsTheSchemaHasIt) {
  EXPECT_EQ(complaints("participant", invented()), std::vector<std::string>());
  const Participant p = read(invented());
  EXPECT_EQ(p.id, "made-up-01");
  EXPECT_EQ(p.sha256, sha256_file(file()));
  const Scenario red_heart = load_scenario("red_heart"), heart = load_scenario("heart"),
                 sweep = load_scenario("sweep_block_without_touching_line");
  const auto specified = &Participant::Answer::specified, edited = &Participant::Answer::edited;
  EXPECT_TRUE(p.answered_all(red_heart, specified) && p.answered_all(red_heart, edited));
  EXPECT_TRUE(p.answered_all(sweep, specified));
  EXPECT_FALSE(p.answered_all(sweep, edited));
  EXPECT_FALSE(p.answered_all(heart, specified) || p.answered_all(heart, edited));
  const Participant::Answer* answer = p.find(red_heart, "Bring me the red heart.");
  ASSERT_NE(answer, nullptr);
  EXPECT_EQ(answer->specified->target, (FeatureSet{{"heart"}, {"red", "dark red"}})) << "in the space's order";
  EXPECT_EQ(answer->specified->cost.human_seconds, 93.5);
  EXPECT_EQ(answer->specified->provenance, Provenance::human);
  EXPECT_EQ(answer->specified->source, "participant made-up-01");
  EXPECT_EQ(answer->specified->asked_as, "Please fetch a heart that is red.");
  EXPECT_EQ(answer->edited->source, "gpt-4, edited by participant made-up-01");
}

TEST_F(ParticipantFile, IsRefusedWithThePlace) {
  for (const auto& [pointer, value, expected] : std::vector<std::tuple<const char*, Json, const char*>>{
           {"/consent/given", false, "/consent/given: expected true: answers are used only with consent"},
           {"/consent/ethics", nullptr, "/consent/ethics"},
           {"/license", 3, "/license"},
           {"/participant", "", "/participant: expected a pseudonym"},
           {"/name", "a real name", "unknown member \"name\""},
           {"/answers/0/scenario", "hart", "/answers/0/scenario: no scenario \"hart\""},
           {"/answers/0/command", "Bring me the red hart.", "expected one of \"Bring me the red heart.\""},
           {"/answers/0/specified/seconds", 0, "/answers/0/specified/seconds: expected more than 0"},
           {"/answers/0/specified/selection/target/textures/0", "redd",
            "/answers/0/specified/selection/target/textures"},
           {"/answers/0/specified/selection/avoid",
            {{"object_types", "ALL"}, {"textures", "ALL"}},
            "/answers/0/specified/selection: unknown member \"avoid\""},
           {"/answers/1/specified/selection", red_hearts(), "expected \"avoid\" too, for sweep"},
           {"/answers/0/edited/proposed_by", nullptr, "/answers/0/edited/proposed_by"}}) {
    EXPECT_SAYS(complaint(pointer, value), expected) << pointer;
    EXPECT_SAYS(complaint(pointer, value), "p01.json");
  }
  Json twice = invented();
  twice["answers"].push_back(twice["answers"][0]);
  EXPECT_SAYS(message_of<InputError>([&] { read(twice); }), "/answers/2: expected each command once");
  Json nothing = invented();
  nothing["answers"][1].erase("specified");
  EXPECT_SAYS(message_of<InputError>([&] { read(nothing); }), "/answers/1: expected specified, edited or both");
}

TEST_F(ParticipantFile, StandsInForThePerson) {
  const Scenario scenario = load_scenario("red_heart");
  const Command command = scenario.command(0);
  ParticipantAsHuman human(read(invented()), scenario);
  EXPECT_EQ(human.specify(command).cost.human_seconds, 93.5);

  Selection proposal;
  proposal.target = {{"heart"}, {"red"}};
  proposal.cost.lm_queries = 112;
  const Selection edited = human.edit(command, proposal);
  EXPECT_EQ(edited.target, (FeatureSet{{"heart"}, {"red", "dark red"}}));
  EXPECT_EQ(edited.cost.lm_queries, 112) << "the proposal's cost, too";
  EXPECT_EQ(edited.cost.human_seconds, 21);
  proposal.target.product().textures = {"red", "dark red"};
  EXPECT_SAYS(message_of<InputError>([&] { human.edit(command, proposal); }),
              "participant made-up-01, \"Bring me the red heart.\": the edit began with another proposal");

  ParticipantAsHuman elsewhere(read(invented()), load_scenario("heart"));
  EXPECT_SAYS(message_of<InputError>([&] {
                elsewhere.specify({"Bring me the heart.", "pick_and_place"});
              }),
              "no answer to this command");
}

TEST_F(ParticipantFile, EveryParticipantHasOne) {
  std::vector<Participant> all;
  EXPECT_SAYS(message_of<InputError>([&] { read_participants(path, false, all); }), "there are none");
  EXPECT_SAYS(message_of<InputError>([&] { read_participants(path / "none", false, all); }), "No such file");
  read(invented());
  write_file(path / "p02.json", invented().dump());
  EXPECT_SAYS(message_of<InputError>([&] { read_participants(path, false, all); }),
              "\"made-up-01\" has a second file there");
}

// Files of recorded answers, shipped or written by hand: reader and schema agree.
TEST(RecordedFiles, AreAsTheirSchemaSays) {
  for (const std::string& source : recorded_sources()) {
    const fs::path file = data_directory() / "answers" / (source + ".json");
    EXPECT_EQ(complaints("recorded_answers", read_json(file)), std::vector<std::string>()) << source;
    EXPECT_FALSE(read_recorded(file).answers.empty());
  }
  const Json good = Json::parse(R"({"model": "me", "space": "tabletop", "answers": [
    {"scenario": "heart", "command": "Bring me the heart.", "target": {"object_types": ["heart"], "textures": "ALL"},
     "avoid": {"object_types": [], "textures": ["red"]}, "note": "by hand"}]})");
  const TemporaryDirectory directory;
  const auto refused = [&](const Json& document) {
    write_file(directory.path / "mine.json", canonical(document));
    const bool by_schema = !complaints("recorded_answers", document).empty();
    try {
      read_recorded(directory.path / "mine.json");
      EXPECT_FALSE(by_schema) << document;
      return false;
    } catch (const InputError&) {
      EXPECT_TRUE(by_schema) << document;
      return true;
    }
  };
  EXPECT_FALSE(refused(good));
  for (const char* patch : {R"({"model": null})", R"({"model": ""})", R"({"answers": []})", R"({"modle": "me"})"}) {
    Json bad = good;
    bad.merge_patch(Json::parse(patch));
    EXPECT_TRUE(refused(bad)) << patch;
  }
  for (const char* patch : {R"({"command": null})", R"({"target": null})", R"({"target": {"textures": null}})",
                            R"({"scenario": 3})", R"({"avoid": {"more": 1}})", R"({"target": {"textures": "red"}})"}) {
    Json bad = good;
    bad["answers"][0].merge_patch(Json::parse(patch));
    EXPECT_TRUE(refused(bad)) << patch;
  }
}

}  // namespace
}  // namespace lgabench

// A study's directory: assignment, kills between two files, withdrawal, participants' files.
#include <lgabench/study/study.hpp>

#include <fmt/format.h>

#include <cctype>

#include <lgabench/abstraction/participant.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/study/report.hpp>
#include <lgabench/study/withdrawal.hpp>

#include "../../schemas.hpp"
#include "study_people.hpp"

namespace lgabench::study {
namespace {

std::string all(const std::vector<std::string>& lines) { return fmt::format("{}", fmt::join(lines, "\n")); }

class StudyDirectory : public testing::Test, public TemporaryDirectory {
 protected:
  fs::path data = path / "data";
  std::unique_ptr<Study> study;
  int keys = 0;

  void open(const std::string& name = "paper", Kind kind = Kind::people) {
    study.reset();
    const fs::path file = ready_protocol(path, name);
    study = std::make_unique<Study>(data, read_protocol(file), file, kind);
  }
  std::string agree() { return study->begin("key" + std::to_string(++keys), sha256("I agree.\n"), false); }
  Json post(const std::string& id, Page& page, const std::string& kind, const Json& more = Json::object()) {
    return study->post(id, page.event(kind, more)).value();
  }
  // A whole session in which every answer is a red heart.
  void take_part(const std::string& id) {
    Page page;
    post(id, page, "opened"), post(id, page, "familiarised");
    Json state = post(id, page, "example_seen");
    while (state.at("step") != "debriefing") {
      if (state.at("step") == "questionnaire") {
        state = post(id, page, "questionnaire", {{"tlx", tlx(50)}, {"free_text", ""}});
        continue;
      }
      post(id, page, "start"), post(id, page, "shown");
      page.ms += 2500;
      state = post(id, page, "submit", submitted({"heart"}, {"red"}));
    }
  }
  std::vector<int> withdrawn_and_given() const {
    int given = 0, withdrawn = 0;
    const EventLog log(data / "study.events");
    for (const Json& event : log.events()) {
      given += event.at("kind") == "assigned";
      withdrawn += event.at("kind") == "withdrawn";
    }
    return {withdrawn, given};
  }
  bool holds(const std::string& text) const {
    for (const auto& entry : fs::recursive_directory_iterator(data)) {
      if (entry.path().string().find(text) != std::string::npos) return true;
      if (entry.is_regular_file() && read_file(entry.path()).find(text) != std::string::npos) return true;
    }
    return false;
  }
};

TEST_F(StudyDirectory, ConsentGivesASlotOnce) {
  open();
  const std::string id = agree();
  EXPECT_TRUE(is_id(id));
  --keys;
  EXPECT_EQ(agree(), id) << "the same click, sent again";
  EXPECT_NE(agree(), id);
  EXPECT_SAYS(message_of<Refused>([this] { study->begin("k", sha256("another text"), false); }), "another text");
  EXPECT_SAYS(message_of<Refused>([this] { study->begin("k", sha256("I agree.\n"), true); }), "rehearsals alone");
  open();
  EXPECT_EQ(withdrawn_and_given(), (std::vector<int>{0, 2}));
  EXPECT_EQ(study->post(std::string(32, '0'), {}), std::nullopt);
}

TEST_F(StudyDirectory, SaysWhoComesAndGoesByPseudonym) {
  open();
  std::vector<std::string> said;
  study->tell([&said](const std::string& line) { said.push_back(line); });
  const std::string first = agree(), second = agree();
  take_part(second);
  EXPECT_TRUE(study->withdraw(withdrawal_code(first)));
  ASSERT_EQ(said.size(), 4u);
  EXPECT_SAYS(said[0], "p01 began, with ");
  EXPECT_SAYS(said[1], " first; 2 under way, 0 of 18 finished");
  EXPECT_EQ(said[2], "p02 finished; 1 under way, 1 of 18 finished");
  EXPECT_EQ(said[3], "p01 withdrew; 0 under way, 1 of 18 finished");
}

TEST_F(StudyDirectory, AKillBetweenThePersonAndTheLogGivesNoSlotTwice) {
  open();
  const std::string log = read_file(data / "study.events");
  const std::string first = agree();
  study.reset();
  write_file(data / "study.events", log);  // killed before the slot was logged
  write_file(data / "people" / (std::string(32, 'b') + ".events"),
             "120 half an ev");  // and one before consent was stored
  open();
  EXPECT_EQ(withdrawn_and_given(), (std::vector<int>{0, 1}));
  agree();
  study.reset();
  const Record record = read_study(data);
  ASSERT_EQ(record.people.size(), 2u);
  EXPECT_EQ(record.people[0].log().file().stem(), first);
  EXPECT_EQ(record.people[1].slot(), 1);
}

TEST_F(StudyDirectory, HoldsOneStudyOfOneKindForOneServer) {
  open();
  const fs::path file = path / "protocol.json";
  EXPECT_SAYS(message_of<InputError>([&] { Study(data, read_protocol(file), file, Kind::people); }),
              "another lgabench serves");
  study.reset();
  EXPECT_SAYS(message_of<InputError>([&] { Study(data, read_protocol(file), file, Kind::rehearsal); }),
              "holds a study of people");
  ready_protocol(path, "paper", {{"seed", 8}});
  EXPECT_SAYS(message_of<InputError>([&] { Study(data, read_protocol(file), file, Kind::people); }),
              "holds another study");
}

TEST_F(StudyDirectory, AnswersBecomeAFileThatRunsRead) {
  open();
  take_part(agree());
  take_part(agree());
  const fs::path file = data / "participants/p01.json";
  EXPECT_EQ(complaints("participant", read_json(file)), std::vector<std::string>());
  const Participant participant = read_participant(file);
  EXPECT_EQ(participant.id, "p01");
  EXPECT_FALSE(participant.rehearsal);
  EXPECT_EQ(participant.answers.size(), 9u);
  const auto* answer = participant.find(load_scenario("red_heart"), "Bring me the red heart.");
  ASSERT_TRUE(answer && answer->specified && answer->edited);
  EXPECT_EQ(answer->specified->cost.human_seconds, 2.5);
  EXPECT_EQ(answer->specified->asked_as, "Bring me the red heart");
  EXPECT_EQ(answer->proposal.target.product().textures.size(), 5u);
  EXPECT_TRUE(fs::exists(data / "participants/p02.json"));
  const std::string bytes = read_file(file);
  fs::remove(file);  // killed before it was written
  open();
  EXPECT_EQ(read_file(file), bytes);
}

TEST_F(StudyDirectory, ARehearsalIsMarked) {
  open("crossover", Kind::rehearsal);
  take_part(study->begin("k", sha256("I agree.\n"), true));
  EXPECT_EQ(complaints("participant", read_json(data / "participants/p01.json")), std::vector<std::string>());
  EXPECT_TRUE(read_participant(data / "participants/p01.json").rehearsal);
}

TEST_F(StudyDirectory, WhoWithdrawsLeavesASlotAndNothingElse) {
  open();
  const std::string id = agree(), other = agree();
  take_part(id), take_part(other);
  EXPECT_TRUE(holds(id));
  EXPECT_FALSE(study->withdraw("AAAA-AAAA-AAAA-AAAA"));
  EXPECT_FALSE(study->withdraw(""));
  std::string typed = withdrawal_code(id);
  std::transform(typed.begin(), typed.end(), typed.begin(),
                 [](unsigned char c) { return c == '-' ? ' ' : std::tolower(c); });
  write_report(data);
  EXPECT_TRUE(holds("p01,"));
  EXPECT_TRUE(fs::exists(data / "figures") && fs::exists(data / "tables"));
  EXPECT_TRUE(study->withdraw(typed));
  EXPECT_FALSE(holds(id));
  EXPECT_FALSE(holds("p01,")) << "a report's lines";
  for (const char* made : {"trials.csv", "results.json", "report.md", "report.html", "figures", "tables"})
    EXPECT_FALSE(fs::exists(data / made)) << made << " has numbers that they are part of";
  EXPECT_FALSE(fs::exists(data / "participants/p01.json"));
  EXPECT_TRUE(fs::exists(data / "participants/p02.json"));
  Page page;
  EXPECT_EQ(study->post(id, page.event("opened")), std::nullopt);
  agree();
  study.reset();
  const Record record = read_study(data);
  EXPECT_EQ(record.withdrawn, 1);
  ASSERT_EQ(record.people.size(), 2u);
  EXPECT_EQ(record.people[1].slot(), 2) << "the slot is not given again";
}

TEST_F(StudyDirectory, WhoseFileIsDamagedIsLeftOutAlone) {
  open();
  std::vector<std::string> ids;
  for (int i = 0; i < 3; ++i) take_part(ids.emplace_back(agree()));
  study.reset();
  const fs::path damaged = data / "people" / (ids[0] + ".events"), linked = data / "people" / (ids[1] + ".events");
  std::string bytes = read_file(damaged);
  bytes[bytes.size() / 2] ^= 1;
  write_file(damaged, bytes);
  fs::rename(linked, path / "elsewhere");
  fs::create_symlink(path / "elsewhere", linked);
  open();
  ASSERT_EQ(study->damaged().size(), 2u);
  Page page{"page2"};
  EXPECT_FALSE(study->post(ids[0], page.event("opened")));
  EXPECT_FALSE(study->post(ids[1], page.event("opened")));
  EXPECT_TRUE(study->post(ids[2], page.event("opened")));
  EXPECT_EQ(study->slots(), 3) << "no place is given twice";
  study.reset();
  const Record record = read_study(data);
  EXPECT_EQ(record.people.size(), 1u);
  EXPECT_EQ(record.damaged.size(), 2u);
  EXPECT_SAYS(all(record.damaged), "the file was changed or damaged");
  write_report(data);
  EXPECT_SAYS(read_file(data / "report.md"), "2 people are left out: the file cannot be read");
}

TEST_F(StudyDirectory, AHugeTimeIsNotPrintedDigitByDigit) {
  open("paper", Kind::rehearsal);
  for (const char* key : {"a", "b"}) {
    const std::string id = study->begin(key, sha256("I agree.\n"), true);
    Page page;
    post(id, page, "opened"), post(id, page, "familiarised");
    Json state = post(id, page, "example_seen");

    while (state.at("step") == "trial") {
      post(id, page, "start"), post(id, page, "shown");
      page.ms += 1e300;  // of a simulated person, whose clock is no clock
      state = post(id, page, "submit", submitted({"heart"}, {"red"}));
    }
  }
  study.reset();
  write_report(data);
  std::size_t digits = 0, most = 0;
  for (const char c : read_file(data / "report.md")) most = std::max(most, digits = std::isdigit(c) ? digits + 1 : 0);
  EXPECT_LT(most, 20u);
}

TEST_F(StudyDirectory, AKillInTheMiddleOfAWithdrawalIsCarriedOutLater) {
  open();
  const std::string id = agree();
  take_part(id);
  study.reset();
  write_report(data);
  EventLog(data / "study.events").append({{"kind", "withdrawn"}, {"slot", 0}});
  open();
  EXPECT_FALSE(holds(id));
  EXPECT_FALSE(holds("p01,"));
  EXPECT_FALSE(fs::exists(data / "participants/p01.json"));
}

}  // namespace
}  // namespace lgabench::study

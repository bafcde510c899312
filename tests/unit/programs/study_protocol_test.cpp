// A study's protocol, its pin, who is asked what, and the file of events.
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/abstraction/select_features.hpp>

#include <fstream>
#include <map>
#include <set>

#include "../../schemas.hpp"
#include "study_people.hpp"

namespace lgabench::study {
namespace {

class StudyProtocol : public testing::Test, public TemporaryDirectory {};

TEST_F(StudyProtocol, ThePapersHasItsNineWordingsInItsOrderPrefilledAsItWas) {
  const Protocol protocol = read_protocol(ready_protocol(path, "paper"));
  ASSERT_EQ(protocol.sets.size(), 1u);
  std::vector<std::string> scenarios;
  for (const Item& item : protocol.sets[0]) {
    scenarios.push_back(item.scenario);
    RecordedLanguageModel study(item.space, item.scenario, "gpt4_study");
    EXPECT_EQ(distribution_json(item.proposal), distribution_json(select_features(item.command, item.space, study)));
    EXPECT_EQ(item.asked_as, study.asked_as(item.command)) << "the wording that GPT-4 and people were given";
    EXPECT_EQ(item.proposed_by, study.model());
  }
  EXPECT_EQ(scenarios,
            (std::vector<std::string>{"red_heart", "heart", "tiger_colored_object", "letter_from_the_word_letter",
                                      "consonant_with_a_warm_color", "vowel_with_multiple_colors", "letter",
                                      "something_to_drink_water_out_of", "something_from_a_typical_kitchen"}));
  EXPECT_EQ(protocol.trials(), 18u);
  EXPECT_TRUE(protocol.spares.empty());
  EXPECT_EQ(blanks(protocol).size(), 0u);
}

TEST_F(StudyProtocol, IsAsTheSchemaHasIt) {
  for (const char* name : {"paper", "crossover"})
    EXPECT_EQ(complaints("study_protocol", read_json(ready_protocol(path, name))), std::vector<std::string>()) << name;
  EXPECT_NE(complaints("study_protocol", read_json(ready_protocol(path, "paper", {{"sets", Json::array()}}))),
            std::vector<std::string>());
}

TEST_F(StudyProtocol, ABlankIsATextInDoubleBrackets) {
  const fs::path file = ready_protocol(path, "paper");
  write_file(file, read_json(file).dump());  // on one line, where lists of lists begin with [[
  EXPECT_EQ(blanks(read_protocol(file)), std::vector<std::string>());
}

TEST_F(StudyProtocol, IsRefusedWithThePlace) {
  for (const auto& [changes, expected] : std::vector<std::pair<Json, std::string>>{
           {{{"sets", {{{{"scenario", "hart"}}}}}}, "no scenario \"hart\""},
           {{{"sets", {{{{"scenario", "heart"}}, {{"scenario", "heart"}}}}}}, "heart is there twice"},
           {{{"sets", {{{{"scenario", "q3_fruit"}}}}}}, "/sets/0/0/scenario: expected a scenario with one command"},
           {{{"sets", {{{{"scenario", "heart"}}}, {{{"scenario", "letter"}}}}}}, "two sets of one even size"},
           {{{"consent", "../consent.txt"}}, "/consent: expected a file's name"},
           {{{"exclusions", {{"fewest", 1}}}}, "/exclusions"},
           {{{"instruction", ""}}, "/instruction: expected words"},
           {{{"questionnaire", {{"nasa_tlx", "twice"}, {"free_text", true}}}},
            "/questionnaire/nasa_tlx: expected true, false or \"by_condition\""},
           {{{"planned_people", 0}}, "/planned_people"}}) {
    const fs::path file = ready_protocol(path, "paper", changes);
    EXPECT_SAYS(message_of<InputError>([&file] { read_protocol(file); }), expected);
  }
}

TEST_F(StudyProtocol, BeginsOnlyFilledAndAsItWasPinned) {
  const fs::path file = ready_protocol(path, "crossover");
  EXPECT_SAYS(not_ready(read_protocol(file), file), "not pinned");
  write_file(pin_file(file), pin_of(read_protocol(file)).dump());
  EXPECT_EQ(not_ready(read_protocol(file), file), "");
  write_file(path / "consent.txt", "I agree to something else.\n");
  EXPECT_SAYS(not_ready(read_protocol(file), file), "the consent differs from what");
  write_file(path / "consent.txt", "I agree, [[NAME]].\n");
  EXPECT_SAYS(not_ready(read_protocol(file), file), "1 blanks to fill in");
  EXPECT_EQ(blanks(read_protocol(file)), (std::vector<std::string>{"consent: [[NAME]]"}));
  ready_protocol(path, "crossover", {{"seed", 8}});
  EXPECT_SAYS(not_ready(read_protocol(file), file), "the protocol differs from what");
  Json other = pin_of(read_protocol(ready_protocol(path, "crossover")));
  other["stimuli"] = "another";
  write_file(pin_file(file), other.dump());
  EXPECT_SAYS(not_ready(read_protocol(file), file), "what people are shown (scenarios, answers) differs");
}

TEST_F(StudyProtocol, OneThat0_2_0PinnedKeepsItsPin) {
  // Without an instruction, and with NASA-TLX at the end; "stimuli" as 0.2.0 wrote them.
  Json json = read_json(ready_protocol(path, "paper"));
  json.erase("instruction");
  json["questionnaire"]["nasa_tlx"] = true;
  const fs::path file = path / "protocol.json";
  write_file(file, json.dump());
  const Protocol protocol = read_protocol(file);
  EXPECT_EQ(protocol.tlx, Tlx::at_end);
  EXPECT_EQ(protocol.instruction, "");
  EXPECT_EQ(pin_of(protocol).size(), 3u);
  EXPECT_EQ(pin_of(protocol).at("stimuli"), "b654475d803a7c75ad0fe5e010283549c1f84fb5a11ca7ed08fdf7703206b0ca");
}

TEST_F(StudyProtocol, TheInstructionIsPinned) {
  const fs::path file = ready_protocol(path, "paper");
  EXPECT_EQ(read_protocol(file).instruction, "Work as fast as you can without mistakes.");
  write_file(pin_file(file), pin_of(read_protocol(file)).dump());
  ready_protocol(path, "paper", {{"instruction", "Take your time."}});
  EXPECT_SAYS(not_ready(read_protocol(file), file), "the protocol differs from what");
}

TEST(WilliamsSquare, EveryRowColumnAndPairOnce) {
  for (const int n : {2, 4, 8}) {
    const auto square = williams_square(n);
    std::set<std::pair<int, int>> after, places;
    for (const auto& row : square) {
      EXPECT_EQ(std::set<int>(row.begin(), row.end()).size(), static_cast<std::size_t>(n));
      for (std::size_t i = 0; i < row.size(); ++i) places.emplace(i, row[i]);
      for (std::size_t i = 1; i < row.size(); ++i) after.emplace(row[i - 1], row[i]);
    }
    EXPECT_EQ(places.size(), static_cast<std::size_t>(n * n));
    EXPECT_EQ(after.size(), static_cast<std::size_t>(n * (n - 1)));
  }
}

TEST_F(StudyProtocol, EveryBlockIsBalanced) {
  const Protocol paper = read_protocol(ready_protocol(path, "paper"));
  std::set<int> first_of_block;
  for (int slot = 0; slot < 40; slot += 2) {
    const Assignment a = assign(paper, slot), b = assign(paper, slot + 1);
    EXPECT_EQ(a.conditions[0], b.conditions[1]);
    EXPECT_NE(a.conditions[0], a.conditions[1]);
    EXPECT_EQ(a.order[0], b.order[1]) << "one fixed order";
    first_of_block.insert(static_cast<int>(a.conditions[0]));
  }
  EXPECT_EQ(first_of_block.size(), 2u) << "drawn, not in turn";

  const Protocol crossover = read_protocol(ready_protocol(path, "crossover"));
  std::map<std::string, int> rows;
  for (int block = 0; block < 4; ++block) {
    std::set<std::pair<int, int>> cells;
    for (int i = 0; i < 4; ++i) {
      const Assignment a = assign(crossover, 4 * block + i);
      cells.emplace(static_cast<int>(a.conditions[0]), a.sets[0]);
      EXPECT_EQ(a.sets[0] + a.sets[1], 1);
      for (const std::size_t period : {0, 1})
        ++rows[fmt::format("{} {} {} {}", static_cast<int>(a.conditions[0]), a.sets[0], period,
                           fmt::join(a.order[period], ","))];
    }
    EXPECT_EQ(cells.size(), 4u);
  }
  EXPECT_EQ(rows.size(), 4u * 2 * 4) << "in 16 people each row once for each combination and period";
}

class StudyEvents : public testing::Test, public TemporaryDirectory {
 protected:
  fs::path file = path / "a.events";
  EventLog three() {
    EventLog log(file);
    for (int i = 0; i < 3; ++i) log.append({{"number", i}, {"text", "zwölf\n"}});
    return log;
  }
};

TEST_F(StudyEvents, AKillInTheMiddleOfAnAppendLosesNothingThatWasAcknowledged) {
  three();
  const std::string bytes = read_file(file);
  const std::size_t two = bytes.rfind('\n', bytes.size() - 2) + 1;
  for (std::size_t size = two; size < bytes.size(); ++size) {
    std::ofstream(file, std::ios::binary) << bytes.substr(0, size);
    EXPECT_EQ(EventLog(file).events().size(), 2u) << size;
    EXPECT_EQ(read_file(file).size(), size) << "reading changes nothing";
    EventLog log(file, true);
    log.append({{"number", 9}});
    EXPECT_EQ(EventLog(file).events().size(), 3u) << size;
  }
}

TEST_F(StudyEvents, WhatWasChangedIsRefusedWithItsLine) {
  three();
  const std::string bytes = read_file(file);
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string changed = bytes;
    changed[at] ^= 1;
    std::ofstream(file, std::ios::binary) << changed;
    if (at + 1 == bytes.size()) {  // without its end it was never acknowledged
      EXPECT_EQ(EventLog(file).events().size(), 2u);
      continue;
    }
    EXPECT_SAYS(message_of<InputError>([this] { EventLog again(file); }), "a.events: line ");
  }
}

TEST_F(StudyEvents, WhatAFailedAppendLeftIsTakenBack) {
  EventLog log = three();
  std::ofstream(file, std::ios::binary | std::ios::app) << "77 half an ev";
  log.append({{"number", 3}});
  EXPECT_EQ(EventLog(file).events(), log.events());
}

}  // namespace
}  // namespace lgabench::study

// The study of disputed pairs: what it asks, its power, what people settle.
#include <lgabench/abstraction/disputed.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/study/report.hpp>

#include <set>

#include "../../schemas.hpp"
#include "study_people.hpp"

namespace lgabench::study {
namespace {

TEST(PairStudy, ThePowerIsThatOfTheExactBinomialTest) {
  // Of 20 people 15 reject a half at 5 % (2 x .0207), of 21 it takes 16; upper tails of Binomial(20, .8) and (21, .8).
  EXPECT_NEAR(p_unsettled({15, 5, 0}), .0414, 5e-5);
  EXPECT_NEAR(power(20, 1), .8042, 5e-5);
  EXPECT_NEAR(power(21, 1), .7693, 5e-5);
  EXPECT_EQ(people_needed(1), 23);
  EXPECT_GT(people_needed(60), 40);
  EXPECT_LT(power(people_needed(60) - 1, 60), .8);
}

TEST(PairStudy, WhoCannotTellStandsAgainstBoth) {
  EXPECT_EQ(p_unsettled({5, 5, 20}), 1);
  EXPECT_EQ(p_unsettled({10, 0, 10}), 1);
  EXPECT_DOUBLE_EQ(p_unsettled({0, 15, 5}), p_unsettled({15, 5, 0}));
}

TEST(PairStudy, KrippendorffsAlphaIsThatOfHisExample) {
  // Krippendorff 2011, C: four observers, twelve units, five values, with gaps; each unit's values in a column.
  const std::vector<std::string> observers{"123321412...", "1233224125.3", ".3332342251.", "12332441251."};
  std::vector<std::vector<int>> units(12, std::vector<int>(5));
  for (const std::string& observer : observers)
    for (std::size_t unit = 0; unit < 12; ++unit)
      if (observer[unit] != '.') ++units[unit][static_cast<std::size_t>(observer[unit] - '1')];
  EXPECT_NEAR(krippendorff_alpha(units).value(), .743, 5e-4);
  EXPECT_FALSE(krippendorff_alpha({{3, 0}, {2, 0}}));
}

class PairProtocol : public testing::Test, public TemporaryDirectory {
 protected:
  // With one command, of which two pairs are open.
  fs::path small(const Json& changes = Json::object()) {
    Json json{{"sets",
               {{{{"scenario", "something_with_a_hole_in_the_middle"},
                  {"asked_as", "Bring me something with a hole in the middle."},
                  {"pairs",
                   {{{"object_type", "letter A"}, {"texture", "red"}},
                    {{"object_type", "letter R"}, {"texture", "blue"}},
                    {{"object_type", "ring"}, {"texture", "red"}, {"settled", true}},
                    {{"object_type", "heart"}, {"texture", "red"}, {"settled", false}}}}}}}}};
    json.update(changes);
    return ready_protocol(path, "disputed", json);
  }
};

TEST_F(PairProtocol, AsksWhatIsDisputedAndControlsThatAreNot) {
  const Json items = disputed_items(7);
  EXPECT_EQ(items, disputed_items(7));
  EXPECT_NE(items, disputed_items(8));
  std::set<std::string> asked;
  for (const Json& item : items) {
    const Scenario scenario = load_scenario(item.at("scenario"));
    const std::string command = item.at("asked_as");
    asked.insert(command);
    const std::vector<FeatureSet> rows = disputed_pairs(scenario.space).at(command);
    std::vector<int> of_row(rows.size());
    std::set<bool> controls;
    for (const Json& pair : item.at("pairs")) {
      bool is_disputed = false;
      for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows[i].contains(pair.at("object_type"), pair.at("texture"))) is_disputed = true, ++of_row[i];
      EXPECT_NE(is_disputed, pair.contains("settled")) << command << pair;
      if (pair.contains("settled")) controls.insert(pair.at("settled").get<bool>());
    }
    for (std::size_t i = 0; i < rows.size(); ++i)
      EXPECT_GE(of_row[i], std::min<std::size_t>(4, rows[i].object_types.size() * rows[i].textures.size())) << command;
    EXPECT_EQ(controls, (std::set<bool>{false, true})) << command;
  }
  for (const char* space : {"tabletop", "household_mobile"})
    for (const auto& [command, rows] : disputed_pairs(load_feature_space(space)))
      EXPECT_EQ(asked.count(command), 1u) << command;
}

TEST_F(PairProtocol, IsAsTheSchemaHasItAndPlansEnoughPeople) {
  const fs::path file = ready_protocol(path, "disputed", {{"sets", {disputed_items(7)}}});
  EXPECT_EQ(complaints("study_protocol", read_json(file)), std::vector<std::string>());
  const Protocol protocol = read_protocol(file);
  EXPECT_EQ(protocol.trials(), protocol.sets[0].size());
  EXPECT_GE(protocol.planned, people_needed(count_pairs(protocol).disputed));
  EXPECT_SAYS(power_words(protocol), fmt::format("{} disputed pairs", count_pairs(protocol).disputed));
}

TEST_F(PairProtocol, IsRefusedWithThePlace) {
  const Json lists{{"scenario", "heart"}};
  const Json pairs{{"scenario", "heart"},
                   {"asked_as", "Bring me the heart."},
                   {"pairs", {{{"object_type", "heart"}, {"texture", "red"}}}}};
  Json other = pairs, unknown = pairs;
  other["asked_as"] = "Bring me the star.";
  unknown["pairs"][0]["texture"] = "reddish";
  for (const auto& [changes, expected] :
       std::vector<std::pair<Json, std::string>>{{{{"sets", {{lists}}}}, "pairs in practice and every command"},
                                                 {{{"sets", {{pairs, lists}}}}, "pairs in practice and every command"},
                                                 {{{"spares", {pairs}}}, "pairs in practice and every command"},
                                                 {{{"sets", {{other}}}}, "asked_as: expected a command of heart"},
                                                 {{{"sets", {{unknown}}}}, "texture: expected a word of the space"}})
    EXPECT_SAYS(message_of<InputError>([&, json = changes] { read_protocol(small(json)); }), expected);
}

class PairPeople : public PairProtocol {
 protected:
  // The answer to each pair of the command, in the protocol's order.
  void take_part(Study& study, const std::vector<std::string>& answers) {
    const Protocol& protocol = study.protocol();
    const std::string id = study.begin(fmt::format("{:032x}", study.slots()), sha256_of_consent, false);
    Page page{id};
    const auto say = [&](const char* kind, const Json& more = Json::object()) {
      page.ms += 1000;
      return study.post(id, page.event(kind, more)).value();
    };
    say("opened");
    Json state = say("familiarised");
    for (const Item* item : {&protocol.practice, &protocol.sets[0][0]}) {
      EXPECT_EQ(state.at("step"), "trial");
      const Json trial = say("start").at("trial");
      say("shown");
      if (item->pairs.size() == 4 && interrupt) {
        page = Page{id + "again"};
        state = say("opened");
        EXPECT_TRUE(state.at("trial").at("interrupted"));
        EXPECT_EQ(say("start").at("trial").at("pairs"), trial.at("pairs"));
        say("shown");
      }
      Json said = Json::array();
      for (const Json& shown : trial.at("pairs"))
        for (std::size_t i = 0; i < item->pairs.size(); ++i)
          if (item->pairs[i].object_type == shown.at("object_type"))
            said.push_back(item->pairs.size() == 4 ? answers[i] : "yes");
      state = say("submit", {{"answers", said}, {"longest_wait_ms", 9000}});
    }
    EXPECT_EQ(say("questionnaire", {{"tlx", tlx(1)}, {"free_text", ""}}).at("step"), "debriefing");
  }
  bool interrupt = false;
  std::string sha256_of_consent;
};

TEST_F(PairPeople, SettleWhatMoreThanHalfOfThemSay) {
  const fs::path file = small({{"exclusions", {{"fewest_trials", 1}, {"most_controls_failed", 1}}}});
  Protocol protocol = read_protocol(file);
  sha256_of_consent = Json::parse(protocol.pin).at("consent");
  {
    Study study(path / "data", std::move(protocol), file, Kind::people);
    for (int i = 0; i < 12; ++i) {
      interrupt = i == 3;
      take_part(study, {"no", i < 6 ? "yes" : "can't tell", i == 0 ? "no" : "yes", "no"});
    }
    take_part(study, {"yes", "yes", "no", "can't tell"});  // fails both controls
  }
  const Record record = read_study(path / "data");
  const StudyResults results = results_of(record);
  EXPECT_EQ(results.used(), 12);
  EXPECT_EQ(results.people.back().excluded, "2 controls failed, 1 allowed");
  EXPECT_EQ(controls_failed(*record.protocol, *results.people.front().session), 1);
  ASSERT_EQ(results.pairs.size(), 4u);
  EXPECT_EQ(results.pairs[0].said, (Said{0, 12, 0}));
  EXPECT_NEAR(results.pairs[0].p_holm, 2 * 2 / 4096., 1e-9) << "two pairs";
  EXPECT_TRUE(results.pairs[0].settled());
  EXPECT_EQ(results.pairs[1].said, (Said{6, 0, 6}));
  EXPECT_FALSE(results.pairs[1].settled());
  EXPECT_EQ(results.pairs[2].said, (Said{11, 1, 0}));
  EXPECT_EQ(results.interrupted, 1);
  EXPECT_EQ(complaints("study_results", to_json(results)), std::vector<std::string>());
  const Json found = to_json(results).at("agreement").at("pairs");
  EXPECT_EQ(found[0].at("settled"), false);
  EXPECT_TRUE(found[1].at("settled").is_null());
  EXPECT_EQ(found[2].at("control"), true);
  EXPECT_NE(trials_csv(results).find(R"(""letter A, red"":""no"")"), std::string::npos);
  EXPECT_FALSE(fs::exists(path / "data" / "participants")) << "no answer of these is a Selection";
}

TEST_F(PairPeople, AnswerEachPairInTheOfferedWords) {
  const fs::path file = small();
  Protocol protocol = read_protocol(file);
  const std::string consent = Json::parse(protocol.pin).at("consent");
  Study study(path / "data", std::move(protocol), file, Kind::people);
  const std::string id = study.begin(std::string(32, '0'), consent, false);
  Page page{id};
  for (const char* kind : {"opened", "familiarised", "start", "shown"}) page.ms += 1, study.post(id, page.event(kind));
  page.ms += 1;
  for (const auto& [more, expected] : std::vector<std::pair<Json, std::string>>{
           {{{"answers", {"yes"}}, {"longest_wait_ms", 1}}, "one for each pair"},
           {{{"answers", {"yes", "maybe"}}, {"longest_wait_ms", 1}}, "yes, no or can't tell"},
           {submitted({"heart"}, {"red"}), "selection"}})
    EXPECT_SAYS(message_of<Refused>([&, event = page.event("submit", more)] { study.post(id, event); }), expected);
}

}  // namespace
}  // namespace lgabench::study

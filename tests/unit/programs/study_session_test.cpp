// One person's session: what is taken, what a broken trial leads to, what a restart finds.
#include <lgabench/study/session.hpp>

#include "study_people.hpp"

namespace lgabench::study {
namespace {

class StudySession : public testing::Test, public TemporaryDirectory {
 protected:
  std::unique_ptr<Protocol> protocol;
  std::unique_ptr<Session> session;
  Page page;
  std::int64_t at = 0;  // the server's clock

  void begin(const std::string& name, int slot = 0, const Json& changes = Json::object()) {
    protocol = std::make_unique<Protocol>(read_protocol(ready_protocol(path, name, changes)));
    EventLog log(path / (std::string(32, 'a') + ".events"));
    log.append({{"kind", "begin"}, {"slot", slot}, {"key", "k"}, {"consent", {{"given", true}}}});
    session = std::make_unique<Session>(*protocol, std::move(log));
    post("opened");
  }
  bool post(const std::string& kind, const Json& more = Json::object()) {
    return session->post(page.event(kind, more), at);
  }
  void familiarise() { post("familiarised"), post("example_seen"); }
  // What the command means, as in the truth, in that many seconds.
  void answer(double seconds, double wait_ms = 0) {
    post("start"), post("shown");
    const Item& item = *current().item;
    const Selection chosen = item.truth ? *item.truth : item.proposal;
    page.ms += 1000 * seconds, at += static_cast<std::int64_t>(1000 * seconds);
    post("submit", submitted(chosen.target.product().object_types, chosen.target.product().textures, wait_ms));
  }
  void rate(int load) { post("questionnaire", {{"tlx", tlx(load)}, {"free_text", ""}}); }
  const Trial& current() const {
    for (const Trial& trial : session->all())
      if (trial.state != Trial::finished && trial.state != Trial::interrupted) return trial;
    throw std::logic_error("none left");
  }
  std::string refused(const Json& event) {
    return message_of<Refused>([&] { session->post(event, at); });
  }
  int finished() const {
    int n = 0;
    for (const Trial& trial : session->all()) n += trial.state == Trial::finished && !trial.practice;
    return n;
  }
};

TEST_F(StudySession, GoesFromPicturesToDebriefing) {
  begin("paper");
  EXPECT_EQ(session->state().at("step"), "familiarisation");
  EXPECT_EQ(session->state().at("textures").size(), 83u);
  familiarise();
  EXPECT_TRUE(session->state().at("trial").at("practice"));
  answer(1), answer(1);
  for (int i = 0; i < 18; ++i) {
    if (i == 9) rate(70);
    EXPECT_EQ(session->state().at("trial").at("number"), i + 1);
    EXPECT_FALSE(session->state().at("trial").contains("command")) << "nobody reads ahead";
    answer(10 + i);
  }
  EXPECT_EQ(session->state().at("step"), "questionnaire");
  EXPECT_TRUE(session->state().at("last"));
  EXPECT_TRUE(session->state().at("free_text"));
  const Json none{{"mental", nullptr},      {"physical", nullptr}, {"temporal", 5},
                  {"performance", nullptr}, {"effort", nullptr},   {"frustration", nullptr}};
  post("questionnaire", {{"tlx", none}, {"free_text", "<b>"}});
  EXPECT_EQ(session->state().at("step"), "debriefing");
  EXPECT_EQ(session->tlx(session->assignment().conditions[0]), tlx(70));
  EXPECT_EQ(session->tlx(session->assignment().conditions[1]), none);
  EXPECT_EQ(finished(), 18);
  EXPECT_DOUBLE_EQ(session->all()[2].raw_s, 10);
  EXPECT_DOUBLE_EQ(session->all()[2].server_s, 10);
}

TEST_F(StudySession, AProtocolOf0_2_0AsksOnceAtTheEndAsItDid) {
  begin("paper", 0, {{"questionnaire", {{"nasa_tlx", true}, {"free_text", true}}}});
  familiarise(), answer(1), answer(1);
  for (int i = 0; i < 18; ++i) answer(10);
  EXPECT_EQ(session->step(), Session::questionnaire);
  EXPECT_FALSE(session->state().contains("condition")) << "about all of it";
  rate(40);
  EXPECT_EQ(session->step(), Session::debriefing);
  EXPECT_EQ(session->answers().at("tlx"), tlx(40));
  EXPECT_TRUE(session->tlx(Condition::human).is_null());
}

TEST_F(StudySession, ConditionsShowEmptyListsOrTheProposal) {
  begin("paper");
  familiarise(), answer(1), answer(1);
  for (int i = 0; i < 18; ++i) {
    if (i == 9) rate(50);
    const Trial trial = current();
    post("start");
    const Json first = session->state().at("trial").at("sets").at(0).at("first");
    const std::vector<std::string> filled = trial.condition == Condition::human
                                                ? std::vector<std::string>{}
                                                : trial.item->proposal.target.product().textures;
    EXPECT_EQ(first.at("textures").get<std::vector<std::string>>(), filled);
    EXPECT_EQ(trial.condition, session->assignment().conditions[i / 9]);
    post("shown");
    page.ms += 1;
    post("submit", submitted({"heart"}, {"red"}));
  }
}

TEST_F(StudySession, AnEventCountsOnceAndOnlyWhereItFits) {
  begin("paper");
  EXPECT_SAYS(refused(page.event("start")), "fits where the session is");
  EXPECT_SAYS(refused(page.event("submit", submitted({"heart"}, {"red"}))), "fits where the session is");
  familiarise();
  post("start"), post("shown");
  const Json once = page.event("edit", edit("object_types", {"ring"}, current().condition == Condition::human));
  EXPECT_FALSE(session->post(once, at));
  EXPECT_FALSE(session->post(once, at)) << "a page that is told where it is would begin its trial anew";
  EXPECT_EQ(current().edits, 1);
  for (const auto& [event, expected] : std::vector<std::pair<Json, std::string>>{
           {page.event("edit", edit("object_types", {"hart"})), "/values: expected words of the space"},
           {page.event("edit", edit("colors", {"red"})), "/feature"},
           {page.event("edit", {{"role", "avoid"}, {"feature", "textures"}, {"values", {"red"}}, {"on", true}}),
            "/role"},
           {page.event("submit", submitted({"heart"}, {"red"})), "/page_ms: expected a time after"},
           {page.event("idle", {{"since_ms", 1e9}}), "/since_ms"},
           {page.event("blur", {{"more", 1}}), "more"},
           {page.event("unheard of"), "/kind"},
           {{{"key", "x"}, {"page", "page"}, {"kind", "blur"}, {"page_ms", -1}}, "/page_ms"},
           {Json::array(), "expected"}})
    EXPECT_SAYS(refused(event), expected);
  page.ms = 5;
  EXPECT_SAYS(refused(page.event("submit", submitted({}, {"red"}))), "at least one object type");
  EXPECT_EQ(session->log().events().size(), 7u) << "what is refused leaves no trace";
}

TEST_F(StudySession, ASecondPageTakesOverAndBreaksTheTrial) {
  begin("crossover");
  familiarise(), answer(1), answer(1), answer(5);
  post("start"), post("shown");
  const std::string broken = current().item->scenario;
  Page other{"other"};
  session->post(other.event("opened"), at);
  const Refused::Why why = [&] {
    try {
      session->post(page.event("submit", submitted({"heart"}, {"red"})), at);
    } catch (const Refused& e) {
      return e.why();
    }
    return Refused::bad;
  }();
  EXPECT_EQ(why, Refused::conflict);
  EXPECT_EQ(session->all()[3].state, Trial::interrupted);
  EXPECT_TRUE(session->state().at("trial").at("interrupted"));
  page = other;
  for (int i = 0; i < 3; ++i) {  // two are left of its period, and a spare comes last of it
    EXPECT_NE(current().item->scenario, broken);
    EXPECT_EQ(current().period, 0);
    if (i == 2) {
      EXPECT_EQ(current().item, &protocol->spares[0]);
    }
    answer(5);
  }
  EXPECT_EQ(session->state().at("step"), "questionnaire");
  EXPECT_EQ(session->state().at("condition"), to_string(session->assignment().conditions[0]));
  EXPECT_FALSE(session->state().at("free_text"));
  EXPECT_SAYS(refused(page.event("start")), "fits where the session is");
  EXPECT_SAYS(refused(page.event("questionnaire", {{"tlx", tlx(1)}, {"free_text", "early"}})),
              "nothing before the end");
  EXPECT_FALSE(session->answered());
  rate(50);
  EXPECT_EQ(current().period, 1);
  for (int i = 0; i < 4; ++i) answer(5);
  EXPECT_EQ(finished(), 8);
  EXPECT_EQ(session->step(), Session::questionnaire);
}

TEST_F(StudySession, ThePapersProtocolHasNoSpare) {
  begin("paper");
  familiarise(), answer(1), answer(1);
  answer(20, 1000 * longest_wait_s + 1);  // too long without a connection
  EXPECT_EQ(session->all()[2].state, Trial::interrupted);
  for (int i = 0; i < 17; ++i) {
    if (i == 8) rate(50);
    answer(20, 1000 * longest_wait_s);
  }
  EXPECT_EQ(finished(), 17);
  EXPECT_EQ(session->step(), Session::questionnaire);
}

TEST_F(StudySession, ABrokenPracticeComesAgain) {
  begin("crossover");
  familiarise();
  for (int i = 0; i < 3; ++i) {
    post("start");
    post("opened");
    EXPECT_TRUE(current().practice);
  }
  answer(1), answer(1);
  EXPECT_FALSE(current().practice);
  EXPECT_EQ(session->all().size(), 2u + 3 + 8);
}

TEST_F(StudySession, ActiveTimeLacksWhatWasAwayOrIdleEachOnce) {
  begin("paper");
  familiarise(), answer(1), answer(1);
  post("start");
  page.ms = 10000, post("shown");
  const auto then = [this](double s, const char* kind, const Json& more = Json::object()) {
    page.ms = 10000 + 1000 * s, at = static_cast<std::int64_t>(1000 * s);
    post(kind, more);
  };
  then(5, "blur"), then(15, "focus");                         // 10 s
  then(51, "idle", {{"since_ms", 30000}}), then(55, "blur");  // since 20 s
  then(57, "active"), then(60, "focus");                      // a mouse above the window is no focus: until 60 s
  then(70, "blur");                                           // to the end
  then(100, "submit", submitted({"heart"}, {"red"}));
  EXPECT_DOUBLE_EQ(session->all()[2].raw_s, 100);
  EXPECT_DOUBLE_EQ(session->all()[2].active_s, 100 - 10 - 40 - 30);
}

TEST_F(StudySession, APageTellsNoTimeThatHasNotPassed) {
  begin("paper");
  familiarise(), answer(1), answer(1);
  post("start"), post("shown");
  const double shown = page.ms;
  at += 5000;
  for (const double ms : {shown + 66000., 1e300}) {
    page.ms = ms;
    EXPECT_SAYS(refused(page.event("submit", submitted({"heart"}, {"red"}))),
                "/page_ms: expected a time that has passed");
  }
  page.ms = shown + 64000;  // within a minute of the server's clock: only counted
  post("submit", submitted({"heart"}, {"red"}));
  EXPECT_EQ(session->all()[2].state, Trial::finished);
}

TEST_F(StudySession, EditsOfTheProposalGiveWhatIsSubmitted) {
  begin("paper");
  familiarise(), answer(1), answer(1);
  while (current().condition != Condition::lga_hill || current().item->scenario != "red_heart") {
    if (session->step() == Session::questionnaire) rate(50);
    answer(1);
  }
  if (session->step() == Session::questionnaire) rate(50);
  post("start"), post("shown");
  post("edit", edit("textures", {"red swirl", "red paisley"}, false)), post("edit", edit("object_types", {"star"}));
  page.ms += 10;
  post("submit", submitted({"star", "heart"}, {"dark red", "red", "dark red swirl"}));
  const auto last = [this] {
    std::optional<Trial> found;
    for (const Trial& trial : session->all())
      if (trial.state == Trial::finished) found = trial;
    return found.value();
  };
  EXPECT_TRUE(last().edits_agree);
  EXPECT_EQ(last().edits, 2);
  post("start"), post("shown"), page.ms += 10;
  post("submit", submitted({"star"}, {"red"}));
  EXPECT_FALSE(last().edits_agree) << "clicks that never arrived";
}

TEST_F(StudySession, IsTheSameAfterARestartAtEveryEvent) {
  begin("crossover", 3);
  familiarise(), answer(1), answer(1), answer(7);
  post("start"), post("shown"), post("edit", edit("textures", {"red"}));
  page.name = "second", post("opened"), answer(9);
  while (session->step() == Session::trials) answer(11);
  rate(30);
  while (session->step() == Session::trials) answer(11);
  const std::vector<Json> events = session->log().events();
  std::unique_ptr<Session> whole = std::move(session);
  fs::remove(whole->log().file());
  EventLog first(path / (std::string(32, 'a') + ".events"));
  first.append(events.front());
  for (std::size_t i = 1; i < events.size(); ++i) {
    session = std::make_unique<Session>(*protocol, EventLog(first.file(), true));  // the server was killed here
    Json event = events[i];
    event.erase("at");
    session->post(event, events[i].at("at"));
    session->post(event, events[i].at("at"));  // the acknowledgement was lost
  }
  EXPECT_EQ(session->log().events(), events);
  EXPECT_EQ(session->state(), whole->state());
}

}  // namespace
}  // namespace lgabench::study

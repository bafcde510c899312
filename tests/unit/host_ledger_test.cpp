// Who says where a Selection comes from: the worker, by what was asked.
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <lgabench/host/answer_ledger.hpp>
#include <lgabench/host/messages.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

const FeatureSpace space{"tabletop", {"heart", "star", "pan"}, {"red", "blue"}};
const Command command{"Bring me the heart.", "pick_and_place"};

// Says yes to hearts and to red; costs a token a question.
class Yes : public LanguageModel {
 public:
  std::vector<bool> answer(const Command&, const FeatureSpace&, const std::vector<Question>& questions) override {
    if (refuses) throw MethodError("no answer was recorded");
    std::vector<bool> answers;
    for (const Question& q : questions) answers.push_back(q.candidate == "heart" || q.candidate == "red");
    cost_.lm_queries += static_cast<int>(questions.size());
    return answers;
  }
  std::vector<Hypothesis> hypotheses(const Command&, const FeatureSpace&) override {
    if (refuses) return {};
    ++cost_.lm_queries;
    return {{"The person likes stars.", FeatureSet{{"star"}, {"red"}}}, {"Pans.", FeatureSet{{"pan"}, {"red"}}}};
  }
  std::string model() const override { return "a model"; }
  std::string asked_as(const Command&) const override { return "Fetch the heart."; }
  Provenance provenance() const override { return Provenance::recorded; }
  SelectionCost cost() const override { return cost_; }
  bool refuses = false;

 private:
  SelectionCost cost_{100, 0, 0, 0};
};

// Adds the star to a proposal; costs seconds.
class Person : public HumanAnswers {
 public:
  Selection specify(const Command&) override { return of(FeatureSet{{"heart"}, {"red"}}, 5); }
  Selection edit(const Command&, const Selection& proposal) override {
    proposed = proposal;
    return of(FeatureSet{{"heart", "star"}, {"red"}}, 3);
  }
  bool accepts(const Command&, const std::string& object_type, const std::string&) override {
    return object_type == "star";
  }
  Selection proposed;

 private:
  static Selection of(FeatureSet target, double seconds) {
    Selection selection;
    selection.target = std::move(target);
    selection.provenance = Provenance::human;
    selection.source = "p1";
    selection.cost.human_seconds = seconds;
    return selection;
  }
};

struct NoLog : TrainingLog {
  void epoch(int, long long, double) override {}
};

class AnswerLedgerTest : public testing::Test {
 protected:
  AnswerLedgerTest() {
    int ends[2];
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    worker_ = std::make_unique<Channel>(Descriptor(ends[0]), [](short) {});
    host_ = std::make_unique<Channel>(Descriptor(ends[1]), [](short) {});
  }
  Json say(const Json& question) {
    EXPECT_TRUE(asked_.answer({question}, *worker_));
    return host_->receive()->header;
  }
  Json ask_all() {
    Json questions = Json::array();
    for (const auto& type : space.object_types) questions.push_back(host::to_json(Question{{}, {}, type}, command));
    for (const auto& texture : space.textures)
      questions.push_back(host::to_json(Question{{}, Question::Group::texture, texture}, command));
    return say({{"type", "ask"},
                {"command", host::to_json(command)},
                {"space", host::to_json(space)},
                {"questions", questions}});
  }
  Json person(const char* how, const FeatureSet& proposal = {}) {
    return say({{"type", "person"},
                {"how", how},
                {"command", host::to_json(command)},
                {"proposal", {{"target", to_json(proposal)}}}});
  }
  Selection account(const FeatureSet& target) const {
    Selection selection;
    selection.target = target;
    selection.provenance = Provenance::human;  // what a method says of itself does not count
    selection.source = "myself";
    selection.cost = {-5, -99, 1e9, 1e9};
    return asked_.account(selection);
  }

  Yes model_;
  Person person_;
  NoLog log_;
  Json options_ = Json::object();
  ActionSpace actions_;
  Services services_{model_, person_, options_, 0, log_, actions_};
  AnswerLedger asked_{space, services_};
  std::unique_ptr<Channel> worker_, host_;
};

TEST_F(AnswerLedgerTest, nobody_is_a_rule_or_nothing) {
  EXPECT_EQ(account({{"heart"}, {"red"}}).provenance, Provenance::rule);
  EXPECT_EQ(account({{"heart"}, {"red"}}).source, "");
  EXPECT_EQ(account({{"heart"}, {"red"}}).cost.lm_queries, 0);
  EXPECT_EQ(account({}).provenance, Provenance::none);
}

TEST_F(AnswerLedgerTest, a_model_and_what_it_cost) {
  EXPECT_EQ(ask_all()["answers"], Json({true, false, false, true, false}));
  const Selection same = account({{"heart"}, {"red"}});
  EXPECT_EQ(same.provenance, Provenance::recorded);
  EXPECT_EQ(same.source, "a model");
  EXPECT_EQ(same.asked_as, "Fetch the heart.");
  EXPECT_EQ(same.cost.lm_queries, 5);
  EXPECT_EQ(same.cost.human_seconds, 0);
  EXPECT_EQ(account({{"star"}, {"red"}}).source, "a model, edited by the method");
  EXPECT_EQ(account({}).provenance, Provenance::recorded);
}

TEST_F(AnswerLedgerTest, a_person_after_the_model) {
  ask_all();
  person("edit", {{"heart"}, {"red"}});
  EXPECT_EQ(person_.proposed.provenance, Provenance::recorded);
  EXPECT_EQ(person_.proposed.cost.lm_queries, 5);
  const Selection left = account({{"star", "heart"}, {"red"}});  // in any order
  EXPECT_EQ(left.provenance, Provenance::human);
  EXPECT_EQ(left.source, "p1");
  EXPECT_EQ(left.cost.lm_queries, 5);
  EXPECT_EQ(left.cost.human_seconds, 3);
  EXPECT_EQ(account({{"heart"}, {"red"}}).provenance, Provenance::recorded);
  EXPECT_EQ(account({{"pan"}, {"red"}}).source, "p1, edited by the method");
}

TEST_F(AnswerLedgerTest, an_answer_that_fails_is_why_the_call_failed) {
  model_.refuses = true;
  EXPECT_EQ(ask_all()["type"], "refused");
  EXPECT_SAYS(message_of<MethodError>([this] { asked_.rethrow(); }), "no answer was recorded");
}

TEST_F(AnswerLedgerTest, a_malformed_question_breaks_the_protocol) {
  EXPECT_SAYS(message_of<Malformed>([this] { say({{"type", "ask"}}); }), "expected");
  EXPECT_SAYS(message_of<Malformed>([this] {
                say({{"type", "person"}, {"how", "guess"}});
              }),
              "specify, edit, accept, truth, scene, takes or which");
  EXPECT_FALSE(asked_.answer({{{"type", "act"}}}, *worker_));
}

// What a method makes of an answer once it was shown more.
TEST_F(AnswerLedgerTest, a_revision_stands_on_the_answer_before_it) {
  Selection earlier;
  earlier.target = {{"heart", "star"}, {"red"}};
  earlier.provenance = Provenance::live;
  earlier.source = "a model";
  earlier.asked_as = "Fetch the heart.";
  earlier.cost = {20, 300, 1.5, 0};
  AnswerLedger ledger(space, services_, earlier);
  const Selection same = ledger.account(earlier);
  EXPECT_EQ(same.provenance, Provenance::live);
  EXPECT_EQ(same.source, "a model");
  EXPECT_EQ(same.asked_as, "Fetch the heart.");
  EXPECT_EQ(same.cost.lm_queries, 20) << "once";
  Selection narrower;
  narrower.target = {{"heart"}, {"red"}};
  const Selection revised = ledger.account(narrower);
  EXPECT_EQ(revised.source, "a model, edited by the method");
  EXPECT_EQ(revised.cost.lm_tokens, 300);

  earlier.provenance = Provenance::none;  // nobody's answer
  EXPECT_EQ(AnswerLedger(space, services_, earlier).account(narrower).provenance, Provenance::rule);
}

Json ask_for_hypotheses() {
  return {{"type", "ask"}, {"how", "hypotheses"}, {"command", host::to_json(command)}, {"space", host::to_json(space)}};
}

Selection red(const std::string& object_type) {
  Selection selection;
  selection.target = {{object_type}, {"red"}};
  return selection;
}

TEST_F(AnswerLedgerTest, a_hypothesis_is_an_answer_and_one_that_is_edited_is_not) {
  Selection earlier = red("heart");
  earlier.provenance = Provenance::recorded;
  earlier.source = "a model";
  earlier.cost = {20, 300, 1.5, 0};
  AnswerLedger ledger(space, services_, earlier);
  ledger.answer({ask_for_hypotheses()}, *worker_);
  const Json reply = host_->receive()->header;
  EXPECT_EQ(host::read_hypotheses(JsonReader(reply, "reply").at("hypotheses")).at(1).text, "Pans.");
  EXPECT_EQ(ledger.account(red("star")).source, "a model, supposing \"The person likes stars.\"");
  EXPECT_EQ(ledger.account(red("star")).provenance, Provenance::recorded);
  EXPECT_EQ(ledger.account(red("star")).cost.lm_queries, 21);
  EXPECT_EQ(ledger.account(red("heart")).source, "a model");
  Selection other;
  other.target = {{"pan", "heart"}, {"red"}};
  EXPECT_EQ(ledger.account(other).source, "a model, edited by the method");
}

TEST_F(AnswerLedgerTest, what_nobody_knows_costs_its_questions_alone) {
  model_.refuses = true;
  EXPECT_EQ(say(ask_for_hypotheses())["hypotheses"], Json::array());
  EXPECT_EQ(account({{"star"}, {"red"}}).provenance, Provenance::rule);
  EXPECT_EQ(account({{"star"}, {"red"}}).cost.lm_queries, 0);
}

TEST_F(AnswerLedgerTest, a_person_who_is_shown_objects_is_the_source_where_no_model_is) {
  say({{"type", "person"},
       {"how", "accept"},
       {"command", host::to_json(command)},
       {"object_type", "star"},
       {"texture", "red"}});
  EXPECT_EQ(account({{"star"}, {"red"}}).source, "after a person was shown an object");
}

TEST_F(AnswerLedgerTest, a_person_who_is_shown_objects_makes_any_answer_a_simulated_edit) {
  say(ask_for_hypotheses());
  for (const bool star : {true, false})
    EXPECT_EQ(say({{"type", "person"},
                   {"how", "accept"},
                   {"command", host::to_json(command)},
                   {"object_type", star ? "star" : "pan"},
                   {"texture", "red"}})["accepts"],
              star);
  const Selection star = account({{"star"}, {"red"}});
  EXPECT_EQ(star.provenance, Provenance::simulated_edit);
  EXPECT_EQ(star.source, "a model, supposing \"The person likes stars.\", after a person was shown objects");
  EXPECT_EQ(star.cost.human_queries, 2);
  EXPECT_EQ(star.cost.lm_queries, 1);
  EXPECT_EQ(account({{"heart"}, {"blue"}}).provenance, Provenance::simulated_edit)
      << "its own rule knows the truth too";
}

}  // namespace
}  // namespace lgabench

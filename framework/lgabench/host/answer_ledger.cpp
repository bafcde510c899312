#include <lgabench/host/answer_ledger.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include <lgabench/core/contains.hpp>
#include <lgabench/host/messages.hpp>

namespace lgabench {
namespace {

bool nothing_in(const Selection& s) {
  const auto none = [](const FeatureSet& set) { return set.object_types.empty() && set.textures.empty(); };
  return std::all_of(s.target.sets.begin(), s.target.sets.end(), none) && (!s.second || none(*s.second));
}

bool same_distribution(const Selection& a, const Selection& b) { return a.target == b.target && a.second == b.second; }

// Names in the space's order, each once.
std::vector<std::string> in_order(const std::vector<std::string>& names, const std::vector<std::string>& order) {
  std::vector<std::string> sorted;
  std::copy_if(order.begin(), order.end(), std::back_inserter(sorted),
               [&names](const std::string& name) { return contains(names, name); });
  return sorted;
}

Selection in_order(Selection selection, const FeatureSpace& space) {
  const auto sorted = [&space](const FeatureSet& set) {
    return FeatureSet{in_order(set.object_types, space.object_types), in_order(set.textures, space.textures)};
  };
  selection.target =
      with_each_set(std::move(selection.target), [&](const FeatureSet& set, std::size_t) { return sorted(set); });
  if (selection.second) static_cast<FeatureSet&>(*selection.second) = sorted(*selection.second);
  return selection;
}

}  // namespace

AnswerLedger::AnswerLedger(const FeatureSpace& space, Services& services)
    : space_(space), services_(services), before_(services.lm.cost()) {}

AnswerLedger::AnswerLedger(const FeatureSpace& space, Services& services, const Selection& earlier)
    : AnswerLedger(space, services) {
  earlier_ = earlier.cost;
  if (earlier.provenance == Provenance::none || earlier.provenance == Provenance::rule) return;  // nobody's answer
  keep(earlier);
  answers_.back().cost = {};
}

bool AnswerLedger::answer(const Frame& frame, Channel& channel) {
  const JsonReader reader(frame.header, "frame");
  if (frame.type() != "ask" && frame.type() != "person") return false;
  Json reply;
  try {
    reply = frame.type() == "ask" ? answer_questions(reader) : ask_person(reader);
  } catch (const Malformed&) {
    throw;
  } catch (const std::exception& e) {
    failure_ = std::current_exception();
    reply = {{"type", "refused"}, {"reason", e.what()}};
  }
  channel.send(reply);
  return true;
}

void AnswerLedger::rethrow() const {
  if (failure_) std::rethrow_exception(failure_);
}

Json AnswerLedger::answer_questions(const JsonReader& reader) {
  if (reader.has("how")) return answer_in_one(reader);
  const auto [command, space, questions] = host::read_or_malformed([&] {
    std::vector<Question> all;
    const Command asked = host::read_command(reader.at("command"));
    for (const JsonReader& one : reader.at("questions").elements()) all.push_back(host::read_question(one, asked));
    return std::tuple(asked, host::read_space(reader.at("space")), all);
  });
  LanguageModel& lm = services_.lm;
  const std::vector<bool> answers = lm.answer(command, space, questions);
  if (command.second && !model_.second) model_.second = SecondSet{{}, command.second->id};
  for (std::size_t i = 0; i < std::min(answers.size(), questions.size()); ++i) {
    if (!answers[i]) continue;
    const bool second = questions[i].about == Question::About::second;
    FeatureSet& set = second ? *model_.second : model_.target.product();
    (questions[i].group == Question::Group::texture ? set.textures : set.object_types)
        .push_back(questions[i].candidate);
  }
  Json reply = signed_reply(command);
  keep(model_);
  reply.update({{"type", "answers"}, {"answers", answers}});
  return reply;
}

Json AnswerLedger::answer_in_one(const JsonReader& reader) {
  const auto [how, command, space] = host::read_or_malformed([&] {
    const std::string word = reader.at("how").string();
    if (word != "meaning" && word != "hypotheses") reader.at("how").fail("meaning or hypotheses");
    return std::tuple(word, host::read_command(reader.at("command")), host::read_space(reader.at("space")));
  });
  if (how == "hypotheses") {
    const std::vector<Hypothesis> hypotheses = services_.lm.hypotheses(command, space);
    Json reply = signed_reply(command);
    suppose(hypotheses);
    reply.update({{"type", "hypotheses"}, {"hypotheses", host::to_json(hypotheses)}});
    return reply;
  }
  model_.target = services_.lm.mean(command, space);
  Json reply = signed_reply(command);
  keep(model_);
  reply.update({{"type", "meaning"}, {"meaning", to_json(model_.target)}});
  return reply;
}

// Hypotheses count as answers that were given before all others: a Selection that equals none is no edit of them.
void AnswerLedger::suppose(const std::vector<Hypothesis>& hypotheses) {
  if (hypotheses.empty()) return;
  if (answers_.empty()) keep(model_);
  std::vector<Selection> first;
  for (const auto& [text, meaning, weight] : hypotheses) {
    Selection supposed = model_;
    supposed.target = meaning;
    supposed.second = answers_.back().second;
    supposed.source += fmt::format(", supposing \"{}\"", text);
    first.push_back(in_order(supposed, space_));
  }
  answers_.insert(answers_.begin(), first.begin(), first.end());
}

// Whose answers these are.
Json AnswerLedger::signed_reply(const Command& command) {
  LanguageModel& lm = services_.lm;
  model_.provenance = lm.provenance();
  model_.source = lm.model();
  model_.asked_as = lm.asked_as(command);
  model_.cost = lm.cost() - before_;
  return {{"model", lm.model()},
          {"provenance", to_string(lm.provenance())},
          {"asked_as", model_.asked_as},
          {"cost", host::to_json(lm.cost())}};
}

Json AnswerLedger::ask_person(const JsonReader& reader) {
  const auto [how, command, proposal] = host::read_or_malformed([&] {
    const std::string word = reader.at("how").string();
    if (word != "specify" && word != "edit" && word != "accept" && word != "truth" && word != "scene" &&
        word != "takes" && word != "which")
      reader.at("how").fail("specify, edit, accept, truth, scene, takes or which");
    return std::tuple(word, host::read_command(reader.at("command")),
                      word == "edit" ? host::read_selection(reader.at("proposal")) : Selection());
  });
  if (how == "accept") {
    const auto [type, texture] = host::read_or_malformed(
        [&] { return std::pair(reader.at("object_type").string(), reader.at("texture").string()); });
    ++accepts_;
    return {{"type", "accepts"}, {"accepts", services_.human.accepts(command, type, texture)}};
  }
  if (how == "scene" || how == "takes" || how == "which") {
    const bool takes = how == "takes";  // a lambda of C++17 captures no structured binding
    const auto [scene, instance] = host::read_or_malformed([&] {
      constexpr long long most = 1 << 20;
      return std::pair(static_cast<int>(reader.at("scene").integer(-most, most)),
                       takes ? static_cast<std::uint8_t>(reader.at("instance").integer(0, 255)) : 0);
    });
    if (how == "scene") return {{"type", "scene"}, {"objects", host::to_json(services_.human.scene(command, scene))}};
    accepts_ += takes ? 1 : price_of_which;
    if (takes)
      return {{"type", "takes"}, {"takes", services_.human.takes(command, scene, static_cast<std::uint8_t>(instance))}};
    const std::optional<std::uint8_t> one = services_.human.which(command, scene);
    return {{"type", "which"}, {"instance", one ? Json(*one) : Json()}};
  }
  const Selection answered = how == "edit"    ? services_.human.edit(command, account(proposal))
                             : how == "truth" ? services_.truth(command)
                                              : services_.human.specify(command);
  keep(answered);
  return {{"type", "person"}, {"selection", host::selection_for_method(answered)}};
}

void AnswerLedger::keep(Selection answered) { answers_.push_back(in_order(std::move(answered), space_)); }

Selection AnswerLedger::account(Selection selection) const {
  const Selection ordered = in_order(selection, space_);
  Selection from;
  std::string edited;
  if (!answers_.empty()) {
    const auto same = std::find_if(answers_.rbegin(), answers_.rend(),
                                   [&ordered](const Selection& answer) { return same_distribution(answer, ordered); });
    from = same == answers_.rend() ? answers_.back() : *same;
    if (same == answers_.rend()) edited = ", edited by the method";
  } else if (!nothing_in(selection)) {
    from.provenance = Provenance::rule;
  }
  SelectionCost cost = model_.cost;
  cost.human_queries = accepts_;
  for (const Selection& answer : answers_) cost.human_seconds = std::max(cost.human_seconds, answer.cost.human_seconds);
  if (accepts_ > 0) {
    from.provenance = Provenance::simulated_edit;
    edited += fmt::format("{}after a person was shown {}", from.source.empty() && edited.empty() ? "" : ", ",
                          accepts_ == 1 ? "an object" : "objects");
  }
  selection.provenance = from.provenance;
  selection.source = from.source + edited;
  selection.asked_as = from.asked_as;
  selection.cost = cost;
  selection.cost += earlier_;
  return selection;
}

}  // namespace lgabench

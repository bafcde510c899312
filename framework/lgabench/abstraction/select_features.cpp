#include <lgabench/abstraction/select_features.hpp>

#include <fmt/format.h>

#include <utility>

#include <lgabench/abstraction/named.hpp>

namespace lgabench {
namespace {

using About = Question::About;
using Group = Question::Group;

void append_questions(About about, const FeatureSpace& space, std::vector<Question>& questions) {
  for (const std::string& type : space.object_types) questions.push_back({about, Group::object_type, type});
  for (const std::string& texture : space.textures) questions.push_back({about, Group::texture, texture});
}

// Adds what is answered yes to the set that the question is about.
void ask(const Command& command, const FeatureSpace& space, const std::vector<Question>& questions,
         LanguageModel& model, Selection& selection) {
  const std::vector<bool> answers = model.answer(command, space, questions);
  if (answers.size() != questions.size())
    throw MethodError(fmt::format("{}: expected {} answers, got {}", model.model(), questions.size(), answers.size()));
  for (std::size_t i = 0; i < questions.size(); ++i) {
    if (!answers[i]) continue;
    const Question& q = questions[i];
    FeatureSet& set = q.about == About::target ? selection.target.product() : *selection.second;
    (q.group == Group::object_type ? set.object_types : set.textures).push_back(q.candidate);
  }
}

Selection blank(const Command& command) {
  Selection selection;
  if (command.second) selection.second = SecondSet{{}, command.second->id};
  return selection;
}

// With whose answers these are, and what they cost.
Selection signed_by(const LanguageModel& model, const Command& command, const SelectionCost& before,
                    Selection selection) {
  selection.provenance = model.provenance();
  selection.source = model.model();
  selection.asked_as = model.asked_as(command);
  selection.cost = model.cost() - before;
  return selection;
}

}  // namespace

std::vector<Question> feature_questions(const Command& command, const FeatureSpace& space) {
  std::vector<Question> questions;
  append_questions(About::target, space, questions);
  if (command.second) append_questions(About::second, space, questions);
  return questions;
}

Selection select_features(const Command& command, const FeatureSpace& space, LanguageModel& model) {
  const SelectionCost before = model.cost();
  Selection selection = blank(command);
  ask(command, space, feature_questions(command, space), model, selection);
  return signed_by(model, command, before, std::move(selection));
}

Selection select_meaning(const Command& command, const FeatureSpace& space, LanguageModel& model) {
  const SelectionCost before = model.cost();
  Selection selection = blank(command);
  if (command.second) {
    std::vector<Question> questions;
    append_questions(About::second, space, questions);
    ask(command, space, questions, model, selection);
  }
  selection.target = model.mean(command, space);
  return signed_by(model, command, before, std::move(selection));
}

Selection select_as_asked(const std::string& meaning, const Command& command, const FeatureSpace& space,
                          LanguageModel& model) {
  if (meaning == "named") return select_named(command, space);
  return meaning == "structured" ? select_meaning(command, space, model) : select_features(command, space, model);
}

Selection select_as_asked(const Command& command, const FeatureSpace& space, Services& services) {
  return select_as_asked(services.options.value("meaning", "flat"), command, space, services.lm);
}

}  // namespace lgabench

#include <lgabench/abstraction/select_features.hpp>

#include <fmt/format.h>

namespace lgabench {
namespace {

using About = Question::About;
using Group = Question::Group;

}  // namespace

std::vector<Question> feature_questions(const Command& command, const FeatureSpace& space) {
  std::vector<Question> questions;
  for (const About about : {About::target, About::second}) {
    if (about == About::second && !command.second) continue;
    for (const std::string& type : space.object_types) questions.push_back({about, Group::object_type, type});
    for (const std::string& texture : space.textures) questions.push_back({about, Group::texture, texture});
  }
  return questions;
}

Selection select_features(const Command& command, const FeatureSpace& space, LanguageModel& model) {
  const std::vector<Question> questions = feature_questions(command, space);
  const SelectionCost before = model.cost();
  const std::vector<bool> answers = model.answer(command, space, questions);
  if (answers.size() != questions.size())
    throw MethodError(fmt::format("{}: expected {} answers, got {}", model.model(), questions.size(), answers.size()));

  Selection selection;
  if (command.second) selection.second = SecondSet{{}, command.second->id};
  for (std::size_t i = 0; i < questions.size(); ++i) {
    if (!answers[i]) continue;
    const Question& q = questions[i];
    FeatureSet& set = q.about == About::target ? selection.target : *selection.second;
    (q.group == Group::object_type ? set.object_types : set.textures).push_back(q.candidate);
  }
  selection.provenance = model.provenance();
  selection.source = model.model();
  selection.asked_as = model.asked_as(command);
  selection.cost = model.cost() - before;
  return selection;
}

}  // namespace lgabench

#include <lgabench/cell/answering.hpp>

#include <algorithm>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/cell/answers.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>

namespace lgabench {
namespace {

// A method with a number of questions finds people who answer in scenes, whatever the scenario.
Scenario in_scenes(Scenario scenario, bool asks) {
  if (asks && !scenario.questions) scenario.questions = Scenario::Questions{4, 0};
  return scenario;
}

bool knows_all(const RecordedLanguageModel& recorded, const Scenario& scenario) {
  for (std::size_t c = 0; c < scenario.commands.size(); ++c)
    if (!recorded.knows(scenario.command(static_cast<int>(c)))) return false;
  return true;
}

}  // namespace

std::vector<bool> CountingModel::answer(const Command& command, const FeatureSpace& space,
                                        const std::vector<Question>& questions) {
  asked += static_cast<int>(questions.size());
  std::vector<bool> answers = model_.answer(command, space, questions);
  if (always_no_) std::fill(answers.begin(), answers.end(), false);
  return answers;
}

Meaning CountingModel::mean(const Command& command, const FeatureSpace& space) {
  ++asked;
  return always_no_ ? Meaning() : model_.mean(command, space);
}

std::vector<Hypothesis> CountingModel::hypotheses(const Command& command, const FeatureSpace& space) {
  ++asked;
  return always_no_ ? std::vector<Hypothesis>() : model_.hypotheses(command, space);
}

std::vector<bool> TruthfulModel::answer(const Command& command, const FeatureSpace&,
                                        const std::vector<Question>& questions) {
  const Selection truth = truth_.specify(command);
  std::vector<bool> answers;
  for (const Question& question : questions) {
    const FeatureSet& set = question.about == Question::About::target ? truth.target.product() : truth.second.value();
    const auto& names = question.group == Question::Group::object_type ? set.object_types : set.textures;
    answers.push_back(contains(names, question.candidate));
  }
  return answers;
}

Answering::Answering(const Scenario& scenario, const HostJob& job, int demonstrations, bool always_no)
    : asked(in_scenes(scenario, job.options.contains("questions"))),
      recorded(scenario, recorded_source(scenario, "recorded", job.plugin.asks == "edit")),
      truthful(scenario.commands),
      model(knows_all(recorded, scenario) ? static_cast<LanguageModel&>(recorded) : truthful, always_no),
      human(people_of(asked, layouts_of(scenario).front(), job.seed, demonstrations, job.options), job.plugin.asks),
      services{model,
               human,
               job.options,
               job.seed,
               log,
               actions_of(scenario),
               declared_truth(scenario.commands, job.plugin.asks)} {
  services.state = state_of(scenario);
  services.may_stop = scenario.may_stop;
}

}  // namespace lgabench

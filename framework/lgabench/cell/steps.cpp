#include <lgabench/cell/steps.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include <lgabench/abstraction/scenes.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/plugin/guarded.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench {

bool Selected::nothing_for(int command) const {
  return needs.targets == Needs::Targets::selected &&
         instructions.at(static_cast<std::size_t>(command)).selection.empty();
}

bool Selected::nothing_to_learn_from(const Scenario& scenario) const {
  const std::vector<int> shown = scenario.commands_of("train");
  return std::any_of(shown.begin(), shown.end(), [&](int command) { return nothing_for(command); });
}

void TrainingLines::epoch(int epochs, long long steps, double loss) {
  if (!std::isfinite(loss))
    throw MethodError(fmt::format("training diverged: the loss of epoch {} is {}", epochs, loss));
  for (const auto& [name, value] : curves_.items())
    if (!std::isfinite(value.get<double>()))
      throw MethodError(fmt::format("training diverged: the {} of epoch {} is {}", name, epochs, value.get<double>()));
  Json line = std::exchange(curves_, Json::object());
  line.update({{"epoch", epochs}, {"steps", steps}, {"loss", loss}});
  try {
    expect_training_line(JsonReader(line, "training log"));
  } catch (const InputError& e) {
    throw MethodError(e.what());
  }
  lines += canonical(line) + '\n';
  if (counted_) counted_(epochs);
}

void TrainingLines::curve(const std::string& name, double value) {
  constexpr std::size_t most = 16;
  const bool plain = !name.empty() && name.size() <= 40 &&
                     std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; });
  if (!plain || name == "epoch" || name == "steps" || name == "loss")
    throw MethodError(
        "training log: a curve's name has 1 to 40 letters, digits and \"_\", and is not epoch, steps or loss");
  curves_[name] = value;
  if (curves_.size() > most) throw MethodError(fmt::format("training log: more than {} curves", most));
}

Selected select(Method* method, const std::string& id, const Scenario& scenario, Services& services) {
  Selected selected;
  selected.needs.targets = Needs::Targets::truth;
  if (method) selected.needs = guarded(id, [&] { return method->needs(services.options); });
  for (std::size_t c = 0; c < scenario.commands.size(); ++c) {
    const Command command = scenario.command(static_cast<int>(c));
    Selection selection;
    if (method) selection = guarded(id, [&] { return method->select(command, scenario.space, services); });
    selected.instructions.push_back({command.utterance, std::move(selection)});
  }
  return selected;
}

void expect_usable(const Selection& selection, const Scenario& scenario) {
  constexpr std::size_t longest = 2000;
  const auto& [queries, tokens, lm_seconds, human_seconds, human_queries] = selection.cost;
  if (queries < 0 || tokens < 0 || human_queries < 0 || !(lm_seconds >= 0) || !(human_seconds >= 0) ||
      !std::isfinite(lm_seconds + human_seconds))
    throw MethodError(
        fmt::format("selection: /cost: expected finite numbers, none below 0, got {} queries, {} tokens, "
                    "{} s of a model and {} s of people",
                    queries, tokens, lm_seconds, human_seconds));
  for (const std::string* words : {&selection.source, &selection.asked_as})
    if (words->size() > longest || one_line(*words) != *words)
      throw MethodError(fmt::format("selection: /source and /asked_as: expected a line of at most {} bytes", longest));
  try {
    const Json json = distribution_json(selection);
    read_distribution(JsonReader(json, "selection"), scenario.space, scenario.second);
  } catch (const InputError& e) {
    throw MethodError(e.what());
  }
}

std::vector<Scene> sample(const Scenario& scenario, const std::string& layout, const Selected& selected,
                          std::uint64_t training_seed, int count) {
  std::vector<Selection> selections;
  if (selected.needs.targets == Needs::Targets::selected)
    for (const Instruction& instruction : selected.instructions) selections.push_back(instruction.selection);
  std::vector<Scene> scenes;
  for (int i = 0; i < count; ++i) scenes.push_back(training_scene(scenario, layout, selections, training_seed, i));
  return scenes;
}

std::vector<Demonstration> instructed(std::vector<Demonstration> showed, const std::vector<Scene>& scenes,
                                      const Selected& selected) {
  for (std::size_t i = 0; i < showed.size(); ++i)
    showed[i].instruction = selected.instructions.at(static_cast<std::size_t>(scenes[i].command));
  return showed;
}

std::vector<Demonstration> perceived(std::vector<Demonstration> demonstrations, const std::vector<Scene>& scenes,
                                     const Scenario& scenario, const TrainOn& through) {
  const PerturbationAxis& axis = *axes_named(through.axis).front();
  for (std::size_t i = 0; i < demonstrations.size(); ++i) {
    const Scene& scene = scenes.at(i);
    const auto stream = [&](const char* of, const std::string& later = "") {
      return RandomStream(fmt::format("train_on/{}/{}/{}/{}/{}/{}{}", of, axis.id, scene.scenario, scene.layout,
                                      scene.seed, scene.index, later));
    };
    const int drawn = 1 + static_cast<int>(stream("level").below(static_cast<std::uint32_t>(axis.most())));
    int t = 0;
    const auto perceive = [&](Step& step, const std::string& later) {
      const Observation told = step.observation;
      step.observation = axis.perceive(std::move(step.observation), scenario, through.level.value_or(drawn),
                                       stream("direction", later));
      step.observation.state = told.state;
      step.observation.brought = told.brought;
    };
    for (Step& step : demonstrations[i].steps) perceive(step, later_stream(t++));
    for (Step& step : demonstrations[i].recovery) perceive(step, "");
  }
  return demonstrations;
}

void revise(Method& method, const std::string& id, const Scenario& scenario, std::vector<Demonstration>& demonstrations,
            const std::vector<Scene>& scenes, Services& services, Selected& selected) {
  if (!selected.needs.revise) return;
  services.shows_truth = !scenario.as_method_asks || selected.needs.targets == Needs::Targets::truth;
  Selected revised = selected;
  for (std::size_t c = 0; c < revised.instructions.size(); ++c) {
    Selection& selection = revised.instructions[c].selection;
    const Command command = scenario.command(static_cast<int>(c));
    selection = guarded(id, [&] { return method.revise(command, selection, demonstrations, services); });
    expect_usable(selection, scenario);
  }
  selected = std::move(revised);
  demonstrations = instructed(std::move(demonstrations), scenes, selected);
}

std::unique_ptr<Policy> learn(Method& method, const std::string& id, const std::vector<Demonstration>& demonstrations,
                              Services& services, Selected& selected) {
  const SelectionCost before = services.lm.cost();
  auto policy = guarded(id, [&] { return method.learn(demonstrations, services); });
  selected.instructions.front().selection.cost += services.lm.cost() - before;
  if (!policy) throw MethodError(fmt::format("plugin {}: learn returned no policy", id));
  return policy;
}

}  // namespace lgabench

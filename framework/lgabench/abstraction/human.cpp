#include <lgabench/abstraction/human.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/random.hpp>

namespace lgabench {

TruthAsHuman::TruthAsHuman(std::vector<ScenarioCommand> commands) : commands_(std::move(commands)) {}

const Selection& TruthAsHuman::truth_of(const Command& command) const {
  for (const ScenarioCommand& known : commands_)
    if (known.utterance == command.utterance) return known.truth;
  throw MethodError(fmt::format("human answers: expected a command of the scenario, got \"{}\"", command.utterance));
}

Selection TruthAsHuman::specify(const Command& command) { return truth_of(command); }

Selection TruthAsHuman::edit(const Command& command, const Selection& proposal) {
  const Selection& truth = truth_of(command);
  Selection edited = proposal;
  edited.target = with_each_set(truth.target, [&](const FeatureSet& set, std::size_t i) {
    const bool alike = proposal.target.sets.size() == truth.target.sets.size();
    return FeatureSet{set.object_types, alike ? proposal.target.sets[i].textures : set.textures};
  });
  if (edited.second && truth.second) edited.second->object_types = truth.second->object_types;
  edited.provenance = Provenance::simulated_edit;
  edited.source += ", object types corrected to the true ones";
  return edited;
}

bool TruthAsHuman::accepts(const Command& command, const std::string& object_type, const std::string& texture) {
  return truth_of(command).target.belongs(object_type, texture);
}

void DeclaredHuman::expect(const char* asks, const char* call) const {
  if (asks_ != asks)
    throw MethodError(fmt::format(
        "services.human.{}(): expected a method declared as LGABENCH_METHOD_ASKING(\"{}\", ...)", call, asks));
}

Selection DeclaredHuman::specify(const Command& command) {
  expect("specify", "specify");
  return who_->specify(command);
}

Selection DeclaredHuman::edit(const Command& command, const Selection& proposal) {
  expect("edit", "edit");
  return who_->edit(command, proposal);
}

bool DeclaredHuman::accepts(const Command& command, const std::string& object_type, const std::string& texture) {
  expect("accept", "accepts");
  return who_->accepts(command, object_type, texture);
}

std::vector<Placed> DeclaredHuman::scene(const Command& command, int scene) {
  expect("accept", "scene");
  return who_->scene(command, scene);
}

bool DeclaredHuman::takes(const Command& command, int scene, std::uint8_t instance) {
  expect("accept", "takes");
  return who_->takes(command, scene, instance);
}

std::optional<std::uint8_t> DeclaredHuman::which(const Command& command, int scene) {
  expect("accept", "which");
  return who_->which(command, scene);
}

AskedInScenes::AskedInScenes(const Scenario& scenario, int demonstrations, int most_questions,
                             std::function<std::vector<Placed>(int, int)> look)
    : TruthAsHuman(scenario.commands),
      scenes_(demonstrations + scenario.questions.value().scenes),
      most_(most_questions),
      errs_(scenario.questions->errs),
      utterances_(scenario.utterances()),
      look_(std::move(look)) {}

void AskedInScenes::spend(const Command& command, int price) {
  truth_of(command);  // or throws
  int& spent = spent_[command.utterance];
  if (spent + price > most_)
    throw MethodError(
        fmt::format("\"{}\": expected at most {} questions to a person (option questions; \"which of "
                    "these\" is {}), got {}",
                    command.utterance, most_, price_of_which, spent + price));
  spent += price;
}

std::vector<Placed> AskedInScenes::scene(const Command& command, int scene) {
  truth_of(command);
  if (scene < 0 || scene >= scenes_)
    throw MethodError(
        fmt::format("\"{}\": expected a scene that was demonstrated or may be asked about, 0 to {}, got {}",
                    command.utterance, scenes_ - 1, scene));
  const auto [at, first] = seen_.try_emplace({command.utterance, scene});
  if (first) {
    const auto number = std::find(utterances_.begin(), utterances_.end(), command.utterance) - utterances_.begin();
    at->second = look_(static_cast<int>(number), scene);
  }
  return at->second;
}

bool AskedInScenes::accepts(const Command& command, const std::string& object_type, const std::string& texture) {
  spend(command, 1);
  RandomStream stream(fmt::format("person/accepts/{}/{}/{}", command.utterance, object_type, texture));
  return TruthAsHuman::accepts(command, object_type, texture) != (stream.uniform() < errs_);
}

bool AskedInScenes::takes(const Command& command, int number, std::uint8_t instance) {
  const std::vector<Placed> visible = scene(command, number);
  const auto is_it = [instance](const Placed& one) {
    return one.instance.id == instance && !is_place(one.instance.object_type);
  };
  if (std::none_of(visible.begin(), visible.end(), is_it))
    throw MethodError(fmt::format("\"{}\", scene {}: expected an object that is in it, got instance {}",
                                  command.utterance, number, instance));
  spend(command, 1);
  const std::vector<std::uint8_t> taken = grounded(truth_of(command).target, visible);
  RandomStream stream(fmt::format("person/takes/{}/{}/{}", command.utterance, number, instance));
  return contains(taken, instance) != (stream.uniform() < errs_);
}

std::optional<std::uint8_t> AskedInScenes::which(const Command& command, int number) {
  const std::vector<Placed> visible = scene(command, number);
  spend(command, price_of_which);
  std::vector<std::optional<std::uint8_t>> answers{std::nullopt};
  for (const Placed& one : visible)
    if (!is_place(one.instance.object_type)) answers.emplace_back(one.instance.id);
  const std::vector<std::uint8_t> taken = grounded(truth_of(command).target, visible);
  RandomStream stream(fmt::format("person/which/{}/{}", command.utterance, number));
  const bool wrong = stream.uniform() < errs_;
  std::optional<std::uint8_t> answer;
  if (!taken.empty()) answer = taken[stream.below(static_cast<std::uint32_t>(taken.size()))];
  if (!wrong) return answer;
  answers.erase(std::find(answers.begin(), answers.end(), answer));
  return answers[stream.below(static_cast<std::uint32_t>(answers.size()))];
}

std::function<Selection(const Command&)> declared_truth(std::vector<ScenarioCommand> commands,
                                                        const std::string& asks) {
  return [who = TruthAsHuman(std::move(commands)), declared = asks == "truth"](const Command& command) mutable {
    if (!declared)
      throw MethodError("services.truth(): expected a method declared as LGABENCH_METHOD_ASKING(\"truth\", ...)");
    return who.specify(command);
  };
}

}  // namespace lgabench

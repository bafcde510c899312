#include <lgabench/abstraction/human.hpp>

#include <fmt/format.h>

#include <utility>

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
  if (edited.target.sets.size() != truth.target.sets.size()) edited.target.sets = truth.target.sets;
  for (std::size_t i = 0; i < truth.target.sets.size(); ++i)
    edited.target.sets[i].object_types = truth.target.sets[i].object_types;
  edited.target.which = truth.target.which;
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

std::function<Selection(const Command&)> declared_truth(std::vector<ScenarioCommand> commands,
                                                        const std::string& asks) {
  return [who = TruthAsHuman(std::move(commands)), declared = asks == "truth"](const Command& command) mutable {
    if (!declared)
      throw MethodError("services.truth(): expected a method declared as LGABENCH_METHOD_ASKING(\"truth\", ...)");
    return who.specify(command);
  };
}

}  // namespace lgabench

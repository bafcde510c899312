#include <lgabench/cell/selecting.hpp>

#include <algorithm>
#include <utility>

#include <lgabench/abstraction/quality.hpp>
#include <lgabench/abstraction/selection_errors.hpp>
#include <lgabench/core/environments.hpp>

namespace lgabench {

Selecting::Selecting(Method* method, const Scenario& scenario, const Cell& cell, Services& services)
    : scenario_(scenario), cell_(cell), current_(select(method, cell.method.id, scenario, services)) {
  for (const Instruction& instruction : current_.instructions) expect_usable(instruction.selection, scenario);
  initial_ = without_errors_ = current_.instructions;
  if (!current_.needs.revise) make_errors();
}

bool Selecting::is_attributable() const {
  return std::all_of(current_.instructions.begin(), current_.instructions.end(),
                     [](const Instruction& i) { return i.selection.provenance != Provenance::none; });
}

void Selecting::revise(Method& method, std::vector<Demonstration>& demonstrations, const std::vector<Scene>& scenes,
                       Services& services) {
  if (!current_.needs.revise) return;
  lgabench::revise(method, cell_.method.id, scenario_, demonstrations, scenes, services, current_);
  without_errors_ = current_.instructions;
  make_errors();
  demonstrations = instructed(std::move(demonstrations), scenes, current_);
}

std::unique_ptr<Policy> Selecting::learn(Method& method, const std::vector<Demonstration>& demonstrations,
                                         Services& services) {
  const std::string& learns = cell_.method.acts ? cell_.method.acts->id : cell_.method.id;
  return lgabench::learn(method, learns, demonstrations, services, current_);
}

void Selecting::make_errors() {
  const std::string goal = scenario_.environment->goal_type();
  for (std::size_t c = 0; c < current_.instructions.size(); ++c) {
    Selection& selection = current_.instructions[c].selection;
    selection = with_errors(std::move(selection), scenario_, static_cast<int>(c), cell_.selection_errors,
                            cell_.training_seed, goal);
  }
}

std::string Selecting::text() const {
  const Json shown =
      scenario_.environment->shown_members(scenario_, {cell_.layout, "train", "train", cell_.training_seed});
  Json commands = Json::array();
  for (std::size_t c = 0; c < scenario_.commands.size(); ++c) {
    const auto& [utterance, selection] = current_.instructions[c];
    const Json without_errors = distribution_json(without_errors_[c].selection);
    commands.push_back({{"utterance", utterance},
                        {"selection", to_json(selection)},
                        {"quality", to_json(quality(selection, scenario_.commands[c].truth))}});
    if (Json before = distribution_json(initial_[c].selection); before != without_errors)
      commands.back()["before_revision"] = std::move(before);
    if (!cell_.selection_errors.none() && selection.provenance != Provenance::none)
      commands.back()["before_errors"] = without_errors;
    if (!shown.is_null()) commands.back()["shown"] = shown.at(c);
  }
  return canonical({{"commands", commands}}) + '\n';
}

}  // namespace lgabench

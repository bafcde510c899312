// Steps of a cell (docs/architecture.md) that a run and `check-plugin` both take; evaluator.hpp has the fifth.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <lgabench/core/environment.hpp>
#include <lgabench/core/method.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/record/train_on.hpp>

namespace lgabench {

/// What a method wants to see, and what it selected.
struct Selected {
  Needs needs;
  std::vector<Instruction> instructions;  // for each command of the scenario

  /// Whether scenes of this command depend on a Selection that is empty: there is nothing to show or to keep.
  bool nothing_for(int command) const;
  /// Whether that is so of a command that is demonstrated: there is nothing to learn from.
  bool nothing_to_learn_from(const Scenario& scenario) const;
};

/// training.jsonl as it grows.
class TrainingLines : public TrainingLog {
 public:
  /// `counted(epochs)` after each line.
  explicit TrainingLines(std::function<void(int epochs)> counted = {}) : counted_(std::move(counted)) {}
  /// @throws MethodError for a value that is infinite or no number, for what else a report refuses to read
  /// (expect_training_line()), and for a curve's name that is none.
  void epoch(int epochs, long long steps, double loss) override;
  void curve(const std::string& name, double value) override;

  std::string lines;

 private:
  Json curves_ = Json::object();  // of the pass that epoch() ends
  std::function<void(int)> counted_;
};

/// 1 select: asks the method for each command of the scenario. A null `method` selects nothing and needs the truth.
/// What it throws is guarded() with `id`.
Selected select(Method* method, const std::string& id, const Scenario& scenario, Services& services);
/// A plugin may return anything; only names of the space can be shown and counted, only finite costs added up.
/// @throws MethodError
void expect_usable(const Selection& selection, const Scenario& scenario);

/// 2 sample: `count` scenes to demonstrate, with targets from the Selections or from the truth, as the method needs.
std::vector<Scene> sample(const Scenario& scenario, const std::string& layout, const Selected& selected,
                          std::uint64_t training_seed, int count);

/// 3 demonstrate: what the oracle `showed` in these scenes (demonstrations.hpp), with the method's own instructions.
std::vector<Demonstration> instructed(std::vector<Demonstration> showed, const std::vector<Scene>& scenes,
                                      const Selected& selected);

/// 3 demonstrate: what they show in these scenes as it is perceived through an axis. Its direction, and where none is
/// given its level, are drawn for each demonstration, from other streams than those of test scenes.
std::vector<Demonstration> perceived(std::vector<Demonstration> demonstrations, const std::vector<Scene>& scenes,
                                     const Scenario& scenario, const TrainOn& through);

/// 4 learn, first part: asks the method, where it needs to, for each command's Selection with what was shown; then the
/// demonstrations' instructions have it too. @throws as select(), and as expect_usable().
void revise(Method& method, const std::string& id, const Scenario& scenario, std::vector<Demonstration>& demonstrations,
            const std::vector<Scene>& scenes, Services& services, Selected& selected);

/// 4 learn: from observations and labels to a policy. What the method asks the language model meanwhile is added to the
/// cost of the first command's Selection. @throws MethodError where it returns no policy; else likewise.
std::unique_ptr<Policy> learn(Method& method, const std::string& id, const std::vector<Demonstration>& demonstrations,
                              Services& services, Selected& selected);

}  // namespace lgabench

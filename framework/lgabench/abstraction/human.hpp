// What a person would select, where no person was asked.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/language_model.hpp>
#include <lgabench/core/scenario.hpp>

namespace lgabench {

/// Answers with the true distribution: an upper bound, without human data or human seconds.
class TruthAsHuman : public HumanAnswers {
 public:
  /// `commands` of the scenario, with their truth.
  explicit TruthAsHuman(std::vector<ScenarioCommand> commands);

  /// The command's true distribution; provenance truth. @throws MethodError for a command that the scenario lacks.
  Selection specify(const Command& command) override;
  /// The proposal with its object types corrected to the true ones, its textures and its cost kept: the study's people
  /// mostly did that (docs/protocol.md, section 5). Provenance simulated_edit.
  Selection edit(const Command& command, const Selection& proposal) override;
  /// Whether the object belongs to the true distribution.
  bool accepts(const Command& command, const std::string& object_type, const std::string& texture) override;

 protected:
  const Selection& truth_of(const Command& command) const;

 private:
  std::vector<ScenarioCommand> commands_;
};

/// People of a scenario with "questions": the truth stands in for them, and errs as the scenario says, by a hash of the
/// command and the question. Each answers as many questions as the method's option says.
class AskedInScenes : public TruthAsHuman {
 public:
  /// So many of the command's scenes were demonstrated. `look` shows any of them, by command and scene.
  AskedInScenes(const Scenario& scenario, int demonstrations, int most_questions,
                std::function<std::vector<Placed>(int command, int scene)> look);

  bool accepts(const Command& command, const std::string& object_type, const std::string& texture) override;
  std::vector<Placed> scene(const Command& command, int scene) override;
  bool takes(const Command& command, int scene, std::uint8_t instance) override;
  std::optional<std::uint8_t> which(const Command& command, int scene) override;

 private:
  void spend(const Command& command, int price);

  int scenes_, most_;
  double errs_;
  std::vector<std::string> utterances_;
  std::function<std::vector<Placed>(int, int)> look_;
  std::map<std::pair<std::string, int>, std::vector<Placed>> seen_;
  std::map<std::string, int> spent_;  // by utterance
};

/// Answers only in the way that a method declares, so that the truth behind a stand-in reaches no other method.
class DeclaredHuman : public HumanAnswers {
 public:
  /// `asks` as in the plugin's descriptor: "specify", "edit", "accept", or anything else for none of them.
  DeclaredHuman(std::unique_ptr<HumanAnswers> who, std::string asks) : who_(std::move(who)), asks_(std::move(asks)) {}

  /// These @throw MethodError where the method declares something else.
  Selection specify(const Command& command) override;
  Selection edit(const Command& command, const Selection& proposal) override;
  bool accepts(const Command& command, const std::string& object_type, const std::string& texture) override;
  std::vector<Placed> scene(const Command& command, int scene) override;
  bool takes(const Command& command, int scene, std::uint8_t instance) override;
  std::optional<std::uint8_t> which(const Command& command, int scene) override;

 private:
  void expect(const char* asks, const char* call) const;

  std::unique_ptr<HumanAnswers> who_;
  std::string asks_;
};

/// What Services::truth is: the true distributions for a method that asks for the "truth", else what throws
/// MethodError.
std::function<Selection(const Command&)> declared_truth(std::vector<ScenarioCommand> commands, const std::string& asks);

}  // namespace lgabench

// Language models and people: who can be asked which features matter.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/selection.hpp>

namespace lgabench {

/// One yes/no question: could the target (or the second set) have this object type or texture?
struct Question {
  /// What is to be moved, or the task's second set (Command::second).
  enum class About { target, second } about = About::target;
  /// Which of an object's two features.
  enum class Group { object_type, texture } group = Group::object_type;
  std::string candidate;
};

/// A preference that a person may have and did not say: in words, and what they then take.
struct Hypothesis {
  std::string text;
  Meaning meaning;
  double weight = 1;  // how likely it is beside the others, above 0
};

/// Reads [{"text", "meaning", "weight"}, ...]: 1 to 50 of them, each text one line, a missing weight 1. @throws
/// InputError with file and place, as read_meaning().
std::vector<Hypothesis> read_hypotheses(const JsonReader& reader, const FeatureSpace& space);

/// A language model that answers for one command. One thread.
class LanguageModel {
 public:
  virtual ~LanguageModel() = default;

  /// Returns the answers in the order of the questions, true for yes. They are asked together so that a live model can
  /// work on several at once. @throws MethodError if an answer is missing or cut off: no answer is never a no.
  virtual std::vector<bool> answer(const Command& command, const FeatureSpace& space,
                                   const std::vector<Question>& questions) = 0;

  /// What the command means, in one answer: sets, and which of several objects. Empty where the model gave no meaning
  /// that can be read. @throws MethodError for a model that answers yes/no questions alone.
  virtual Meaning mean(const Command& command, const FeatureSpace& space);

  /// The unstated preferences that could explain why a person takes only some of the objects that the command's words
  /// mean, in one answer. Empty where there is no answer, or none that can be read. @throws as mean().
  virtual std::vector<Hypothesis> hypotheses(const Command& command, const FeatureSpace& space);

  /// The model's name, for Selection::source.
  virtual std::string model() const = 0;
  /// The wording that was answered, where it differs from the command's (recorded answers).
  virtual std::string asked_as(const Command& command) const { return command.utterance; }
  /// How the answers came about, for Selection::provenance.
  virtual Provenance provenance() const = 0;
  /// Cost of all answers so far.
  virtual SelectionCost cost() const = 0;
};

/// The number of yes/no questions that one which() counts as.
inline constexpr int price_of_which = 3;

/// A person's answers: Selections that they specify or edit, and objects that they would take. The true distribution
/// stands in for a person unless real answers are given.
class HumanAnswers {
 public:
  virtual ~HumanAnswers() = default;

  /// The Selection that the person specifies from scratch (the paper's Human condition).
  virtual Selection specify(const Command& command) = 0;
  /// The proposal as the person leaves it (the paper's LGA-HILL condition).
  virtual Selection edit(const Command& command, const Selection& proposal) = 0;
  /// Whether the person, shown one object, would take it for that command. @throws MethodError for people who are asked
  /// for Selections alone.
  virtual bool accepts(const Command& command, const std::string& object_type, const std::string& texture);
  /// The objects of a scene that a person may be asked about. Scenes count from 0: the command's demonstrated ones in
  /// their order, then some that nobody demonstrated. Looking costs nothing. This and the following @throw MethodError
  /// where the scenario has no "questions", for an unknown scene or object, and for more questions about a command than
  /// the method's option `questions` allows; accepts() and takes() count as one, which() as three.
  virtual std::vector<Placed> scene(const Command& command, int scene);
  /// Whether the person would take that object in that scene. A person errs at times, but always gives the same answer
  /// to the same question.
  virtual bool takes(const Command& command, int scene, std::uint8_t instance);
  /// Id of the object that the person would take in that scene, or none.
  virtual std::optional<std::uint8_t> which(const Command& command, int scene);
};

}  // namespace lgabench

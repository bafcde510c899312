// A language model's published answers, replayed.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/language_model.hpp>
#include <lgabench/core/scenario.hpp>

namespace lgabench {

/// The sources of recorded answers: the files of the data directory's answers/ and of its folders, without their
/// ending.
std::vector<std::string> recorded_sources();

/// The source that `answers` means for the scenario: one of recorded_sources(), or for "recorded" the scenario's own,
/// which differs for people to edit and for direct use.
std::string recorded_source(const Scenario& scenario, const std::string& answers, bool to_edit = false);

/// The answers to one command's questions.
struct RecordedAnswer {
  std::string space, scenario, asked_as;     // scenario: "" where the answers are those of the words alone
  FeatureSet target;                         // the candidates answered yes
  std::map<std::string, FeatureSet> second;  // likewise, by role
  std::optional<Meaning> structured;         // the command's meaning, given in one answer
  std::vector<Hypothesis> hypotheses;        // which unstated preferences it may have; mostly none were asked for
};
/// A file of recorded answers: one that is shipped, or that somebody wrote (docs/formats: recorded answers).
struct RecordedFile {
  std::string model;  // who answered
  std::vector<RecordedAnswer> answers;
};
/// @throws InputError with the file and the first place that is not as docs/formats says.
RecordedFile read_recorded(const std::filesystem::path& file);

/// One source's answers: a candidate is answered yes exactly if it is listed there. Costs one query a question, as the
/// live model did, and no seconds: none were published.
class RecordedLanguageModel : public LanguageModel {
 public:
  /// `scenario` is the id that answers are looked up by before the utterance, as some were asked in other words; "" if
  /// there is none. @throws InputError where `source` is none of recorded_sources(). Answers are looked up when they
  /// are asked for.
  RecordedLanguageModel(FeatureSpace space, std::string scenario, std::string source);
  /// A model of the answers in a file, which is read when they are asked for.
  static RecordedLanguageModel of_file(FeatureSpace space, std::string scenario, std::filesystem::path file);
  /// Knows the scenario's commands.
  RecordedLanguageModel(const Scenario& scenario, const std::string& source)
      : RecordedLanguageModel(scenario.space, scenario.answers_of, source) {}

  /// Whether anything is recorded for the command.
  bool knows(const Command& command) const { return find(command.utterance) != nullptr; }
  /// Whether what it means is recorded, which mean() returns.
  bool has_meaning(const Command& command) const;
  /// The scenarios, or the commands, that the source answers in this space.
  std::vector<std::string> known() const;

  /// @throws InputError where nothing is recorded for the command: says what is; MethodError for a candidate outside
  /// the space, or for a second set that the model was not asked about.
  std::vector<bool> answer(const Command& command, const FeatureSpace& space,
                           const std::vector<Question>& questions) override;
  /// @throws InputError as answer(), and where no meaning is recorded.
  Meaning mean(const Command& command, const FeatureSpace& space) override;
  /// Empty, at no cost, where none are recorded.
  std::vector<Hypothesis> hypotheses(const Command& command, const FeatureSpace& space) override;
  std::string model() const override { return model_; }
  std::string asked_as(const Command& command) const override;
  /// Always recorded.
  Provenance provenance() const override { return Provenance::recorded; }
  SelectionCost cost() const override { return cost_; }

 private:
  struct OfFile {};
  RecordedLanguageModel(OfFile, FeatureSpace space, std::string scenario, std::filesystem::path file);
  const RecordedAnswer* find(const std::string& utterance) const;
  const RecordedAnswer& expect(const std::string& utterance) const;
  void read() const;

  FeatureSpace space_;
  std::string scenario_;
  std::filesystem::path file_;
  mutable std::string model_;
  mutable std::vector<RecordedAnswer> all_;  // of the space; read once, by the first question
  mutable bool read_ = false;
  SelectionCost cost_;
};

}  // namespace lgabench

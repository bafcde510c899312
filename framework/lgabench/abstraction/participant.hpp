// What a person selected in a study, from their file (docs/formats: participant.schema.json).
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/language_model.hpp>
#include <lgabench/core/scenario.hpp>

namespace lgabench {

/// A participant's file, read and checked.
struct Participant {
  /// The answers to one command: a Selection made from scratch, and one that began as a language model's proposal.
  struct Answer {
    std::optional<Selection> specified, edited;  // provenance human, with seconds; distributions in the space's order
    Selection proposal;                          // what was edited
  };

  std::string id;          // a pseudonym
  std::string sha256;      // of the file
  bool rehearsal = false;  // made in a rehearsal or simulated: no person's answers
  std::map<std::pair<std::string, std::string>, Answer> answers;  // by scenario (its answers_of) and utterance

  /// nullptr where the participant was not asked.
  const Answer* find(const Scenario& scenario, const std::string& utterance) const;
  /// Whether the participant answered every command of the scenario so: &Answer::specified, from scratch, or
  /// &Answer::edited.
  bool answered_all(const Scenario& scenario, std::optional<Selection> Answer::*how) const;
};

/// @throws InputError with file and place: also for a command that no scenario has, and where consent was not given.
Participant read_participant(const std::filesystem::path& file);

/// One person's answers in place of the truth.
class ParticipantAsHuman : public HumanAnswers {
 public:
  /// Answers one scenario's commands.
  ParticipantAsHuman(Participant participant, Scenario scenario);

  /// @throws InputError where the participant was not asked.
  Selection specify(const Command& command) override;
  /// Costs what the proposal cost and the person's seconds. @throws InputError where the participant was not asked, or
  /// edited another proposal than this one: an edit says nothing about what the person would have made of it.
  Selection edit(const Command& command, const Selection& proposal) override;

 private:
  const Participant::Answer& answer(const Command& command) const;
  [[noreturn]] void refuse(const Command& command, const char* what) const;

  Participant participant_;
  Scenario scenario_;
};

}  // namespace lgabench

// Records what a method asked during one call, which tells the source of the Selection that it returns.
#pragma once
#include <exception>
#include <optional>
#include <string>

#include <lgabench/core/method.hpp>
#include <lgabench/host/frames.hpp>

namespace lgabench {

/// Answers the frames "ask" and "person" of one call with the host's services.
class AnswerLedger {
 public:
  /// Holds references.
  AnswerLedger(const FeatureSpace& space, Services& services);
  /// Begins with an answer from before the call: the Selection that the method revises. account() adds its cost too.
  AnswerLedger(const FeatureSpace& space, Services& services, const Selection& earlier);

  /// Answers on the channel; false for a frame that is no question. An exception of an answer is kept, and told to the
  /// method, which may go on. @throws InputError for a question that is malformed.
  bool answer(const Frame& frame, Channel& channel);
  /// Throws again what the last answer threw, if one did: then that is why the call failed.
  void rethrow() const;

  /// The Selection with provenance, source, wording and cost. These are those of the last answers that it equals; if it
  /// equals none, those of the last answers with ", edited by the method". If nobody was asked, the provenance is rule,
  /// or none for an empty Selection. If a person was shown objects, it is a simulated edit.
  Selection account(Selection selection) const;

 private:
  Json answer_questions(const JsonReader& reader);
  Json answer_in_one(const JsonReader& reader);
  Json signed_reply(const Command& command);
  Json ask_person(const JsonReader& reader);
  void suppose(const std::vector<Hypothesis>& hypotheses);
  void keep(Selection answered);

  const FeatureSpace& space_;
  Services& services_;
  SelectionCost before_, earlier_;
  int accepts_ = 0;  // objects that a person was shown
  std::exception_ptr failure_;
  Selection model_;                 // all that the language model said yes to
  std::vector<Selection> answers_;  // the model's and people's, the last one at the end
};

}  // namespace lgabench

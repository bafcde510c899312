// Members of a run's records that other records hold too, and forms of theirs (core/fields.hpp).
#pragma once
#include <array>

#include <lgabench/core/fields.hpp>
#include <lgabench/record/cell.hpp>

namespace lgabench {

void fields(ActingMethod& acts, Fields& field);
void fields(Cell& cell, Fields& field);
void fields(SelectionErrors& errors, Fields& field);
void visit(const Slot& slot, AnswerSource& source, const Form& form);
void visit(const Slot& slot, TestScenes& scenes, const Form& form);
void visit(const Slot& slot, TrainOn& through, const Form& form);

/// A Competitor's kind.
inline constexpr std::array competitor_kinds{"method", "reference"};

/// The form of Reading::segments.
inline Form segments_form(const Reading& reading) {
  static constexpr std::array words{Reading::simulator, Reading::difference};
  return one_of(words, when(reading.segments != Reading::simulator), "\"simulator\" or \"difference\"");
}

}  // namespace lgabench

// Selects without a language model: the names that stand in the command.
#pragma once
#include <lgabench/core/selection.hpp>

namespace lgabench {

/// The object types, and the textures, whose names stand in the utterance as words of it; all of them where none does.
/// What a language model must beat. Of the task's second set, where it has one, likewise.
Selection select_named(const Command& command, const FeatureSpace& space);

}  // namespace lgabench

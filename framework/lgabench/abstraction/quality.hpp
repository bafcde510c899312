// How well a Selection matches the true distribution.
#pragma once
#include <lgabench/core/selection.hpp>

namespace lgabench {

/// {"target": {"object_types": Q, "textures": Q}} and likewise the second set, under its role's id, with
/// Q = {"precision", "recall", "size", "true_size"}; a precision or recall over an empty set is null.
/// Null for a Selection of provenance none.
Json quality(const Selection& selection, const Selection& truth);

}  // namespace lgabench

// A Selection in words.
#pragma once
#include <string>

#include <lgabench/core/selection.hpp>

namespace lgabench {

/// "target: TYPES; TEXTURES", where there is a second set with ". ROLE: TYPES; TEXTURES" (sweep: ". avoid: ..."): names
/// in the order of the space, separated by commas; "any" for all of the space's, "none" for none (docs/protocol.md,
/// section 5: what LGA-L is told).
std::string selection_text(const Selection& selection, const FeatureSpace& space);

/// Why the Selection keeps no object in any scene: "the target has no texture", "avoid has no object type"; "" where it
/// may keep some, or nothing was selected.
std::string empty_text(const Selection& selection);

/// A meaning alone, in words as selection_text() has them.
std::string meaning_text(const Meaning& meaning, const FeatureSpace& space);

}  // namespace lgabench

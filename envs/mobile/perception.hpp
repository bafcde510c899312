// What a segmenter and a captioner would make of a picture: errors of the kinds that they make (docs/protocol.md,
// section 7). A model, whose numbers are assumed.
#pragma once
#include <lgabench/core/observation.hpp>
#include <lgabench/core/random.hpp>

namespace lgabench::mobile {

/// Two instances that touch become one segment with probability .1, with the caption of the larger; a segment is missed
/// with probability min(.5, 40 / its pixels); its border moves by -2 to 2 pixels; its caption is wrong with probability
/// `caption_error`: one of the type's likely confusions, or "an object". rgb stays. For equal streams what is wrong at
/// one probability is wrong, in the same way, at every higher one.
Observation perceive(Observation seen, double caption_error, RandomStream stream);

}  // namespace lgabench::mobile

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

/// perceive() in scenes of the task fetch, whose light is dim and coloured. The picture is dim and coloured too. A
/// caption's type is wrong with up to six times `caption_error`, the more the fewer pixels it has and the more of its
/// border lies on other things; its texture with up to three times that, the more the dimmer and the more coloured the
/// light is. A texture has no other word for what it cannot tell: it is right then.
Observation perceive_in_bad_light(Observation seen, double caption_error, RandomStream stream);

}  // namespace lgabench::mobile

// What a cloning policy read, as pictures for people. Private to learning/.
#pragma once
#include <lgabench/core/shown.hpp>
#include <lgabench/learning/cloning_options.hpp>
#include <lgabench/learning/featurizer.hpp>

namespace lgabench {

/// Shows the first row of `read`, which a Featurizer of these `inputs` wrote. `offered`: the method's inputs, of which
/// a policy of that kind takes those that it can use (inputs_of()).
Shown shown_input(const PolicyInputs& offered, const PolicyInputs& inputs, PolicyKind policy, const Samples& read);

}  // namespace lgabench

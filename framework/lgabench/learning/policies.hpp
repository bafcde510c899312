// The learners that the option `policy` chooses among. Private to learning/.
#pragma once
#include <memory>

#include <lgabench/learning/cloning_options.hpp>
#include <lgabench/learning/featurizer.hpp>
#include <lgabench/learning/learner.hpp>

namespace lgabench {

/// What a policy of that kind is shown of a method's `inputs`: of them those that it can use, at its sizes. `native`:
/// of the demonstrated pictures. @throws InputError where none is.
PolicyInputs inputs_of(PolicyKind policy, PolicyInputs inputs, PictureSize native);

/// The learner of that kind, untrained, for rows of those inputs. `options` as in Services, of which the regression
/// reads read_network_options(). @throws InputError for a shape that it cannot see.
std::unique_ptr<Learner> make_learner(PolicyKind policy, const SampleShape& shape, const Json& options,
                                      std::uint64_t seed);

}  // namespace lgabench

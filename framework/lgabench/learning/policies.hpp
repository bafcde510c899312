// The learners that the option `policy` chooses among. Private to learning/.
#pragma once
#include <memory>
#include <string>

#include <lgabench/core/json.hpp>
#include <lgabench/learning/featurizer.hpp>
#include <lgabench/learning/learner.hpp>

namespace lgabench {

/// What the learner named `policy` is shown of a method's `inputs`: of them those that it can use, at its sizes.
/// `native`: of the demonstrated pictures. @throws InputError where none is.
PolicyInputs inputs_of(const std::string& policy, PolicyInputs inputs, PictureSize native);

/// The learner of that name, untrained, for rows of those inputs. `options` as in Services: those of
/// LGABENCH_CLONING_OPTIONS. @throws InputError for an unknown name or a shape that it cannot see.
std::unique_ptr<Learner> make_learner(const std::string& policy, const SampleShape& shape, const JsonReader& options,
                                      std::uint64_t seed);

}  // namespace lgabench

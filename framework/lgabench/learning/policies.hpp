// The learners that the option `policy` chooses among. Private to learning/.
#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/json.hpp>
#include <lgabench/learning/featurizer.hpp>
#include <lgabench/learning/learner.hpp>

namespace lgabench {

/// What an option's value names. @throws InputError that lists the names: another one is never taken for a default.
template <class T>
T named(const JsonReader& option, const std::vector<std::pair<std::string, T>>& known) {
  const std::string word = option.string();
  std::string names;
  for (const auto& [name, value] : known) {
    if (name == word) return value;
    names += (names.empty() ? "" : ", ") + name;
  }
  option.fail("one of " + names);
}

/// What the learner named `policy` is shown of a method's `inputs`: of them those that it can use, at its sizes.
/// `native`: of the demonstrated pictures. @throws InputError where none is.
PolicyInputs inputs_of(const std::string& policy, PolicyInputs inputs, PictureSize native);

/// The learner of that name, untrained, for rows of those inputs. `options` as in Services: those of
/// LGABENCH_CLONING_OPTIONS. @throws InputError for an unknown name or a shape that it cannot see.
std::unique_ptr<Learner> make_learner(const std::string& policy, const SampleShape& shape, const JsonReader& options,
                                      std::uint64_t seed);

}  // namespace lgabench

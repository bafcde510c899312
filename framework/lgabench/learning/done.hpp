// When a policy says that nothing is left to do. Private to learning/.
#pragma once
#include <cstdint>
#include <vector>

#include <lgabench/learning/archive.hpp>
#include <lgabench/learning/learner.hpp>

namespace lgabench {

/// A mask that most rows of "done" show empty of a target says it: done is where it shows none. Elsewhere a logistic
/// regression on the features() of the trained learner says it, if that has any: both kinds of rows weigh alike, the
/// threshold is .5. A policy without either, or that was never shown "done", never says it.
class Done {
 public:
  /// Of a policy that was never shown it.
  Done() = default;
  /// `acting` and `done`: rows in which the oracle acted, and in which it said that nothing is left to do.
  Done(Learner& learner, const Samples& acting, const Samples& done);

  /// Whether it is said of the one row. @throws InputError where it was restored for rows of another shape.
  bool is_said(Learner& learner, const Samples& row) const;
  /// @throws InputError for what does not fit.
  void learned(Archive& archive);

 private:
  enum class How : std::uint8_t { never, empty_mask, logistic };

  How how_ = How::never;
  std::vector<double> weights_;  // of each feature; the last is the constant
};

}  // namespace lgabench

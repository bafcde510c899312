// The reference row that a learned policy must beat: one action, whatever is seen.
#pragma once
#include <lgabench/core/method.hpp>

namespace lgabench {

/// The medoid of the demonstrated actions on the true distribution: the label whose summed Euclidean distance to the
/// others, over all numbers, is least (the first of equals).
class ConstantAction : public Method {
 public:
  Needs needs(const Json&) const override { return {Needs::Targets::truth, 0, 0}; }
  Selection select(const Command&, const FeatureSpace&, Services&) override { return {}; }
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override;
};

}  // namespace lgabench

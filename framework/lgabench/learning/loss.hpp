// The distance between predicted and labelled actions: what training minimises.
#pragma once
#include <lgabench/core/action.hpp>

namespace lgabench {

/// Numbers of an action, as a network gives them.
constexpr int action_size = static_cast<int>(ActionVector().size());

/// norm: the un-squared L2 norm over the 12 raw outputs (the default). squared: its square (the paper's text).
enum class Loss { norm, squared };

/// Loss of one row of 12 outputs. Writes its gradient times `weight` to `gradient`; where the error is exactly 0, the
/// norm's subgradient 0.
double loss_and_gradient(Loss loss, const float* output, const float* label, double weight, float* gradient);

}  // namespace lgabench

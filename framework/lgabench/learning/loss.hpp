// The distance between predicted and labelled actions: what training minimises.
#pragma once
namespace lgabench {

/// norm: the un-squared L2 norm over the raw outputs (the default). squared: its square (the paper's text).
enum class Loss { norm, squared };

/// Loss of one row of `count` outputs. Writes its gradient times `weight` to `gradient`; where the error is exactly 0,
/// the norm's subgradient 0.
double loss_and_gradient(Loss loss, const float* output, const float* label, int count, double weight, float* gradient);

}  // namespace lgabench

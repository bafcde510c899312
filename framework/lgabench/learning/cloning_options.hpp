// What the framework's options say of a cloning method, read once. Private to learning/.
#pragma once
#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/learning/learner.hpp>
#include <lgabench/learning/loss.hpp>
#include <lgabench/learning/network_shape.hpp>

namespace lgabench {

/// What is trained, where a method has no learner of its own.
enum class PolicyKind { regression, centroid, heat_map };

/// Training options of every cloning method. What a descriptor lacks has the value that is here.
struct CloningOptions {
  TrainingOptions training;
  Instances instances = Instances::all;
  bool signed_mask = false;
  PolicyKind policy = PolicyKind::regression;
  bool points = false;  // policy=point: nothing is trained
};

/// Options of the paper's network. A learner of a method's own does not read them, and its descriptor may have others
/// of these names.
struct NetworkOptions {
  Architecture architecture;
  bool spot;  // the notebook's: a linear layer of 1000, actions scaled to their bounds
  Loss loss;
};

/// `options` as in Services. @throws InputError naming the option: a value that is none of those above is never taken
/// for a default, LGABENCH_TRAINING_OPTIONS cannot be lacking.
CloningOptions read_cloning_options(const Json& options);
/// Whether the picture is seen beside the goal mask, by the option `picture`. CloningMethod::inputs() alone asks.
/// @throws as read_cloning_options().
bool read_picture_option(const Json& options);
/// The options of the paper's network, none of which can be lacking. @throws as read_cloning_options().
NetworkOptions read_network_options(const Json& options);

}  // namespace lgabench

// Behaviour cloning, the learner of every shipped method: they differ in what the network sees and in who selects.
#pragma once
#include <vector>

#include <lgabench/core/method.hpp>

/// The options that every cloning method has, for its descriptor's JSON.
#define LGABENCH_CLONING_OPTIONS ""

namespace lgabench {

/// The pictures and the text that a policy is given. Each picture gets a tower of its own.
struct PolicyInputs {
  enum class Picture {
    mask,         // 1 channel: the goal mask of the instruction's Selection
    rgb,          // 3 channels
    segmentation  // 1 channel: 1 on any object
  };
  std::vector<Picture> pictures;
  bool utterance = false;  // the sentence embedding of the instruction's utterance
};

/// A subclass names its inputs and overrides select(), and needs() if it asks for more than demonstrations of its own
/// Selection's targets. One thread.
class CloningMethod : public Method {
 public:
  Needs needs(const Json&) const override { return {}; }
  /// Trains on every step of every demonstration. @throws InputError for an utterance without a sentence embedding.
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override;

 protected:
  /// `options` as in Services.
  virtual PolicyInputs inputs(const Json& options) const = 0;
};

}  // namespace lgabench

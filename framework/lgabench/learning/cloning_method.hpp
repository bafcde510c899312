// Behaviour cloning, the learner of every shipped method: they differ in what the network sees and in who selects.
#pragma once
#include <map>
#include <string>
#include <vector>

#include <lgabench/core/method.hpp>

/// Members of a descriptor's options that every cloning method has: LGABENCH_METHOD(..., "{" LGABENCH_CLONING_OPTIONS
/// "}").
#define LGABENCH_CLONING_OPTIONS                                                                                   \
  R"("epochs": {"default": 750, "min": 1, "help": "passes over the training data", "source": "paper, appendix"},)" \
  R"("batch_size": {"default": 10, "min": 1, "help": "samples a step", "source": "PROTOCOL, section 5"},)"         \
  R"("learning_rate": {"default": 0.001, "min": 0, "help": "of Adam", "source": "PROTOCOL, section 5"},)"          \
  R"("loss": {"default": "norm", "values": ["norm", "squared"], "help": "L2 norm of the error, or its square",)"   \
  R"("source": "norm: released code; squared: paper"},)"                                                           \
  R"("batches": {"default": "shuffled", "values": ["shuffled", "drawn"],)"                                         \
  R"("help": "each sample once a pass, or each batch drawn with replacement",)"                                    \
  R"("source": "drawn: released code"},)"                                                                          \
  R"("network": {"default": "text", "values": ["text", "released", "plain"],)"                                     \
  R"("help": "batch normalisation before each ReLU, after it, or none",)"                                          \
  R"("source": "text: paper, appendix; released: released code"})"

/// One more, of methods that see the goal mask alone unless it is asked for: options as in Services say whether the
/// picture has a tower beside the mask's.
#define LGABENCH_PICTURE_OPTION                                                                       \
  R"("picture": {"default": "none", "values": ["none", "rgb"], "help": "seen beside the goal mask",)" \
  R"("source": "rgb: paper, appendix"})"

namespace lgabench {

/// The pictures and the text that a policy is given. Each picture gets a tower of its own.
struct PolicyInputs {
  /// One channel-first picture of 36 x 72.
  enum class Picture {
    mask,         // 1 channel: the goal mask of the instruction's Selection, or of that in `masks`
    rgb,          // 3 channels
    segmentation  // 1 channel: 1 on any object
  };
  std::vector<Picture> pictures;
  /// One sentence embedding of 384 numbers.
  enum class Text {
    none,
    utterance,  // the sentence embedding of the instruction's utterance
    selection   // that of its Selection in words (selection_text) in `space`
  } text = Text::none;
  FeatureSpace space{};  // for Text::selection alone
  /// Utterance -> the Selection that its mask is made of in place of the instruction's. Empty, or with every utterance
  /// that will be given. Held by value: the policy keeps it when the method is gone.
  std::map<std::string, Selection> masks{};
};

/// A subclass overrides select(), inputs() if its network sees more or other things than the goal mask, and needs() if
/// it asks for more than demonstrations of its own Selection's targets. One thread.
class CloningMethod : public Method {
 public:
  Needs needs(const Json&) const override { return {}; }
  /// Trains on every step of every demonstration. @throws InputError for a text without a sentence embedding,
  /// where the encoder's weights are not there.
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override;

 protected:
  /// What the network sees; the goal mask, and the picture where the method has the option `picture` and it says so,
  /// unless a subclass says otherwise. `options` as in Services.
  virtual PolicyInputs inputs(const Json& options) const;
};

}  // namespace lgabench

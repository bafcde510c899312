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
  R"("batch_size": {"default": 10, "min": 1, "help": "samples a step", "source": "docs/protocol.md, section 5"},)" \
  R"("learning_rate": {"default": 0.001, "min": 0, "help": "of Adam", "source": "docs/protocol.md, section 5"},)"  \
  R"("loss": {"default": "norm", "values": ["norm", "squared"], "help": "L2 norm of the error, or its square",)"   \
  R"("source": "norm: released code; squared: paper"},)"                                                           \
  R"("batches": {"default": "drawn", "values": ["drawn", "shuffled"],)"                                            \
  R"("help": "each batch drawn with replacement, or each sample once a pass",)"                                    \
  R"("source": "drawn: released code"},)"                                                                          \
  R"("network": {"default": "text", "values": ["text", "released", "plain"],)"                                     \
  R"("help": "batch normalisation before each ReLU, after it, or none",)"                                          \
  R"("source": "text: paper, appendix; released: released code"})"

/// One more, of methods that see the goal mask alone unless it is asked for: options as in Services say whether the
/// picture has a tower beside the mask's.
#define LGABENCH_PICTURE_OPTION                                                                       \
  R"("picture": {"default": "none", "values": ["none", "rgb"], "help": "seen beside the goal mask",)" \
  R"("source": "rgb: paper, appendix"})"

/// Those of a method whose policy sees a goal mask, beside the former.
#define LGABENCH_MASK_OPTIONS                                                                                    \
  R"("instances": {"default": "all", "values": ["all", "first"], )"                                              \
  R"("help": "of several visible instances that match one role: all in the mask, or the first, row by row",)"    \
  R"("source": "all: docs/protocol.md; first: paper, section 3.2, 'an unambiguous abstract state'"},)"           \
  R"("policy": {"default": "regression", "values": ["regression", "centroid"], )"                                \
  R"("help": "a network; or, untrained, the centroid of the target set's own plane, an input that the network )" \
  R"(lacks, and the demonstrations' means: other options of training and pictures do nothing then",)"            \
  R"("source": "regression: paper; centroid: not the paper's"})"

/// Those of a method whose policy sees none, in their place: it says why it lacks them.
#define LGABENCH_NO_MASK_OPTIONS                                      \
  R"("policy": {"default": "regression", "values": ["regression"], )" \
  R"("help": "centroid needs a goal mask, which this method lacks", "source": "regression: paper"})"

namespace lgabench {

struct NetworkShape;
struct Samples;

/// The pictures and the text that a policy is given. Each picture gets a tower of its own.
struct PolicyInputs {
  /// One channel-first picture of 36 x 72.
  enum class Picture {
    mask,         // 1 channel: the goal mask of the instruction's Selection, or of that in `masks`
    rgb,          // 3 channels
    segmentation  // 1 channel: 1 on any object but those of the type `left_out`
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
  std::string left_out{};  // "": nothing
};

/// A subclass overrides select(), inputs() if its network sees more or other things than the goal mask, and needs() if
/// it asks for more than demonstrations of its own Selection's targets. One thread.
class CloningMethod : public Method {
 public:
  Needs needs(const Json&) const override { return {}; }
  /// Trains on every step of every demonstration, or fits the CentroidRule where the option `policy` says so. The
  /// policy tells whether an input, to the byte, stood in training (of the centroid: a picture of roles). @throws
  /// InputError for a text without a sentence embedding, where the encoder's weights are not there; for policy=centroid
  /// without a mask among inputs().
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override;

 protected:
  /// What the network sees; the goal mask, and the picture where the method has the option `picture` and it says so,
  /// unless a subclass says otherwise. `options` as in Services.
  virtual PolicyInputs inputs(const Json& options) const;
  /// What the network of that shape is trained on, made of `clean`: a row for each step of each demonstration, in their
  /// order. Those rows alone unless a subclass adds others.
  virtual Samples training_rows(Samples clean, const NetworkShape& shape, const Services& services) const;
};

}  // namespace lgabench

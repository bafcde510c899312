// From observations and instructions to the rows that a learner sees.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/core/method.hpp>
#include <lgabench/learning/samples.hpp>

namespace lgabench {

class SentenceEmbeddings;

/// Whether an observation was demonstrated, or is acted on.
enum class Phase { training, test };

/// The pictures and the text that a learner is given.
struct PolicyInputs {
  enum class Picture {
    mask,          // 1 channel: the goal mask of the instruction's Selection, or of that in `masks`
    rgb,           // 3 channels
    segmentation,  // 1 channel: 1 on any object but those of the type `left_out`
    instances      // 1 channel: the id of the instance in the pixel's middle, 0 for none; for a learner of one's own
  };
  std::vector<Picture> pictures;
  /// One sentence embedding of 384 numbers.
  enum class Text {
    none,
    utterance,  // the sentence embedding of the instruction's utterance
    selection   // the sentence embedding of its Selection in words (selection_text) in `space`
  } text = Text::none;
  FeatureSpace space{};  // for Text::selection alone
  /// For each utterance, the Selection that the mask is made of in place of the instruction's. It is empty or has every
  /// utterance that will be given. It is held by value: the policy keeps it when the method is gone.
  std::map<std::string, Selection> masks{};
  std::string left_out{};  // an object type that `segmentation` leaves out; "": none

  Instances instances = Instances::all;
  /// If true, the goal mask is 1 on the target alone and -1 where an object is to be avoided and not the target. If
  /// false, it is 1 on both.
  bool signed_mask = false;
  PictureSize mask_size = input_size, rgb_size = input_size;
  /// Makes the observation that all of the above is made of, given the seen one and the mask's Selection. It must be a
  /// function of its arguments alone and refer to no method, which may be gone. Null: the seen observation is used.
  std::function<Observation(const Observation&, const Selection&, Phase)> prepare{};
  /// Whether `prepare` depends on the demonstrations. A saved policy does not hold these, so such a policy cannot be
  /// saved.
  bool of_demonstrations = false;
};

/// One thread. Copies share the sentence embeddings.
class Featurizer {
 public:
  /// `actions` and `state` are those of Services. This and write() @throw InputError for a text without a sentence
  /// embedding if the encoder's weights are missing.
  Featurizer(PolicyInputs inputs, ActionSpace actions, std::vector<StateNumber> state = {});

  SampleShape shape() const;
  /// Alters a copy of a step, given the Selection that its mask is made of. `row` is the number of the unaltered row
  /// that was copied; copies count from 0.
  using Augment = std::function<void(Step&, const Selection&, int row, int copy)>;

  /// Makes a row with its label for each step of each demonstration, in their order: of its episode, then of its
  /// recovery. A step whose label says that nothing is left to do is a row of Samples::stops, and has no copy. Behind
  /// them, copy by copy, come as many rows for each copy.
  Samples samples(const std::vector<Demonstration>& demonstrations, int copies = 0, const Augment& augment = {});
  /// Writes the inputs of one row; its label stays. After its first call it allocates nothing, unless `prepare` does.
  /// @throws MethodError for an utterance that `masks` lacks, InputError for a picture whose pixels do not fit its
  /// size, or a state of another length.
  void write(const Observation& observation, const Instruction& instruction, Phase phase, Samples& samples, int row);

 private:
  const Selection& mask_selection(const Instruction& instruction) const;
  void write_state(const Observation& observation, Samples& samples, int row) const;
  void write_pictures(const Observation& observation, const Selection& selection, Samples& samples, int row);

  PolicyInputs inputs_;
  ActionSpace actions_;
  std::vector<StateNumber> state_;
  std::shared_ptr<SentenceEmbeddings> embeddings_;  // null without a text
  std::vector<std::uint8_t> mask_;
};

}  // namespace lgabench

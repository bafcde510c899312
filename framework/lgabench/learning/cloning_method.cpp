#include <lgabench/learning/cloning_method.hpp>

#include <algorithm>
#include <memory>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/abstraction/selection_text.hpp>
#include <lgabench/learning/sentence_embeddings.hpp>
#include <lgabench/learning/training.hpp>

namespace lgabench {
namespace {

using Picture = PolicyInputs::Picture;

// Turns observations and instructions into the network's rows.
class Featurizer {
 public:
  explicit Featurizer(PolicyInputs inputs) : inputs_(std::move(inputs)) {
    if (has_text()) embeddings_ = std::make_shared<SentenceEmbeddings>();
  }

  NetworkShape shape(Architecture architecture) const {
    NetworkShape shape;
    for (const Picture picture : inputs_.pictures) shape.channels.push_back(picture == Picture::rgb ? 3 : 1);
    shape.text = has_text();
    shape.architecture = architecture;
    return shape;
  }

  void write(const Observation& observation, const Instruction& instruction, Samples& samples, int row) {
    for (std::size_t i = 0; i < inputs_.pictures.size(); ++i) {
      const Picture picture = inputs_.pictures[i];
      float* const out = samples.pictures[i].data() + row * (picture == Picture::rgb ? 3 : 1) * input_pixels;
      if (picture == Picture::rgb) {
        shrink_rgb(observation.rgb, out);
        continue;
      }
      if (picture == Picture::mask)
        goal_mask(observation, mask_selection(instruction), mask_);
      else
        object_mask(observation, mask_);
      shrink_mask(mask_, out);
    }
    if (has_text()) {
      const std::vector<float>& embedding = embeddings_->of(inputs_.text == PolicyInputs::Text::utterance
                                                                ? instruction.utterance
                                                                : selection_text(instruction.selection, inputs_.space));
      std::copy(embedding.begin(), embedding.end(), samples.text.begin() + row * text_size);
    }
  }

 private:
  bool has_text() const { return inputs_.text != PolicyInputs::Text::none; }

  const Selection& mask_selection(const Instruction& instruction) const {
    if (inputs_.masks.empty()) return instruction.selection;
    const auto found = inputs_.masks.find(instruction.utterance);
    if (found == inputs_.masks.end()) throw MethodError("no mask was selected for: " + instruction.utterance);
    return found->second;
  }

  PolicyInputs inputs_;
  std::shared_ptr<SentenceEmbeddings> embeddings_;
  std::vector<std::uint8_t> mask_;
};

class CloningPolicy : public Policy {
 public:
  CloningPolicy(Featurizer featurizer, const NetworkShape& shape, std::uint64_t seed)
      : network(shape, seed), featurizer_(std::move(featurizer)), input_(shape, 1) {}

  Action act(const Observation& observation, const Instruction& instruction) override {
    featurizer_.write(observation, instruction, input_, 0);
    const std::vector<float>& output = network.predict(input_);
    ActionVector action;
    std::copy_n(output.begin(), action.size(), action.begin());
    return from_vector(action);
  }

  Network network;

 private:
  Featurizer featurizer_;
  Samples input_;
};

Architecture architecture_of(const std::string& network) {
  if (network == "plain") return Architecture::plain;
  return network == "released" ? Architecture::released : Architecture::text;
}

}  // namespace

PolicyInputs CloningMethod::inputs(const Json& options) const {
  PolicyInputs inputs{{Picture::mask}};
  if (options.value("picture", "none") == "rgb") inputs.pictures.push_back(Picture::rgb);
  return inputs;
}

std::unique_ptr<Policy> CloningMethod::learn(const std::vector<Demonstration>& demonstrations, Services& services) {
  const JsonReader options(services.options, "options");
  TrainingOptions training;
  training.epochs = static_cast<int>(options.at("epochs").integer(1, 1'000'000));
  training.batch_size = static_cast<int>(options.at("batch_size").integer(1, 1'000'000));
  training.learning_rate = options.at("learning_rate").number();
  training.loss = options.at("loss").string() == "squared" ? Loss::squared : Loss::norm;

  training.batches = options.at("batches").string() == "drawn" ? Batches::drawn : Batches::shuffled;

  Featurizer featurizer(inputs(services.options));
  const NetworkShape shape = featurizer.shape(architecture_of(options.at("network").string()));
  int rows = 0;
  for (const Demonstration& demonstration : demonstrations) rows += static_cast<int>(demonstration.steps.size());
  Samples samples(shape, rows);
  int row = 0;
  for (const Demonstration& demonstration : demonstrations)
    for (const Step& step : demonstration.steps) {
      featurizer.write(step.observation, demonstration.instruction, samples, row);
      const ActionVector label = to_vector(step.label);
      std::copy(label.begin(), label.end(), samples.labels.begin() + row * action_size);
      ++row;
    }

  // `plain` keeps the bits that earlier versions gave it.
  if (shape.architecture != Architecture::plain) samples.find_usual();

  auto policy = std::make_unique<CloningPolicy>(featurizer, shape, services.seed);
  train(policy->network, samples, training, services.seed, services.log);
  return policy;
}

}  // namespace lgabench

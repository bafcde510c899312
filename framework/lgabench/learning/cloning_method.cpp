#include <lgabench/learning/cloning_method.hpp>

#include <algorithm>
#include <cstring>
#include <memory>

#include <lgabench/abstraction/goal_mask.hpp>
#include <lgabench/abstraction/selection_text.hpp>
#include <lgabench/learning/centroid_policy.hpp>
#include <lgabench/learning/sentence_embeddings.hpp>
#include <lgabench/learning/training.hpp>

namespace lgabench {
namespace {

using Picture = PolicyInputs::Picture;

// Turns observations and instructions into the network's rows.
class Featurizer {
 public:
  Featurizer(PolicyInputs inputs, Instances instances) : inputs_(std::move(inputs)), instances_(instances) {
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
        goal_mask(observation, mask_selection(instruction), mask_, instances_);
      else
        object_mask(observation, mask_, inputs_.left_out);
      shrink_mask(mask_, out);
    }
    if (has_text()) {
      const std::vector<float>& embedding = embeddings_->of(inputs_.text == PolicyInputs::Text::utterance
                                                                ? instruction.utterance
                                                                : selection_text(instruction.selection, inputs_.space));
      std::copy(embedding.begin(), embedding.end(), samples.text.begin() + row * text_size);
    }
  }

  // For the CentroidRule, which sees a single mask: the first. Valid until the next call.
  const std::vector<std::uint8_t>& roles(const Observation& observation, const Instruction& instruction) {
    const auto mask = std::find_if(inputs_.pictures.begin(), inputs_.pictures.end(),
                                   [](Picture picture) { return picture != Picture::rgb; });
    if (mask == inputs_.pictures.end()) throw InputError("options: /policy: centroid needs a mask among the inputs");
    if (*mask == Picture::mask)
      role_mask(observation, mask_selection(instruction), mask_, instances_);
    else
      object_mask(observation, mask_, inputs_.left_out);
    return mask_;
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
  Instances instances_;
  std::shared_ptr<SentenceEmbeddings> embeddings_;
  std::vector<std::uint8_t> mask_;
};

// 64 bits of the bytes; by words, since every act() hashes its input.
std::uint64_t hash_of(const void* bytes, std::size_t size, std::uint64_t hash) {
  for (std::size_t at = 0; at < size; at += sizeof hash) {
    std::uint64_t word = 0;
    std::memcpy(&word, static_cast<const char*>(bytes) + at, std::min(sizeof word, size - at));
    hash = (hash ^ word) * 0x9e3779b97f4a7c15ULL;
    hash ^= hash >> 32;
  }
  return hash;
}

std::uint64_t hash_of(const Samples& samples, int row) {
  std::uint64_t hash = 0;
  const auto add = [&](const std::vector<float>& values) {
    const std::size_t count = values.size() / static_cast<std::size_t>(samples.rows);
    hash = hash_of(values.data() + static_cast<std::size_t>(row) * count, count * sizeof(float), hash);
  };
  for (const auto& picture : samples.pictures) add(picture);
  add(samples.text);
  return hash;
}

std::uint64_t hash_of(const std::vector<std::uint8_t>& mask) { return hash_of(mask.data(), mask.size(), 0); }

// Hashes of the inputs that a policy learned from, and whether the last one that it acted on is one of them.
class SeenInputs {
 public:
  void learn(std::uint64_t input) { learned_.insert(std::lower_bound(learned_.begin(), learned_.end(), input), input); }
  void meet(std::uint64_t input) { last_ = std::binary_search(learned_.begin(), learned_.end(), input); }
  std::optional<bool> last() const { return last_; }

 private:
  std::vector<std::uint64_t> learned_;  // ascending
  std::optional<bool> last_;
};

class CentroidPolicy : public Policy {
 public:
  CentroidPolicy(Featurizer featurizer, const std::vector<Demonstration>& demonstrations)
      : featurizer_(std::move(featurizer)) {
    for (const Demonstration& demonstration : demonstrations)
      for (const Step& step : demonstration.steps) {
        const auto& roles = featurizer_.roles(step.observation, demonstration.instruction);
        seen_.learn(hash_of(roles));
        rule_.add(roles, step.label);
      }
    rule_.fit();
  }

  Action act(const Observation& observation, const Instruction& instruction) override {
    const auto& roles = featurizer_.roles(observation, instruction);
    seen_.meet(hash_of(roles));
    return rule_.act(roles);
  }
  std::optional<bool> seen_in_training() const override { return seen_.last(); }

 private:
  Featurizer featurizer_;
  CentroidRule rule_;
  SeenInputs seen_;
};

class CloningPolicy : public Policy {
 public:
  CloningPolicy(Featurizer featurizer, const NetworkShape& shape, std::uint64_t seed)
      : network(shape, seed), featurizer_(std::move(featurizer)), input_(shape, 1) {}

  Action act(const Observation& observation, const Instruction& instruction) override {
    featurizer_.write(observation, instruction, input_, 0);
    seen.meet(hash_of(input_, 0));
    const std::vector<float>& output = network.predict(input_);
    ActionVector action;
    std::copy_n(output.begin(), action.size(), action.begin());
    return from_vector(action);
  }

  std::optional<bool> seen_in_training() const override { return seen.last(); }

  Network network;
  SeenInputs seen;

 private:
  Featurizer featurizer_;
  Samples input_;
};

Architecture architecture_of(const std::string& network) {
  if (network == "plain") return Architecture::plain;
  return network == "released" ? Architecture::released : Architecture::text;
}

}  // namespace

Samples CloningMethod::training_rows(Samples clean, const NetworkShape&, const Services&) const { return clean; }

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

  // A method without a mask, or not of this library, may lack both options.
  const auto chosen = [&options](const char* name, const char* value) {
    return options.has(name) && options.at(name).string() == value;
  };
  Featurizer featurizer(inputs(services.options), chosen("instances", "first") ? Instances::first : Instances::all);
  if (chosen("policy", "centroid")) return std::make_unique<CentroidPolicy>(std::move(featurizer), demonstrations);
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

  auto policy = std::make_unique<CloningPolicy>(featurizer, shape, services.seed);
  Samples shown = training_rows(std::move(samples), shape, services);
  // `plain` keeps the bits that earlier versions gave it.
  if (shape.architecture != Architecture::plain) shown.find_usual();
  for (int i = 0; i < shown.rows; ++i) policy->seen.learn(hash_of(shown, i));
  train(policy->network, shown, training, services.seed, services.log);
  return policy;
}

}  // namespace lgabench

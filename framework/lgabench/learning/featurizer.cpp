#include <lgabench/learning/featurizer.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/abstraction/selection_text.hpp>
#include <lgabench/learning/sentence_embeddings.hpp>

namespace lgabench {

using Picture = PolicyInputs::Picture;

Featurizer::Featurizer(PolicyInputs inputs, ActionSpace actions, std::vector<StateNumber> state)
    : inputs_(std::move(inputs)), actions_(std::move(actions)), state_(std::move(state)) {
  if (inputs_.text != PolicyInputs::Text::none) embeddings_ = std::make_shared<SentenceEmbeddings>();
}

SampleShape Featurizer::shape() const {
  SampleShape shape{{}, inputs_.text != PolicyInputs::Text::none, actions_, state_};
  for (const Picture picture : inputs_.pictures)
    shape.pictures.push_back(picture == Picture::rgb ? SampleShape::Picture{inputs_.rgb_size, 3}
                                                     : SampleShape::Picture{inputs_.mask_size, 1});
  return shape;
}

Samples Featurizer::samples(const std::vector<Demonstration>& demonstrations, int copies, const Augment& augment) {
  const auto for_each = [&](bool stops, const auto& call) {
    for (const Demonstration& demonstration : demonstrations)
      for_each_step(demonstration, [&](const Step& step) {
        if (step.label.empty() == stops) call(step, demonstration.instruction);
      });
  };
  const auto for_each_row = [&](const auto& call) { for_each(false, call); };
  int unaltered = 0, stopped = 0;
  for_each_row([&](const Step&, const Instruction&) { ++unaltered; });
  for_each(true, [&](const Step&, const Instruction&) { ++stopped; });
  Samples samples(shape(), unaltered * (1 + copies));
  samples.unaltered = unaltered;
  auto label = samples.labels.begin();
  const auto add = [&](const Step& step, const Instruction& instruction, int row) {
    write(step.observation, instruction, Phase::training, samples, row);
    label = std::transform(step.label.begin(), step.label.end(), label,
                           [](double value) { return static_cast<float>(value); });
  };
  int row = 0;
  for_each_row([&](const Step& step, const Instruction& instruction) { add(step, instruction, row++); });
  for (int copy = 0; copy < copies; ++copy) {
    int of = 0;
    for_each_row([&](Step step, const Instruction& instruction) {
      augment(step, mask_selection(instruction), of++, copy);
      add(step, instruction, row++);
    });
  }
  if (stopped > 0) {
    auto stops = std::make_shared<Samples>(shape(), stopped);
    int of = 0;
    for_each(true, [&](const Step& step, const Instruction& instruction) {
      write(step.observation, instruction, Phase::training, *stops, of++);
    });
    samples.stops = std::move(stops);
  }
  return samples;
}

void Featurizer::write(const Observation& observation, const Instruction& instruction, Phase phase, Samples& samples,
                       int row) {
  const Selection& selection = mask_selection(instruction);
  if (inputs_.prepare)
    write_pictures(inputs_.prepare(observation, selection, phase), selection, samples, row);
  else
    write_pictures(observation, selection, samples, row);
  write_state(observation, samples, row);
  if (!embeddings_) return;
  const std::vector<float>& embedding = embeddings_->of(inputs_.text == PolicyInputs::Text::utterance
                                                            ? instruction.utterance
                                                            : selection_text(instruction.selection, inputs_.space));
  std::copy(embedding.begin(), embedding.end(), samples.text.begin() + std::ptrdiff_t{row} * text_size);
}

void Featurizer::write_state(const Observation& observation, Samples& samples, int row) const {
  if (observation.state.size() != state_.size())
    throw InputError(
        fmt::format("observation: state: expected {} values, got {}", state_.size(), observation.state.size()));
  float* out = samples.state.data() + static_cast<std::size_t>(row) * state_.size();
  for (std::size_t i = 0; i < state_.size(); ++i) {
    const StateNumber& number = state_[i];
    *out++ = static_cast<float>((2 * observation.state[i] - number.low - number.high) / (number.high - number.low));
  }
}

void Featurizer::write_pictures(const Observation& observation, const Selection& selection, Samples& samples, int row) {
  for (std::size_t i = 0; i < inputs_.pictures.size(); ++i) {
    const Picture picture = inputs_.pictures[i];
    float* const out = samples.picture(i, row);
    if (picture == Picture::rgb) {
      shrink_rgb(observation.rgb, observation.size, inputs_.rgb_size, out);
      continue;
    }
    if (picture == Picture::instances) {
      shrink_ids(observation.ids, observation.size, inputs_.mask_size, out);
      continue;
    }
    if (picture == Picture::segmentation)
      object_mask(observation, mask_, inputs_.left_out);
    else if (inputs_.signed_mask)
      role_mask(observation, selection, mask_, inputs_.instances);
    else
      goal_mask(observation, selection, mask_, inputs_.instances);
    shrink_mask(mask_, observation.size, inputs_.mask_size, out);
  }
}

const Selection& Featurizer::mask_selection(const Instruction& instruction) const {
  if (inputs_.masks.empty()) return instruction.selection;
  const auto found = inputs_.masks.find(instruction.utterance);
  if (found == inputs_.masks.end()) throw MethodError("no mask was selected for: " + instruction.utterance);
  return found->second;
}

}  // namespace lgabench

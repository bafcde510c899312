#include <lgabench/learning/cloning_method.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include <lgabench/learning/done.hpp>
#include <lgabench/learning/pointing.hpp>
#include <lgabench/learning/policies.hpp>
#include <lgabench/learning/shown_input.hpp>
#include <lgabench/learning/training.hpp>

namespace lgabench {
namespace {

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
  add(samples.state);
  return hash;
}

// Hashes of the inputs that a policy learned from, and whether the last one that it acted on is one of them.
class SeenInputs {
 public:
  void learn(std::uint64_t input) { learned_.insert(std::lower_bound(learned_.begin(), learned_.end(), input), input); }
  void meet(std::uint64_t input) { last_ = std::binary_search(learned_.begin(), learned_.end(), input); }
  std::optional<bool> last() const { return last_; }
  void learned(Archive& archive) { archive(learned_); }

 private:
  std::vector<std::uint64_t> learned_;  // ascending
  std::optional<bool> last_;
};

// What a restored policy cannot know from its options.
struct SavedInputs {
  static constexpr int longest_side = 4096;  // of a picture, in pixels

  PictureSize native{};
  FeatureSpace space{};

  void learned(Archive& archive) {
    archive(native);
    for (const int side : {native.rows, native.columns})
      if (side < 1 || side > longest_side) Archive::fail();
    archive(space.id);
    archive(space.object_types);
    archive(space.textures);
  }
};

class CloningPolicy : public Policy {
 public:
  /// Of the `offered` inputs a policy of that kind takes `inputs`.
  CloningPolicy(PictureSize native, PolicyInputs offered, PolicyInputs inputs, PolicyKind kind, Featurizer featurizer,
                std::unique_ptr<Learner> learner)
      : native_(native),
        offered_(std::move(offered)),
        inputs_(std::move(inputs)),
        kind_(kind),
        featurizer_(std::move(featurizer)),
        learner_(std::move(learner)),
        input_(featurizer_.shape(), 1) {}

  /// Remembers which inputs it learned from.
  void learned_from(const Samples& shown) {
    for (int row = 0; row < shown.rows; ++row) seen_.learn(hash_of(shown, row));
    if (shown.stops) learned_from(*shown.stops);
  }

  Action act(const Observation& observation, const Instruction& instruction) override {
    featurizer_.write(observation, instruction, Phase::test, input_, 0);
    seen_.meet(hash_of(input_, 0));
    if (done_ && done_->is_said(*learner_, input_)) return {};
    const std::vector<float>& predicted = learner_->predict(input_);
    return {predicted.begin(), predicted.end()};
  }

  /// Where it may say that nothing is left to do: when it does.
  void may_stop(Done done) { done_ = std::move(done); }
  Learner& trained() { return *learner_; }

  std::optional<bool> seen_in_training() const override { return seen_.last(); }
  Shown shown() const override { return shown_input(offered_, inputs_, kind_, input_); }
  std::optional<std::string> saved() const override {
    // What was selected, and what was shown, is no part of what is saved.
    if (!offered_.masks.empty() || offered_.of_demonstrations) return std::nullopt;
    Archive archive;
    SavedInputs inputs{native_, offered_.space};
    inputs.learned(archive);
    SeenInputs seen = seen_;
    seen.learned(archive);
    if (!learner_->learned(archive)) return std::nullopt;
    if (Done done = done_.value_or(Done()); done_) done.learned(archive);
    return archive.bytes();
  }
  /// What saved() wrote behind the inputs.
  void restore(Archive& archive) {
    seen_.learned(archive);
    if (!learner_->learned(archive)) throw MethodError("a policy of this network cannot be restored");
    if (done_) done_->learned(archive);
    archive.expect_end();
  }

 private:
  PictureSize native_;
  PolicyInputs offered_, inputs_;
  PolicyKind kind_;
  Featurizer featurizer_;
  std::unique_ptr<Learner> learner_;
  SeenInputs seen_;
  std::optional<Done> done_;
  Samples input_;
};

PictureSize picture_size(const std::vector<Demonstration>& demonstrations) {
  for (const Demonstration& demonstration : demonstrations)
    for (const Step& step : demonstration.steps) return step.observation.size;
  throw MethodError("training: expected at least one demonstration, got none");
}

PolicyInputs offered_by(PolicyInputs inputs, const CloningOptions& options) {
  if (options.instances == Instances::first) inputs.instances = options.instances;
  if (options.signed_mask) inputs.signed_mask = true;
  return inputs;
}

}  // namespace

PolicyInputs CloningMethod::inputs(const Json& options) const {
  PolicyInputs inputs{{PolicyInputs::Picture::mask}};
  if (read_picture_option(options)) inputs.pictures.push_back(PolicyInputs::Picture::rgb);
  return inputs;
}

int CloningMethod::copies(const Json&) const { return 0; }

void CloningMethod::augment(Step&, const Selection&, int, RandomStream&) const {}

Samples CloningMethod::training_rows(Samples clean, const Services&) const { return clean; }

std::unique_ptr<Learner> CloningMethod::learner(const SampleShape& shape, const Services& services) const {
  return make_learner(read_cloning_options(services.options).policy, shape, services.options, services.seed);
}

std::unique_ptr<Policy> CloningMethod::learn(const std::vector<Demonstration>& demonstrations, Services& services) {
  const CloningOptions options = read_cloning_options(services.options);
  if (options.points) return pointing_policy(services.actions, services.may_stop);
  PolicyInputs offered = offered_by(inputs(services.options), options);
  const PictureSize native = picture_size(demonstrations);
  PolicyInputs seen = inputs_of(options.policy, offered, native);
  Featurizer featurizer(seen, services.actions, services.state);
  const auto change = [&](Step& step, const Selection& selection, int row, int copy) {
    RandomStream stream(fmt::format("learning/augment/{}/{}/{}", services.seed, row, copy));
    augment(step, selection, copy, stream);
  };
  const Samples samples = training_rows(featurizer.samples(demonstrations, copies(services.options), change), services);
  std::unique_ptr<Learner> trained = learner(samples.shape, services);
  train(*trained, samples, options.training, services.seed, services.log);
  auto policy = std::make_unique<CloningPolicy>(native, std::move(offered), std::move(seen), options.policy,
                                                std::move(featurizer), std::move(trained));
  policy->learned_from(samples);
  if (services.may_stop) policy->may_stop(samples.stops ? Done(policy->trained(), samples, *samples.stops) : Done());
  return policy;
}

std::unique_ptr<Policy> CloningMethod::restore(const std::string& saved, Services& services) {
  const CloningOptions options = read_cloning_options(services.options);
  Archive archive(saved);
  SavedInputs saved_inputs;
  saved_inputs.learned(archive);
  PolicyInputs offered = offered_by(inputs(services.options), options);
  offered.space = saved_inputs.space;
  PolicyInputs seen = inputs_of(options.policy, offered, saved_inputs.native);
  Featurizer featurizer(seen, services.actions, services.state);
  std::unique_ptr<Learner> untrained = learner(featurizer.shape(), services);
  auto policy = std::make_unique<CloningPolicy>(saved_inputs.native, std::move(offered), std::move(seen),
                                                options.policy, std::move(featurizer), std::move(untrained));
  if (services.may_stop) policy->may_stop(Done());
  policy->restore(archive);
  return policy;
}

}  // namespace lgabench

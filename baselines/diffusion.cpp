// LGA with a modern learner: what is selected is shown to a policy that denoises an action, step by step, where a heat
// map answers at once. After Diffusion Policy (Chi et al., RSS 2023, arXiv 2303.04137) with the deterministic steps of
// DDIM (Song et al., ICLR 2021) and, as in Act3D (2306.17817), the picture's features at the place that is being
// denoised: one action in place of a sequence, a small encoder that is trained from nothing.
#include <algorithm>
#include <cmath>

#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/learning/torch_learner.hpp>
#include <lgabench/plugin/plugin.hpp>

namespace {

using namespace lgabench;
namespace nn = torch::nn;

constexpr int levels = 100, denoising_steps = 10;  // of noise; of DDIM
constexpr int batch_size = 16, noises = 8;         // noisy actions of each row in a batch
constexpr double learning_rate = 1e-3;
constexpr std::int64_t channels = 32, time_features = 16, hidden = 256, text_features = 32;

// Numbers of an action as they are denoised: within -1 and 1, a turn as sine and cosine, those alone that training
// varies.
class Coding {
 public:
  explicit Coding(ActionSpace space) : space_(std::move(space)) {}

  void learn(const std::vector<Action>& labels) {
    std::vector<std::vector<double>> all;
    for (const Action& label : labels) all.push_back(whole(label));
    mean_.assign(all[0].size(), 0);
    for (std::size_t k = 0; k < mean_.size(); ++k) {
      double low = all[0][k], high = low;
      for (const auto& one : all) {
        mean_[k] += one[k] / static_cast<double>(all.size());
        low = std::min(low, one[k]);
        high = std::max(high, one[k]);
      }
      if (high - low > 1e-4) varies_.push_back(k);
    }
    if (varies_.empty()) varies_.push_back(0);
  }
  std::size_t size() const { return varies_.size(); }

  std::vector<float> coded(const Action& action) const {
    const std::vector<double> all = whole(action);
    std::vector<float> some;
    for (const std::size_t k : varies_) some.push_back(static_cast<float>(all[k]));
    return some;
  }
  Action decoded(const float* some) const {
    std::vector<double> all = mean_;
    for (std::size_t i = 0; i < varies_.size(); ++i) all[varies_[i]] = some[i];
    Action action(space_.size());
    std::size_t at = 0;
    for (std::size_t i = 0; i < space_.size(); ++i) {
      if (is_turn(i)) continue;
      const ActionNumber& number = space_.numbers[i];
      action[i] = (number.low + number.high + all[at++] * (number.high - number.low)) / 2;
    }
    for (const auto& turn : space_.rotations) {
      const double angle = std::atan2(all[at], all[at + 1]);
      at += 2;
      if (turn.size() == 2) {
        action[turn[0]] = std::cos(angle);
        action[turn[1]] = std::sin(angle);
      } else
        action[turn[2]] = std::sin(angle / 2),
        action[turn[3]] = std::cos(angle / 2);  // about z, which all tasks turn about
    }
    return action;
  }
  // Where among the denoised numbers those are that make up a place; none for a place that is copied.
  std::vector<std::pair<int, int>> places() const {
    std::vector<std::pair<int, int>> found;
    for (const PicturePlace& place : space_.places) {
      const int down = index_of(place.down), across = index_of(place.across);
      if (down >= 0 && across >= 0) found.emplace_back(down, across);
    }
    return found;
  }

 private:
  bool is_turn(std::size_t number) const {
    return std::any_of(space_.rotations.begin(), space_.rotations.end(),
                       [number](const auto& turn) { return lgabench::contains(turn, number); });
  }
  std::vector<double> whole(const Action& action) const {
    std::vector<double> all;
    for (std::size_t i = 0; i < space_.size(); ++i) {
      const ActionNumber& number = space_.numbers[i];
      if (!is_turn(i)) all.push_back((2 * action[i] - number.low - number.high) / (number.high - number.low));
    }
    for (const auto& turn : space_.rotations) {
      const double angle = turn.size() == 2 ? std::atan2(action[turn[1]], action[turn[0]])
                                            : 2 * std::atan2(action[turn[2]], action[turn[3]]);
      all.push_back(std::sin(angle));
      all.push_back(std::cos(angle));
    }
    return all;
  }
  int index_of(std::size_t number) const {
    std::size_t at = 0;
    for (std::size_t i = 0; i < number; ++i) at += !is_turn(i);
    const auto found = std::find(varies_.begin(), varies_.end(), at);
    return found == varies_.end() ? -1 : static_cast<int>(found - varies_.begin());
  }

  ActionSpace space_;
  std::vector<double> mean_;
  std::vector<std::size_t> varies_;
};

// Share of the action that is left at a level of noise (Nichol and Dhariwal 2021, cosine).
double left_at(int level) {
  const double angle = (level / static_cast<double>(levels) + .008) / 1.008 * pi / 2;
  return std::clamp(std::cos(angle) * std::cos(angle), 1e-4, 1.);
}

class Denoiser : public TorchTrained {
 public:
  Denoiser(const SampleShape& shape, int updates, std::uint64_t seed)
      : TorchTrained(seed),
        shape_(shape),
        updates_(updates),
        coding_(shape.actions),
        random_("diffusion/" + std::to_string(seed)) {
    for (const SampleShape::Picture& picture : shape.pictures) planes_ += picture.channels;
    const auto convolution = [](std::int64_t in, std::int64_t out, std::int64_t kernel, std::int64_t stride) {
      return nn::Conv2d(nn::Conv2dOptions(in, out, kernel).stride(stride).padding(kernel / 2));
    };
    encoder_ =
        nn::Sequential(convolution(planes_, channels / 2, 5, 1), nn::ReLU(), convolution(channels / 2, channels, 3, 2),
                       nn::ReLU(), convolution(channels, channels, 3, 1), nn::ReLU());
  }

  TrainingOptions schedule(const TrainingOptions&, int samples) const override {
    const int batches = samples / std::min(batch_size, samples);
    return {(updates_ + batches - 1) / batches, batch_size, learning_rate, Batches::shuffled, true};
  }

  void begin(const Samples& samples) override {
    std::vector<Action> labels;
    for (int row = 0; row < samples.rows; ++row) labels.push_back(samples.label(row));
    coding_.learn(labels);
    numbers_ = static_cast<std::int64_t>(coding_.size());
    std::vector<float> coded;
    for (const Action& label : labels) {
      const std::vector<float> one = coding_.coded(label);
      coded.insert(coded.end(), one.begin(), one.end());
    }
    actions_ = torch::tensor(coded).view({samples.rows, numbers_});
    places_ = coding_.places();
    if (shape_.text) text_ = nn::Linear(text_size, text_features);
    const std::int64_t seen = numbers_ + time_features + 2 * channels +
                              channels * static_cast<std::int64_t>(places_.size()) + (shape_.text ? text_features : 0);
    head_ = nn::Sequential(nn::Linear(seen, hidden), nn::ReLU(), nn::Linear(hidden, hidden), nn::ReLU(),
                           nn::Linear(hidden, numbers_));
    std::vector<torch::Tensor> all = encoder_->parameters();
    for (const torch::Tensor& p : head_->parameters()) all.push_back(p);
    if (shape_.text)
      for (const torch::Tensor& p : text_->parameters()) all.push_back(p);
    train(std::move(all));
  }

  const std::vector<float>& predict(const Samples& samples) override {
    const torch::NoGradGuard no_gradients;
    predicted_.clear();
    for (int row = 0; row < samples.rows; ++row) {
      const View view = look(samples, {row});
      RandomStream same("diffusion/act");  // of every scene: an action is a function of its picture
      std::vector<float> noise;
      for (std::int64_t k = 0; k < numbers_; ++k) noise.push_back(static_cast<float>(same.gaussian()));
      torch::Tensor noisy = torch::tensor(noise).view({1, numbers_});
      for (int step = denoising_steps; step > 0; --step) {
        const int level = step * levels / denoising_steps, next = (step - 1) * levels / denoising_steps;
        const torch::Tensor clean = denoised(view, noisy, {level}).clamp(-1.5, 1.5);
        const double left = left_at(level), left_next = next == 0 ? 1 : left_at(next);
        const torch::Tensor error = (noisy - std::sqrt(left) * clean) / std::sqrt(1 - left);
        noisy = std::sqrt(left_next) * clean + std::sqrt(1 - left_next) * error;
      }
      const Action action = coding_.decoded(noisy.contiguous().data_ptr<float>());
      for (const double value : action) predicted_.push_back(static_cast<float>(value));
    }
    return predicted_;
  }

  // Of `noises` noisy actions of each row, how far the denoised ones are from the demonstrated.
  double backward(const Samples& samples, const std::vector<int>& batch) override {
    const View view = look(samples, batch).repeated(noises);
    const auto rows = static_cast<std::int64_t>(batch.size()) * noises;
    const torch::Tensor wanted =
        actions_.index_select(0, torch::tensor(at::ArrayRef<int>(batch))).repeat_interleave(noises, 0);
    std::vector<int> at_level;
    std::vector<float> noise, kept, added;
    for (std::int64_t i = 0; i < rows; ++i) {
      at_level.push_back(1 + static_cast<int>(random_.below(levels)));
      const double left = left_at(at_level.back());
      kept.push_back(static_cast<float>(std::sqrt(left)));
      added.push_back(static_cast<float>(std::sqrt(1 - left)));
      for (std::int64_t k = 0; k < numbers_; ++k) noise.push_back(static_cast<float>(random_.gaussian()));
    }
    const torch::Tensor noisy = torch::tensor(kept).view({rows, 1}) * wanted +
                                torch::tensor(added).view({rows, 1}) * torch::tensor(noise).view({rows, numbers_});
    return descend((denoised(view, noisy, at_level) - wanted).square().mean());
  }

 private:
  // What a picture looks like: a map of features, where each of them is on average, and the words.
  struct View {
    torch::Tensor map, middles, words;
    View repeated(std::int64_t times) const {
      return {map.repeat_interleave(times, 0), middles.repeat_interleave(times, 0),
              words.defined() ? words.repeat_interleave(times, 0) : words};
    }
  };

  View look(const Samples& samples, const std::vector<int>& rows) {
    std::vector<torch::Tensor> pictures;
    const auto count = static_cast<std::int64_t>(rows.size());
    for (std::size_t i = 0; i < shape_.pictures.size(); ++i) {
      const auto& [size, depth] = shape_.pictures[i];
      torch::Tensor picture = torch::empty({count, size.rows, size.columns, depth});
      for (std::int64_t k = 0; k < count; ++k)
        std::copy_n(samples.picture(i, rows[static_cast<std::size_t>(k)]), shape_.pictures[i].numbers(),
                    picture.data_ptr<float>() + k * shape_.pictures[i].numbers());
      pictures.push_back(picture.permute({0, 3, 1, 2}));
    }
    View view;
    view.map = encoder_->forward(torch::cat(pictures, 1));
    const std::int64_t down = view.map.size(2), across = view.map.size(3);
    const torch::Tensor weights = torch::softmax(view.map.flatten(2), 2).view_as(view.map);
    const auto ramp = [](std::int64_t n) { return (torch::arange(n).to(torch::kFloat) * 2 + 1) / n - 1; };
    view.middles = torch::cat({(weights.sum(3) * ramp(down)).sum(2), (weights.sum(2) * ramp(across)).sum(2)}, 1);
    if (shape_.text) {
      torch::Tensor text = torch::empty({count, text_size});
      for (std::int64_t k = 0; k < count; ++k)
        std::copy_n(samples.text.data() + std::ptrdiff_t{rows[static_cast<std::size_t>(k)]} * text_size, text_size,
                    text.data_ptr<float>() + k * text_size);
      view.words = text_->forward(text);
    }
    return view;
  }

  torch::Tensor denoised(const View& view, const torch::Tensor& noisy, const std::vector<int>& at_level) {
    std::vector<float> times;
    for (const int level : at_level)
      for (std::int64_t k = 0; k < time_features / 2; ++k) {
        const double angle = level * std::pow(10, -static_cast<double>(k) / 2);
        times.push_back(static_cast<float>(std::sin(angle)));
        times.push_back(static_cast<float>(std::cos(angle)));
      }
    std::vector<torch::Tensor> seen{noisy, torch::tensor(times).view({noisy.size(0), time_features}), view.middles};
    for (const auto& [down, across] : places_) {
      const torch::Tensor place = torch::stack({noisy.select(1, across), noisy.select(1, down)}, 1).clamp(-1, 1);
      const auto options = nn::functional::GridSampleFuncOptions().mode(torch::kBilinear).align_corners(false);
      seen.push_back(
          nn::functional::grid_sample(view.map, place.view({-1, 1, 1, 2}), options).flatten(1));  // x across, y down
    }
    if (view.words.defined()) seen.push_back(view.words);
    return head_->forward(torch::cat(seen, 1));
  }

  SampleShape shape_;
  int updates_;
  Coding coding_;
  RandomStream random_;
  std::int64_t planes_ = 0, numbers_ = 0;
  std::vector<std::pair<int, int>> places_;
  nn::Sequential encoder_, head_{};
  nn::Linear text_{nullptr};
  torch::Tensor actions_;  // as they are denoised
  std::vector<float> predicted_;
};

class Diffusion : public CloningMethod {
 public:
  Selection select(const Command& command, const FeatureSpace& space, Services& services) override {
    return select_as_asked(command, space, services);
  }

 protected:
  PolicyInputs inputs(const Json& options) const override {
    using Inputs = PolicyInputs;
    const std::string input = options.at("input");
    PolicyInputs inputs{{Inputs::Picture::mask}};
    if (input == "rgb") inputs = {{Inputs::Picture::rgb}, Inputs::Text::utterance};
    if (input == "object_mask") {
      inputs = {{Inputs::Picture::segmentation}};
      inputs.left_out = "pallet";
    }
    inputs.signed_mask = true;
    inputs.mask_size = inputs.rgb_size = {32, 64};
    return inputs;
  }
  std::unique_ptr<Learner> learner(const SampleShape& shape, const Services& services) const override {
    return std::make_unique<Denoiser>(shape, services.options.at("updates").get<int>(), services.seed);
  }
};

}  // namespace

LGABENCH_METHOD("diffusion", "0.1", "LGA with a policy that denoises an action (Diffusion Policy, DDIM)", Diffusion,
                "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_TRAINING_OPTIONS R"(,
  "input": {"default": "mask", "values": ["mask", "object_mask", "rgb"],
            "help": "what the policy sees: the goal mask, a mask of any object but the pallet, or picture and command", "source": "ours"},
  "updates": {"default": 1200, "min": 1, "max": 1000000, "help": "optimiser steps of up to 16 demonstrated steps, each with 8 noisy actions", "source": "ours: 40 seconds of a core"}})")

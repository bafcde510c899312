#include <lgabench/learning/network.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <numeric>

#include <lgabench/core/error.hpp>
#include <lgabench/core/flush_denormals.hpp>
#include <lgabench/learning/head.hpp>
#include <lgabench/learning/parameters.hpp>
#include <lgabench/learning/tower.hpp>

namespace lgabench {

SampleShape NetworkShape::samples() const {
  SampleShape shape{{}, text};
  shape.state.resize(size(state));
  shape.actions.numbers.resize(size(actions));
  for (const int of_picture : channels) shape.pictures.push_back({input_size, of_picture});
  return shape;
}

struct Network::Impl {
  const Loss loss;
  const Kernels& kernels;
  const bool finds_usual;
  const bool has_text;
  const int actions, state_numbers;
  Parameters parameters;
  std::vector<Tower> towers;
  std::optional<Head> head;
  // What most of each tower's pictures share in training, 0 before begin(); and, acting, 0.
  std::vector<std::vector<float>> usual, nothing;
  // Room for one batch:
  int capacity = 0;
  Numbers text, state, output_gradients;
  std::vector<std::vector<const float*>> pictures;  // of each tower, for each row
  std::vector<const float*> features;               // of each tower; the text; the state
  std::vector<float*> feature_gradients;            // of each tower; null for the others
  std::vector<int> every_row;                       // of predict()
  std::vector<float> predicted;

  Impl(const NetworkShape& shape, std::uint64_t seed, Loss minimised, const Kernels& used)
      : loss(minimised),
        kernels(used),
        finds_usual(shape.architecture != Architecture::plain),
        has_text(shape.text),
        actions(shape.actions),
        state_numbers(shape.state),
        parameters(seed),
        pictures(shape.channels.size()) {
    if (actions < 1 || actions > padded_action)
      throw InputError(
          fmt::format("actions: expected 1 to {} numbers for the network, got {}", padded_action, actions));
    if (state_numbers > padded_state)
      throw InputError(
          fmt::format("state: expected {} numbers at most for the network, got {}", padded_state, state_numbers));
    for (const int channels : shape.channels) {
      towers.emplace_back(channels, shape.architecture, parameters, kernels);
      usual.emplace_back(size(channels * input_pixels));
    }
    nothing = usual;
    head.emplace(shape, parameters, kernels);
    parameters.finish();
    features.resize(towers.size() + (has_text ? 1 : 0) + (state_numbers > 0 ? 1 : 0));
    feature_gradients.resize(features.size());
  }

  void make_room(int rows) {
    if (rows <= capacity) return;
    for (Tower& tower : towers) tower.make_room(rows);
    head->make_room(rows);
    if (has_text) text = Numbers(size(rows * text_size));
    if (state_numbers > 0) state = Numbers(size(rows * padded_state));
    output_gradients = Numbers(size(rows * padded_action));
    for (auto& of_tower : pictures) of_tower.reserve(size(rows));
    capacity = rows;
  }

  // The batch's outputs, rows x padded_action.
  const float* forward(const Samples& samples, const std::vector<int>& batch, bool training) {
    const int rows = static_cast<int>(batch.size());
    make_room(rows);
    for (std::size_t t = 0; t < towers.size(); ++t) {
      pictures[t].clear();
      for (const int row : batch) pictures[t].push_back(samples.picture(t, row));
      features[t] = towers[t].forward(pictures[t], (training ? usual : nothing)[t].data(), training);
    }
    if (has_text) {
      for (int row = 0; row < rows; ++row)
        std::copy_n(samples.text.data() + size(batch[size(row)]) * text_size, text_size, text + row * text_size);
      features[towers.size()] = text;
    }
    if (state_numbers > 0) {
      for (int row = 0; row < rows; ++row)
        std::copy_n(samples.state.data() + batch[size(row)] * state_numbers, state_numbers, state + row * padded_state);
      features.back() = state;
    }
    return head->forward(features, rows);
  }

  void backward() {
    for (std::size_t t = 0; t < towers.size(); ++t) feature_gradients[t] = towers[t].feature_gradients();
    head->backward(features, output_gradients, feature_gradients);
    for (std::size_t t = 0; t < towers.size(); ++t) towers[t].backward(pictures[t]);
  }
};

Network::Network(const NetworkShape& shape, std::uint64_t seed, Loss loss, const Kernels& kernels) {
  flush_denormals();
  impl_ = std::make_unique<Impl>(shape, seed, loss, kernels);
}

Network::~Network() = default;

std::vector<float> Network::parameters() const { return impl_->parameters.values(); }
std::vector<float> Network::gradients() const { return impl_->parameters.gradients(); }
void Network::set_parameters(const std::vector<float>& parameters) { impl_->parameters.set(parameters); }

void Network::begin(const Samples& samples) {
  if (!impl_->finds_usual) return;
  for (std::size_t t = 0; t < impl_->usual.size(); ++t) impl_->usual[t] = usual_picture(samples, t);
}

const std::vector<float>& Network::predict(const Samples& samples) {
  impl_->every_row.resize(size(samples.rows));
  std::iota(impl_->every_row.begin(), impl_->every_row.end(), 0);
  const float* outputs = impl_->forward(samples, impl_->every_row, false);
  impl_->predicted.clear();
  for (int row = 0; row < samples.rows; ++row, outputs += padded_action)
    impl_->predicted.insert(impl_->predicted.end(), outputs, outputs + impl_->actions);
  return impl_->predicted;
}

std::vector<float> Network::features(const Samples& samples) {
  std::vector<float> all;
  const auto add = [&all](const float* numbers, int count) { all.insert(all.end(), numbers, numbers + count); };
  for (int row = 0; row < samples.rows; ++row) {
    impl_->forward(samples, {row}, false);
    for (std::size_t t = 0; t < impl_->towers.size(); ++t) add(impl_->features[t], tower_features);
    if (impl_->has_text) add(impl_->text, text_size);
    if (impl_->state_numbers > 0) add(impl_->state, impl_->state_numbers);
  }
  return all;
}

double Network::backward(const Samples& samples, const std::vector<int>& batch) {
  const float* const outputs = impl_->forward(samples, batch, true);
  const int rows = static_cast<int>(batch.size());
  double total = 0;
  for (int row = 0; row < rows; ++row)
    total += loss_and_gradient(impl_->loss, outputs + row * padded_action,
                               samples.labels.data() + size(batch[size(row)] * impl_->actions), impl_->actions,
                               1. / rows, impl_->output_gradients + row * padded_action);
  impl_->backward();
  return total / rows;
}

void Network::update(double learning_rate) { impl_->parameters.update(impl_->kernels, learning_rate); }

bool Network::learned(Archive& archive) {
  impl_->parameters.learned(archive);
  for (Tower& tower : impl_->towers) tower.learned(archive);
  return true;
}

}  // namespace lgabench

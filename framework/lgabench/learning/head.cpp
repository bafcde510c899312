#include <lgabench/learning/head.hpp>

#include <algorithm>
#include <cmath>

namespace lgabench {

Head::Head(const NetworkShape& shape, Parameters& parameters, const Kernels& kernels)
    : architecture_(shape.architecture), parameters_(parameters), kernels_(kernels) {
  const bool deep = architecture_ == Architecture::released && shape.text;
  const std::size_t towers = shape.channels.size();
  inputs_.resize(towers + (shape.text ? 1 : 0) + (shape.state > 0 ? 1 : 0));
  const auto is_state = [&](std::size_t i) { return shape.state > 0 && i + 1 == inputs_.size(); };
  const auto is_text = [&](std::size_t i) { return i == towers && !is_state(i); };
  const auto is_wide = [&](std::size_t i) { return shape.wide && i < towers; };
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if (deep == is_text(i) && !is_wide(i) && !is_state(i)) continue;  // the towers have one, or the text has
    Input& input = inputs_[i];
    const LayerKind kind = is_wide(i)    ? wide_linear
                           : is_state(i) ? state_linear
                           : is_text(i)  ? text_linear
                                         : tower_linear;
    input.linear.emplace(kind, parameters, kernels);
    input.linear_bias = parameters.take(input.linear->outputs());
    name({&*input.linear}, is_wide(i) ? wide_features : hidden_features, input.linear_bias);
  }
  std::vector<const Linear*> shares;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const LayerKind kind = deep                        ? (is_text(i) ? text_linear : features_linear)
                           : is_text(i) || is_state(i) ? text_head
                           : is_wide(i)                ? wide_head
                                                       : tower_head;
    shares.push_back(&inputs_[i].share.emplace(kind, parameters, kernels));
  }
  joined_bias_ = parameters.take(deep ? padded_hidden : padded_action);
  name(shares, deep ? hidden_features : shape.actions, joined_bias_);
  if (!deep) return;
  last_.emplace(text_head, parameters, kernels);
  last_bias_ = parameters.take(padded_action);
  name({&*last_}, shape.actions, last_bias_);
}

void Head::name(const std::vector<const Linear*>& side_by_side, int outs, std::size_t bias) {
  std::vector<std::size_t> weights, biases;
  for (int out = 0; out < outs; ++out) {
    for (const Linear* linear : side_by_side) {
      const std::vector<std::size_t> places = linear->places(out);
      weights.insert(weights.end(), places.begin(), places.end());
    }
    biases.push_back(bias + size(out));
  }
  const int fan_in = static_cast<int>(weights.size()) / outs;
  const double bound = 1 / std::sqrt(fan_in);
  if (architecture_ == Architecture::released) {
    parameters_.orthogonal(weights, outs, fan_in);
    parameters_.uniform(biases, 0, 0);
  } else {
    parameters_.uniform(weights, -bound, bound);
    parameters_.uniform(biases, -bound, bound);
  }
}

void Head::make_room(int rows) {
  for (Input& input : inputs_)
    if (input.linear)
      for (Numbers* array : {&input.made, &input.gradients}) *array = Numbers(size(rows * input.linear->outputs()));
  for (Numbers* array : {&joined_, &part_, &joined_gradients_, &outputs_}) *array = Numbers(size(rows * padded_hidden));
}

const float* Head::forward(const std::vector<const float*>& inputs, int rows) {
  static const float no_bias[padded_hidden] = {};
  rows_ = rows;
  const int width = last_ ? padded_hidden : padded_action;
  for (int row = 0; row < rows; ++row) std::copy_n(parameters_[joined_bias_], width, joined_ + row * width);
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    Input& input = inputs_[i];
    const float* in = inputs[i];
    if (input.linear) {
      input.linear->forward(in, parameters_[input.linear_bias], input.made, rows);
      in = input.made;
    }
    input.share->forward(in, no_bias, part_, rows);
    for (int k = 0; k < rows * width; ++k) joined_[k] += part_[k];
  }
  if (!last_) return joined_;
  for (int k = 0; k < rows * width; ++k) joined_[k] = std::max(joined_[k], 0.f);
  last_->forward(joined_, parameters_[last_bias_], outputs_, rows);
  return outputs_;
}

void Head::backward(const std::vector<const float*>& inputs, const float* gradient,
                    const std::vector<float*>& input_gradients) {
  if (last_) {
    kernels_.sum_rows(gradient, parameters_.gradient(last_bias_), rows_, padded_action);
    last_->backward(joined_, gradient, joined_gradients_, rows_);
    kernels_.relu_gradient(joined_, joined_gradients_, size(rows_ * padded_hidden));
    gradient = joined_gradients_;
  }
  kernels_.sum_rows(gradient, parameters_.gradient(joined_bias_), rows_, last_ ? padded_hidden : padded_action);
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    Input& input = inputs_[i];
    if (!input.linear) {
      input.share->backward(inputs[i], gradient, input_gradients[i], rows_);
      continue;
    }
    input.share->backward(input.made, gradient, input.gradients, rows_);
    kernels_.sum_rows(input.gradients, parameters_.gradient(input.linear_bias), rows_, input.linear->outputs());
    input.linear->backward(inputs[i], input.gradients, input_gradients[i], rows_);
  }
}

}  // namespace lgabench

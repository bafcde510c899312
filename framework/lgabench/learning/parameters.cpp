#include <lgabench/learning/parameters.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

// Gram and Schmidt's method, twice over: once leaves what rounding adds. As a QR whose R has a positive diagonal.
void orthonormalise(std::vector<std::vector<double>>& vectors) {
  for (auto vector = vectors.begin(); vector != vectors.end(); ++vector) {
    for (const int pass : {1, 2}) {
      static_cast<void>(pass);
      for (auto other = vectors.begin(); other != vector; ++other) {
        const double along = std::inner_product(vector->begin(), vector->end(), other->begin(), 0.);
        for (std::size_t i = 0; i < vector->size(); ++i) (*vector)[i] -= along * (*other)[i];
      }
    }
    const double length = std::sqrt(std::inner_product(vector->begin(), vector->end(), vector->begin(), 0.));
    for (double& number : *vector) number /= length;
  }
}

}  // namespace

Parameters::Parameters(std::uint64_t seed) : random_(fmt::format("learning/weights/{}", seed)) {}

std::size_t Parameters::take(int numbers) {
  const std::size_t begin = count_;
  count_ += size((numbers + 15) / 16 * 16);
  return begin;
}

void Parameters::uniform(const std::vector<std::size_t>& places, double low, double high) {
  places_.insert(places_.end(), places.begin(), places.end());
  for (std::size_t i = 0; i < places.size(); ++i) first_.push_back(static_cast<float>(random_.uniform(low, high)));
}

void Parameters::orthogonal(const std::vector<std::size_t>& places, int rows, int columns) {
  places_.insert(places_.end(), places.begin(), places.end());
  const bool wide = rows <= columns;
  std::vector<std::vector<double>> vectors(size(wide ? rows : columns),
                                           std::vector<double>(size(wide ? columns : rows)));
  const auto number = [&](int row, int column) -> double& {
    return wide ? vectors[size(row)][size(column)] : vectors[size(column)][size(row)];
  };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) number(row, column) = random_.gaussian();
  orthonormalise(vectors);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) first_.push_back(static_cast<float>(number(row, column)));
}

void Parameters::finish() {
  for (Numbers* array : {&values_, &gradients_, &mean_, &variance_}) *array = Numbers(count_);
  set(first_);
  first_ = {};
}

void Parameters::set(const std::vector<float>& values) {
  if (values.size() != places_.size())
    throw InputError(fmt::format("network: expected {} parameters, got {}", places_.size(), values.size()));
  for (std::size_t i = 0; i < places_.size(); ++i) values_[places_[i]] = values[i];
}

void Parameters::clear_gradients() { std::fill_n(static_cast<float*>(gradients_), count_, 0.f); }

std::vector<float> Parameters::in_pytorchs_order(const float* values) const {
  std::vector<float> ordered;
  ordered.reserve(places_.size());
  for (const std::size_t place : places_) ordered.push_back(values[place]);
  return ordered;
}

void Parameters::update(const Kernels& kernels, double learning_rate) {
  constexpr double beta1 = .9, beta2 = .999;
  const auto t = static_cast<double>(++steps_);
  const AdamCoefficients coefficients = {static_cast<float>(beta1),
                                         static_cast<float>(beta2),
                                         1e-8f,
                                         static_cast<float>(1 - beta1),
                                         static_cast<float>(1 - beta2),
                                         static_cast<float>(learning_rate / (1 - std::pow(beta1, t))),
                                         static_cast<float>(1 / std::sqrt(1 - std::pow(beta2, t)))};
  kernels.adam(coefficients, gradients_, mean_, variance_, values_, count_);
}

}  // namespace lgabench

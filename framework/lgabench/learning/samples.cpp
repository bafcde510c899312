#include <lgabench/learning/samples.hpp>

#include <algorithm>
#include <utility>

namespace lgabench {

Samples::Samples(SampleShape of_a_row, int count) : shape(std::move(of_a_row)), rows(count), unaltered(count) {
  const auto n = static_cast<std::size_t>(count);
  for (const SampleShape::Picture& picture : shape.pictures)
    pictures.emplace_back(n * static_cast<std::size_t>(picture.numbers()));
  if (shape.text) text.resize(n * text_size);
  state.resize(n * shape.state.size());
  labels.resize(n * shape.actions.size());
}

Action Samples::label(int row) const {
  const float* const first = labels.data() + static_cast<std::size_t>(row) * shape.actions.size();
  return {first, first + shape.actions.size()};
}

// A majority vote in one pass (Boyer and Moore 1991).
std::vector<float> usual_picture(const Samples& samples, std::size_t which) {
  std::vector<float> candidates(static_cast<std::size_t>(samples.shape.pictures[which].numbers()));
  std::vector<int> lead(candidates.size());
  auto value = samples.pictures[which].begin();
  for (int row = 0; row < samples.unaltered; ++row)
    for (std::size_t i = 0; i < candidates.size(); ++i, ++value) {
      if (lead[i] == 0) candidates[i] = *value;
      lead[i] += *value == candidates[i] ? 1 : -1;
    }
  return candidates;
}

}  // namespace lgabench

#include <lgabench/learning/samples.hpp>

namespace lgabench {

Samples::Samples(const NetworkShape& shape, int count) : rows(count) {
  const auto n = static_cast<std::size_t>(count);
  for (const int channels : shape.channels) {
    usual.emplace_back(static_cast<std::size_t>(channels) * input_pixels);
    pictures.emplace_back(n * usual.back().size());
  }
  if (shape.text) text.resize(n * text_size);
  labels.resize(n * action_size);
}

// A majority vote in one pass (Boyer and Moore 1991).
void Samples::find_usual() {
  for (std::size_t t = 0; t < pictures.size(); ++t) {
    std::vector<float>& candidates = usual[t];
    std::vector<int> lead(candidates.size());
    auto value = pictures[t].begin();
    for (int row = 0; row < rows; ++row)
      for (std::size_t i = 0; i < candidates.size(); ++i, ++value) {
        if (lead[i] == 0) candidates[i] = *value;
        lead[i] += *value == candidates[i] ? 1 : -1;
      }
  }
}

}  // namespace lgabench

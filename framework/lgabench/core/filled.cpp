#include <lgabench/core/filled.hpp>

#include <algorithm>

namespace lgabench {

std::string filled(const std::string& text, const std::vector<std::pair<std::string, std::string>>& values) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const auto value = std::find_if(values.begin(), values.end(), [&](const auto& one) {
      return text.compare(at, one.first.size(), one.first) == 0;
    });
    if (value == values.end()) {
      result += text[at++];
    } else {
      result += value->second;
      at += value->first.size();
    }
  }
  return result;
}

}  // namespace lgabench

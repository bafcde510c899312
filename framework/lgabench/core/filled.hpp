// Templates: texts with placeholders.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace lgabench {

/// The text with each placeholder's value in its place, in one pass: what is put in is not searched again.
std::string filled(const std::string& text, const std::vector<std::pair<std::string, std::string>>& values);

}  // namespace lgabench

// Whose shadow is where, when the table of instances changes.
#pragma once
#include <cstdint>
#include <vector>

#include <lgabench/core/observation.hpp>

namespace lgabench {

/// Observation::shadows of a table with other rows: an instance that left it throws none, one that came neither.
std::vector<std::uint16_t> shadows_of(const std::vector<std::uint16_t>& shadows, const std::vector<Instance>& before,
                                      const std::vector<Instance>& now);

}  // namespace lgabench

// lgabench select --suite SUITE --score --names ...: what is read from a suite's pictures, without a policy.
#pragma once
#include <string>
#include <vector>

#include <lgabench/core/scenario.hpp>
#include <lgabench/harness/suite.hpp>

namespace lgabench::cli {

/// Reads `scenes` test scenes of each arm of each scenario of the suite in each of these ways, and prints for every
/// arm: in how many scenes the true Selection keeps exactly the objects that are meant, which share of the visible
/// objects has its segment (four fifths of what both cover), its type and its texture; then which names were taken for
/// which.
/// @throws InputError for names that a plugin reads, and where a scenario's pictures cannot be read.
void print_reading_scores(const Suite& suite, Truth truth, int scenes, bool json, const std::vector<std::string>& names,
                          const std::vector<std::string>& segments);

}  // namespace lgabench::cli

// lgabench select --suite SUITE --score --names ...: what is read from a suite's pictures, without a policy.
#pragma once
#include <string>
#include <vector>

#include <lgabench/abstraction/chat_model.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/harness/suite.hpp>

namespace lgabench::cli {

/// The name under which a model is shown pictures.
inline constexpr const char* looked = "looked";

struct ReadingArguments {
  int scenes = 30;
  bool json = false;
  std::vector<std::string> names, segments, arms;  // arms: those alone; none: all
};

/// Reads `scenes` test scenes of each arm of each scenario of the suite in each of these ways, and prints for every
/// arm: in how many scenes the true Selection keeps exactly the objects that are meant, which share of the visible
/// objects has its segment (four fifths of what both cover), its type and its texture; then which names were taken for
/// which. Under the name `looked`, `model` names the marked segments that the command could mean, and those are what is
/// kept: then for every arm what it cost. A picture without an answer is in no mean: its row counts it, and a line on
/// stderr names its scene.
/// @throws InputError for names that a plugin reads, for an arm that no scenario has, and where a scenario's pictures
/// cannot be read; MethodError at the end where a picture has no answer, and at once as ChatLanguageModel::look().
void print_reading_scores(const Suite& suite, Truth truth, const ReadingArguments& arguments,
                          ChatLanguageModel* model = nullptr);

}  // namespace lgabench::cli

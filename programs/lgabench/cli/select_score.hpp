// lgabench select --suite SUITE --score: how exactly a language model's answers keep what is meant, without a policy.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include <lgabench/core/language_model.hpp>
#include <lgabench/harness/suite.hpp>

namespace lgabench::cli {

/// Calls `use` with whoever answers for the scenario's commands.
using WithAnswers = std::function<void(const Scenario& scenario, const std::function<void(LanguageModel&)>& use)>;

/// Scores the answers to every command of the suite, asked yes or no of each feature, asked what the command means, and
/// the names in the command, in `scenes` scenes of each arm, and prints a row of each for every group and for all;
/// beside them, how often hypotheses on what the words leave unsaid hold the truth.
/// A command without an answer is in no mean: its row counts it, and a line on stderr names it. A way of asking in
/// which nobody can answer is left out with its reason.
/// @throws MethodError at the end where an answer lacks that was asked for, InputError where none was scored and
/// `expects_answers`.
void print_scores(const Suite& suite, Truth truth, int scenes, bool json, bool expects_answers,
                  const WithAnswers& with_answers);

/// Writes best_products() of every command of the suite as a file of answers, for --answers FILE.
void write_best_products(const Suite& suite, Truth truth, const std::filesystem::path& file);

}  // namespace lgabench::cli

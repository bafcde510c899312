// What the simulator's labels, language and the truth add to what a policy does from pixels.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <lgabench/statistics/about_suite.hpp>
#include <lgabench/statistics/results.hpp>
#include <lgabench/statistics/statistics.hpp>

namespace lgabench::statistics {

struct Table;

/// Four rows, each of which is told more than the one before, with one policy. Labels: a rule that reads types and
/// textures of what the demonstrations took, and no language. Language adds what LGA has beyond this rule: an upper
/// bound, which a better rule of labels lowers; it may be negative.
struct Stage {
  const char *what, *method;
};
constexpr std::array<Stage, 4> stages{
    {{"pixels", "gcbc_seg"}, {"labels", "taken_features"}, {"language", "lga"}, {"truth", "human"}}};

/// The difference between a stage and the one before it, of the same scenes and training seeds.
struct Step {
  double difference = 0;
  Interval interval;       // 95 %, of other scenes and seeds: these commands
  Interval over_commands;  // 95 %, of other commands as well
};

/// Success by stage, command, policy (training seed) and scene, and what each command counts in the mean. One row a
/// stage: all have as many commands, policies and scenes.
struct StageOutcomes {
  std::vector<std::vector<std::vector<std::vector<double>>>> rates;
  std::vector<double> weights;
  bool shared = false;  // the policies play the same scenes
};
/// @pre a stage that there is
double mean_rate(const StageOutcomes& outcomes, std::size_t stage);
/// The three steps, of one set of resamples: they add up in each. `name` seeds the random stream.
std::array<Step, 3> steps_of(const StageOutcomes& outcomes, std::string_view name);

/// The steps of one table in its main arm, at one number of demonstrations.
struct Steps {
  std::string layout, engine, arm;
  int demonstrations = 0, commands = 0;
  std::array<double, 4> success{};    // of each stage
  std::array<std::size_t, 4> rows{};  // of summary.json
  std::array<Step, 3> steps;
};
/// Of each table and number of demonstrations at which all four rows finished on the same scenes with the same policy,
/// without errors, and nobody was asked.
std::vector<Steps> all_steps(const RunResults& run, const std::vector<Table>& tables, const AboutSuite& about);
Json to_json(const Steps& steps);

/// What a reader must know of the four rows.
inline constexpr const char* words_of_steps =
    "The four rows learn with one policy, from the same demonstrations. Labels: the object types and textures of what "
    "the demonstrations took, as the simulator names them, without a word of the command. What language adds to them "
    "is "
    "an upper bound, which a better rule of labels lowers; below 0, language leaves out what was demonstrated.";
/// "[+0.14, +0.26]"
std::string signed_interval(const Interval& interval);

}  // namespace lgabench::statistics

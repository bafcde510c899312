// What the simulator's labels, the command's words and the truth add to what a policy does from pixels.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <lgabench/statistics/about_suite.hpp>
#include <lgabench/statistics/results.hpp>
#include <lgabench/statistics/statistics.hpp>

namespace lgabench::statistics {

struct Table;

/// A row that is told more than the one before, with one policy.
struct Stage {
  const char *what, *method;
  const char* adds;  // "reading the command adds"; "" of the first
  bool needed;       // without it there are no steps; else the steps go over it
};
/// Labels: rules that read types and textures of what the demonstrations took, and never the command. One counts, the
/// other also knows what the names mean to a sentence encoder. What reading the command adds to them is an upper bound,
/// which a better rule of labels lowers; it may be negative. Both: the command read, then the most demonstrated of what
/// it leaves.
constexpr std::array<Stage, 6> stages{
    {{"pixels", "gcbc_seg", "", true},
     {"labels, counted", "taken_features", "counting labels adds", true},
     {"labels, by what their names mean", "taken_names", "what their names mean adds", false},
     {"command read", "lga", "reading the command adds", true},
     {"both", "lga_then_taken", "the demonstrations beside it add", false},
     {"true mask", "human", "the true mask adds", true}}};

inline constexpr const char *command_read = stages[3].method, *both_stage = stages[4].method,
                            *true_mask = stages[5].method;

/// The difference between a stage and the one before it, of the same scenes and training seeds.
struct Step {
  double difference = 0;
  Interval interval;                      // 95 %, of other scenes and seeds: these commands
  std::optional<Interval> over_commands;  // 95 %, of other commands as well; none: too few to decide
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
/// The steps from each stage to the next, of one set of resamples: they add up in each. `name` seeds the random stream.
std::vector<Step> steps_of(const StageOutcomes& outcomes, std::string_view name);

/// The steps of one table in its main arm, at one number of demonstrations.
struct Steps {
  std::string layout, engine, arm;
  int demonstrations = 0, commands = 0;
  /// A stage that was played.
  struct Played {
    const Stage* stage;
    double success;
    std::size_t row;  // of summary.json
  };
  std::vector<Played> played;
  std::vector<Step> steps;  // [i]: from played[i] to played[i + 1]
};
/// Of each table and number of demonstrations at which all rows that are needed finished on the same scenes with the
/// same policy, without errors, and nobody was asked; other stages where they did so too.
std::vector<Steps> all_steps(const RunResults& run, const std::vector<Table>& tables, const AboutSuite& about);
Json to_json(const Steps& steps);

/// What a reader must know of these rows.
inline constexpr const char* words_of_steps =
    "The rows learn with one policy, from the same demonstrations. Labels: the object types and textures of what the "
    "demonstrations took, as the simulator names them, without a word of the command. What reading the command adds to "
    "them is an upper bound, which a better rule of labels lowers; below 0, reading the command leaves out what was "
    "demonstrated. Fewer than six commands leave other commands undecided.";
/// "[+0.14, +0.26]"; "undecided" where there is none.
std::string signed_interval(const std::optional<Interval>& interval);

}  // namespace lgabench::statistics

// A study's results: seconds by condition and command, Selections against the truth, and what was left out.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/abstraction/quality.hpp>
#include <lgabench/statistics/statistics.hpp>
#include <lgabench/study/pair_study.hpp>
#include <lgabench/study/study.hpp>

namespace lgabench::study {

/// One person, with the trials that count.
struct PersonResult {
  const Session* session = nullptr;
  std::string excluded;                              // why; "" for one whom the tests use
  std::array<std::vector<const Trial*>, 2> counted;  // by condition

  /// Mean seconds of the trials that count, raw or active. @pre there is one
  double mean_s(Condition condition, double Trial::*seconds = &Trial::raw_s) const;
};

/// A command in both conditions, in their order, with the test between them.
struct CommandResult {
  const Item* item = nullptr;
  std::array<std::vector<double>, 2> seconds;
  std::optional<statistics::Change> change;  // human minus lga_hill: paired, or for a crossover Welch's
  double p_holm = 1;                         // over the commands
};

/// A scale of NASA-TLX in both conditions, of the people who answered it in both.
struct ScaleResult {
  std::string scale;                          // "raw": the mean of all six
  std::array<std::vector<double>, 2> values;  // by condition, person by person
  std::optional<statistics::Change> change;   // human minus lga_hill, paired t; none with fewer than two people
  double p_holm = 1;                          // over the rows
};

/// A pair of a study of disputed pairs: what people said of it.
struct PairResult {
  const Item* item = nullptr;
  const AskedPair* pair = nullptr;
  Said said{};
  double p_holm = 1;  // p_unsettled() over the disputed pairs; 1 of a control

  int people() const { return said[0] + said[1] + said[2]; }
  bool settled() const { return p_holm <= statistics::alpha; }  // as more than half say
};

struct StudyResults {
  const Record* record = nullptr;
  std::vector<PersonResult> people;  // all, by slot
  std::array<std::optional<statistics::Spread>, 2> seconds,
      active_s;                                       // of people's means, by condition; none of nobody
  std::optional<statistics::Change> primary, active;  // paired t, human minus lga_hill; none with fewer than two people
  /// Crossover: effects on log seconds of condition (human over lga_hill), period (first over second) and set (the
  /// first over the second): each person's difference of periods on three columns. Empty where it has no solution.
  std::vector<statistics::Change> log_model;
  std::vector<CommandResult> commands;
  std::vector<ScaleResult> tlx;   // empty unless asked about each condition
  std::array<SetQuality, 2> phi;  // of the target by condition, mean over trials; nothing where nobody chose anything
  std::array<std::optional<statistics::Spread>, 2> by_first;  // human minus lga_hill, of who began with each condition
  int interrupted = 0, too_long = 0, practice = 0, disagree = 0;  // trials; disagree: clicks that do not add up to φ̂
  int clocks_apart =
      0;  // trials in which the server's clock says another time by more than 2 s; not of simulated people

  std::vector<PairResult> pairs;    // of a study of disputed pairs, which has no more than people, trials and these
  std::optional<double> agreement;  // Krippendorff's alpha over the disputed ones

  int used() const;  // people
};

/// @p record must outlive it.
StudyResults results_of(const Record& record);

/// Each person's mean log seconds of the first period minus that of the second, on condition, period and set, coded
/// so that a coefficient is the difference of the two levels (Jones and Kenward 2014, 2.5; Senn 2002, 3.6).
struct CrossoverPerson {
  bool human_first = false, first_set_first = false;
  double difference = 0;
};
std::vector<statistics::Change> crossover_model(const std::vector<CrossoverPerson>& people);

}  // namespace lgabench::study

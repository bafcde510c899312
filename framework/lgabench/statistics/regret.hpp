// What a row loses in a suite of persons, who do not say all that they want.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <lgabench/statistics/results.hpp>
#include <lgabench/statistics/statistics.hpp>

namespace lgabench::statistics {

/// A difference in success, with its 95 % interval over persons and scenes; none: too few persons to decide.
struct Loss {
  double difference = 0;
  std::optional<Interval> interval;
};

/// One row at one number of demonstrations and of questions. Each person (a command) counts alike.
struct Regret {
  std::string layout, engine, method;
  int demonstrations = 0, questions = 0, persons = 0;
  double success = 0;
  std::optional<Interval> success_interval;
  std::optional<Loss> regret;    // of the ceiling with as many of both, less this row; none where the run lacks it
  std::optional<Loss> to_bayes;  // likewise of Bayes with one Selection; of rows that select once
};
/// The rows of a run whose scenarios ask people in scenes, in the order of layout, engine, demonstrations and
/// questions; rows with a failed cell, or with nothing to compare with, are left out.
std::vector<Regret> regrets(const RunResults& run);
Json to_json(const Regret& regret);

/// Exact Bayes of the grammar, with the best questions and one Selection; or, the ceiling for rows that know no more of
/// the person, with what is likeliest in each scene.
bool is_bayes(const CellResult& cell);
bool is_ceiling(const CellResult& cell);

}  // namespace lgabench::statistics

// What a row loses against exact Bayes in a suite of persons, who do not say all that they want.
#pragma once
#include <string>
#include <vector>

#include <lgabench/statistics/results.hpp>
#include <lgabench/statistics/statistics.hpp>

namespace lgabench::statistics {

/// One row at one number of demonstrations and of questions. Each person (a command) counts alike; intervals, 95 %, are
/// over persons and scenes.
struct Regret {
  std::string layout, engine, method;
  int demonstrations = 0, questions = 0, persons = 0;
  double success = 0, regret = 0;  // regret: of the row person_rule with as many of both, less this row's success
  Interval success_interval, interval;
};
/// Of a run whose scenarios ask people in scenes, in the order of layout, engine, demonstrations and questions; rows
/// with a failed cell, or without the row to compare with, are left out.
std::vector<Regret> regrets(const RunResults& run);
Json to_json(const Regret& regret);

/// The row that others are compared with, and the best known one: the same rule, which chooses anew in each scene.
bool is_bayes(const CellResult& cell);

}  // namespace lgabench::statistics

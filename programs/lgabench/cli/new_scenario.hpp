// What `new-scenario` and `new-suite` are told of a scenario, and the file that it makes.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <lgabench/cli/verbs.hpp>

namespace lgabench::cli {

using Words = std::vector<std::string>;

/// A scenario of the environment that has the task; texts are as on the command line.
struct NewScenario {
  std::string name, task = "pick_and_place", space /* "": the environment's usual one */, distractors = "1:2";
  Words commands, unseen, types, textures{"ALL"}, other_types, other_textures{"ALL"};
  Words also, careless, undecided, order;  // all but the last: sets
  std::string rule, of, words;
  std::optional<double> angle_deg;
  bool clockwise = false, hard = false, near_miss = false;
};

void add_scenario_options(Verb& verb, NewScenario& a);

/// The file's JSON, which the reader of runs takes; what is missing is asked for on a terminal. `verb` and `file` are
/// named in errors. @throws InputError
Json new_scenario_json(NewScenario& a, const char* verb, const std::string& file);

}  // namespace lgabench::cli

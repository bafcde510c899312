// Draws of commands, and the files that they become: scenarios, and a suite of them.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <lgabench/drawn/grammar.hpp>
#include <lgabench/drawn/persons.hpp>

namespace lgabench::drawn {

struct DrawRequest {
  std::uint64_t seed = 0;
  int commands = 100;
  int parts = 4;  // of a compound command
};

/// Draws as many commands as are asked for, of all families in turn, no two of which mean the same; a family that has
/// no more is passed over. What `is_fit` refuses is drawn again. A function of lexicon and request, on any machine.
/// @throws InputError for parts that no compound command has, and where all families together have fewer commands.
std::vector<DrawnCommand> draw_commands(const Lexicon& lexicon, const DrawRequest& request,
                                        const std::function<bool(const DrawnCommand&)>& is_fit);

/// The command as a scenario's file: picks the meant object among others, one of which a careless reading keeps.
Json scenario_of(const DrawnCommand& command, const FeatureSpace& space);
/// Whether the first scenes of training and test can be drawn.
bool can_be_shown(const Json& scenario);

/// A suite of these commands, whose families are its groups.
Json suite_of(const std::string& id, const DrawRequest& request, const std::vector<DrawnCommand>& commands);

/// Persons as a scenario, with a command of each; and a suite of such scenarios.
Json scenario_of(const std::string& id, const std::vector<Person>& persons, const FeatureSpace& space);
Json suite_of_persons(const std::string& id, const std::vector<std::string>& scenarios, bool hinted);
/// A scenario of as many persons of another seed, from number `first` on; one without persons as it is.
Json with_other_persons(const Json& scenario, const FeatureSpace& space, std::uint64_t seed, int first);

/// JSON as people read it: what fits into a line stands in one.
std::string readable(const Json& json);

}  // namespace lgabench::drawn

// The rows of a run's tables: methods with their options, named by what tells them apart.
#pragma once
#include <string>
#include <vector>

#include <lgabench/core/json.hpp>
#include <lgabench/harness/suite.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench {

/// A method, or a row of the table that a method is measured against.
struct Competitor {
  std::string kind = "method";  // or "reference": constant_action, random_object, oracle
  std::string id;
  std::string name;  // its row's: the id, and what tells it from the run's other rows of that id (see competitors())
  std::string version;
  Json options = Json::object();  // every option, defaults included
  std::string asks{};             // whom beside the language model: see LGABENCH_METHOD_ASKING

  bool is_reference() const { return kind == "reference"; }
};

/// The grid's methods, in its order. An option's value is the first that is given by: the row itself, `settings` for
/// its id, `settings` for "*", the grid for its id, the grid for "*", the plugin's default. A row is named by its id,
/// followed by "+option=value" (sorted) for each option in which the grid's rows of that id differ and it has another
/// value than without options of its own.
/// @throws PluginError for an unknown method, InputError for an unknown option, for a method that is not written
/// ID+OPTION=VALUE+..., for two that name one row, and for settings of a method that is not on the grid.
std::vector<Competitor> competitors(const Suite& suite, const Grid& grid, const Json& settings,
                                    const Catalogue& catalogue);

}  // namespace lgabench

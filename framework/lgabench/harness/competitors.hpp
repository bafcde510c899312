// The rows of a run's tables: methods with their options, named by what tells them apart.
#pragma once
#include <string>
#include <vector>

#include <lgabench/core/json.hpp>
#include <lgabench/harness/suite.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/record/cell.hpp>

namespace lgabench {

/// The design's methods, in its order. An option's value is the first that is given by: the row itself, `settings` for
/// its id, `settings` for "*", the design for its id, the design for "*" where the option is the framework's, the
/// plugin's default. A row is named by its id, followed by "+option=value" (sorted) for each option in which the
/// design's rows of that id differ and it has another value than without options of its own.
/// @throws PluginError for an unknown method, InputError for an unknown option, for a method that is not written
/// ID+OPTION=VALUE+..., for two that name one row, for the id of a reference row, and for settings of a method that is
/// not part of the design.
std::vector<Competitor> competitors(const Suite& suite, const Design& design, const Json& settings,
                                    const Catalogue& catalogue);

}  // namespace lgabench

// Which plugins compute a cell.
#pragma once
#include <optional>
#include <vector>

#include <lgabench/plugin/loader.hpp>
#include <lgabench/record/cell.hpp>

namespace lgabench {

/// What moves the bodies of its scenes; none where its environment has no engine plugin. @throws as
/// Catalogue::engine().
std::optional<PluginInfo> engine_plugin(const Cell& cell, const Catalogue& catalogue);
/// What selects; null of a reference row. @throws as Catalogue::find().
const PluginInfo* method_plugin(const Cell& cell, const Catalogue& catalogue);
/// What acts in place of it; null where the method does. @throws as method_plugin().
const PluginInfo* acting_plugin(const Cell& cell, const Catalogue& catalogue);
/// What its scenes are of; null where that is lgabench's own. @throws as method_plugin().
const PluginInfo* environment_plugin(const Cell& cell, const Catalogue& catalogue);
/// The plugins whose axes its arms have. @throws as method_plugin().
std::vector<PluginInfo> axis_plugins(const Cell& cell, const Catalogue& catalogue);
/// What reads its names; null where no plugin does. @throws as method_plugin().
const PluginInfo* perceiver_plugin(const Cell& cell, const Catalogue& catalogue);

/// Hashes of all that computes the cell, by name. @throws likewise.
Json build_of(const Cell& cell, const Catalogue& catalogue);

}  // namespace lgabench

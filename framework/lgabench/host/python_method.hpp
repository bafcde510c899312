// A method or a perturbation in Python: FILE.py:Class, described without running it.
#pragma once
#include <string>

#include <lgabench/plugin/loader.hpp>

namespace lgabench {

/// Whether the word names a plugin in Python: its part before the first '+' holds ".py:".
bool is_python_method(const std::string& word);

/// Asks the interpreter's own parser what the file says of the class (python/lgabench_method/describe.py).
/// @throws PluginError with the interpreter's message, or naming what is wrong with id, options or asks.
PluginInfo describe_python(const std::string& written, const std::string& interpreter);
/// Describes the class of an installed package. `site` is the folder that it was installed into, which the method's
/// process may read too; `id` takes the place of the class's own.
PluginInfo describe_python(const std::string& written, const std::string& interpreter, const fs::path& site,
                           const std::string& id);

/// Adds a plugin that is not there yet. @throws PluginError for an id that another one of its kind has.
void add_once(const PluginInfo& plugin, Catalogue& catalogue);

/// A row as the suite's reader knows it: where it is written FILE.py:Class+OPTION=VALUE, the method is described, added
/// to the catalogue, and named by its id. @throws PluginError likewise, and for an id that another plugin has.
std::string with_python_method(const std::string& row, const std::string& interpreter, Catalogue& catalogue);

/// Plugins of the usual places and of these paths, some of which may be FILE.py:Class, for that interpreter; methods of
/// installed packages (host/installed_methods.hpp) and axes of perturbations (add_axes) are added. @throws PluginError
/// likewise.
Catalogue plugins_at(const std::vector<fs::path>& paths, const std::string& interpreter);

}  // namespace lgabench

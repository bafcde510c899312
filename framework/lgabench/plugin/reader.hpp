// Inside plugin/: the steps of read_plugin that the catalogue and the loader use too. Errors here do not name the file.
#pragma once
#include <string_view>

#include <lgabench/plugin/descriptor.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench {

/// The one descriptor in the bytes of a whole ELF library. @throws PluginError, also for another plugin interface.
PluginDescriptor find_descriptor(std::string_view bytes);

/// What a descriptor's options say.
struct DeclaredOptions {
  Json options;                                   // as PluginInfo::options
  bool questionnaire = false, kinematic = false;  // said beside them, and no options
};

/// Checked. @throws PluginError with the place of what is wrong.
DeclaredOptions read_options(const std::string& options_json);

/// What a perturbation's axis declares, checked, with the plugin's version: as PluginInfo::axis. @throws PluginError
/// likewise.
Json read_declared_axis(const PluginInfo& plugin, const std::string& declared);

/// Lower-case letters, digits and underscores, a letter first: a plugin's id.
bool is_name(const std::string& id);

/// Whom a method may say that it asks. @throws PluginError for another word.
void check_asks(const std::string& kind, const std::string& asks);

/// read_plugin without the file's name in errors.
PluginInfo inspect_plugin(const fs::path& file);

}  // namespace lgabench

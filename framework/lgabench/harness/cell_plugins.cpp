#include <lgabench/harness/cell_plugins.hpp>

#include <lgabench/harness/run_directory.hpp>

namespace lgabench {

std::optional<PluginInfo> engine_plugin(const Cell& cell, const Catalogue& catalogue) {
  return catalogue.engine(cell.engine, find_environment(cell.environment));
}

const PluginInfo* method_plugin(const Cell& cell, const Catalogue& catalogue) {
  return cell.method.is_reference() ? nullptr : &catalogue.find("method", cell.method.id);
}

const PluginInfo* acting_plugin(const Cell& cell, const Catalogue& catalogue) {
  return cell.method.acts ? &catalogue.find("method", cell.method.acts->id) : nullptr;
}

const PluginInfo* environment_plugin(const Cell& cell, const Catalogue& catalogue) {
  return cell.has_plugin_environment() ? &catalogue.find("environment", cell.environment) : nullptr;
}

std::vector<PluginInfo> axis_plugins(const Cell& cell, const Catalogue& catalogue) {
  std::vector<PluginInfo> plugins;
  for (const std::string& id : cell.plugin_axes()) plugins.push_back(catalogue.find("perturbation", id));
  return plugins;
}

const PluginInfo* perceiver_plugin(const Cell& cell, const Catalogue& catalogue) {
  const std::string id = cell.reading.plugin();
  return id.empty() ? nullptr : &catalogue.find("perceiver", id);
}

Json build_of(const Cell& cell, const Catalogue& catalogue) {
  Json build = build_hashes(engine_plugin(cell, catalogue), method_plugin(cell, catalogue), cell.needs_axes());
  if (const PluginInfo* acts = acting_plugin(cell, catalogue)) build["acts"] = acts->sha256;
  if (const PluginInfo* environment = environment_plugin(cell, catalogue))
    add_named(build, *environment);
  else
    build[cell.environment_in_build()] = library_hash(cell.environment_in_build());
  for (const PluginInfo& axis : axis_plugins(cell, catalogue)) add_named(build, axis);
  if (const PluginInfo* perceiver = perceiver_plugin(cell, catalogue)) add_named(build, *perceiver);
  if (cell.reading.needs_library()) build[seeing_library] = library_hash(seeing_library);
  return build;
}

}  // namespace lgabench

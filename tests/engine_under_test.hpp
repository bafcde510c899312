// The engine that tests play on.
#pragma once
#include <cstdlib>
#include <memory>
#include <string>

#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench {

/// $LGABENCH_TEST_ENGINE, an id or the file of a plugin; else the first that was built of mujoco, bullet, kinematic.
/// @throws PluginError if there is none.
inline const PluginInfo& engine_under_test() {
  static const PluginInfo chosen = [] {
    const Catalogue catalogue = scan_plugins(plugin_directories());
    if (const char* named = std::getenv("LGABENCH_TEST_ENGINE")) {
      if (fs::path(named).extension() != ".so") return catalogue.find("engine", named);
      const PluginInfo plugin = read_plugin(named);
      if (plugin.kind != "engine") throw PluginError(std::string(named) + ": expected an engine, got a " + plugin.kind);
      return plugin;
    }
    for (const char* id : {"mujoco", "bullet"})
      for (const PluginInfo& plugin : catalogue.plugins)
        if (plugin.kind == "engine" && plugin.id == id) return plugin;
    return catalogue.find("engine", "kinematic");
  }();
  return chosen;
}

inline std::unique_ptr<PhysicsWorld> make_engine() { return load_engine(engine_under_test()); }

}  // namespace lgabench

// A scenario, and scenes in which a method acts outside of a run: to check it, or to say how long it takes.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/core/environment.hpp>
#include <lgabench/core/method.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench {

struct Sight {
  Scene scene;
  Observation observation;
};

/// The scenario in its first layout, on an environment of its own, with five test scenes of each arm. One thread.
struct Bench {
  static constexpr std::uint64_t seed = 7;  // of scenes

  /// @throws EngineError
  Bench(Scenario played, const std::optional<PluginInfo>& engine);

  /// The same scenes, with what the method needs to see of them.
  void look_again(const Needs& needs);
  bool is_seen(const Sight& sight) const {
    return scenario.commands[static_cast<std::size_t>(sight.scene.command)].seen;
  }

  Scenario scenario;
  std::string layout;
  std::unique_ptr<Environment> environment;
  std::vector<Sight> sights;
};

}  // namespace lgabench

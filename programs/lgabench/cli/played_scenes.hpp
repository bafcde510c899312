// Scenes that a run has played, made again by name, and the engines to play them on.
#pragma once
#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <lgabench/core/environment.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/record/cell.hpp>

namespace lgabench::cli {

/// Reads each cell, and loads each engine, once. One thread.
class PlayedScenes {
 public:
  /// Engines are also looked for in `more`.
  explicit PlayedScenes(const std::vector<std::filesystem::path>& more = {});

  struct Played {
    Cell cell;
    Scenario scenario;
  };

  /// The cell of a cell.json; it lives as long as this. @throws InputError
  const Played& cell(const std::string& file);

  /// @throws InputError where this version samples another scene than that hash's.
  static Scene scene(const Played& played, const std::string& arm, int index, const std::string& hash);

  /// The scenario's environment on that engine; null for an engine that is not there.
  Environment* on(const std::string& engine, const Scenario& scenario);

 private:
  const Catalogue catalogue_;
  std::map<std::array<std::string, 3>, std::unique_ptr<Environment>>
      environments_;                                      // by engine, environment, and space with world
  std::map<std::string, std::unique_ptr<Played>> cells_;  // by file
};

/// Carries out an episode's actions (Episode::actions()) from the scene's beginning, which is in `environment`; `after`
/// each. Returns what the last led to. @throws InputError, with scene and step, where the episode is over before its
/// last action: another environment played it.
StepResult carry_out(Environment& environment, const Scene& scene, const std::vector<Action>& actions,
                     const std::function<void(const StepResult&)>& after = {});

/// Whether a target is in view at a pixel of the picture that a page shows (page_step()); false outside of it. Holds
/// `seen`.
std::function<bool(int column, int row)> target_pixels(const Scene& scene, const Observation& seen);

/// Answers each of the JSON list on standard input with a line of JSON: {"problem": why} where answering throws an
/// Error. `verb` is named in errors. @throws InputError where there is no such list.
void answer_requests(const std::string& verb, const std::function<Json(const JsonReader&)>& answer);

}  // namespace lgabench::cli

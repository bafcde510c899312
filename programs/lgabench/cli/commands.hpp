// All commands of `lgabench`, as a person sees them.
#pragma once
#include <array>
#include <string_view>
#include <utility>

#include <lgabench/cli/verbs.hpp>

namespace lgabench::cli {

inline constexpr const char* about = "A benchmark of state abstraction in imitation learning";

/// The commands that --help shows; `help all` shows every command.
inline constexpr std::array first_commands{"list", "run", "open", "compare", "new-plugin", "check-plugin"};

/// Environment variables and exit statuses, as `help all` and the man page say them.
extern const char* const reference;

/// The verbs of lgabench-worker that a person calls, which need an engine, with what they do.
inline constexpr std::array<std::pair<const char*, const char*>, 7> worker_verbs{{
    {"select", "Ask which features matter for a command, and print the Selection"},
    {"demos", "Write the oracle's demonstrations of a scenario as robomimic HDF5"},
    {"render", "Draw a scene, its ids and its goal mask, or a contact sheet, as a PNG file"},
    {"replay", "Play a recorded episode again, as an animation or a film strip"},
    {"rescore", "Judge a run's recorded actions by other tolerances, without their methods"},
    {"bench", "Measure how long a method takes, beside another one"},
    {"check-scenario", "Sample and play a scenario's scenes, and say what is wrong with the scenario"},
}};
/// What a verb of worker_verbs does.
inline const char* worker_summary(std::string_view verb) {
  for (const auto& [name, summary] : worker_verbs)
    if (name == verb) return summary;
  return "";
}

/// Adds every verb that is not in worker_verbs, and the texts of --help around them.
void add_commands(CLI::App& app, int& exit);

/// Puts the commands that are there below their titles.
void arrange_commands(CLI::App& app);

}  // namespace lgabench::cli

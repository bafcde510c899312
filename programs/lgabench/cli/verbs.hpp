// The command line: one function a verb, each in its own file, each adding a CLI11 subcommand with its callback.
#pragma once
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/cli/help.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/exit_status.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/core/resources.hpp>
#include <lgabench/core/scenario_files.hpp>
#include <lgabench/core/suggest.hpp>

namespace lgabench {
struct Scenario;
struct PluginInfo;
}  // namespace lgabench

namespace lgabench::cli {

using namespace exit_status;

// In `lgabench`: start in milliseconds, load no engine, no LibTorch.
void add_list(CLI::App& app, int& exit);
void add_info(CLI::App& app, int& exit);
void add_run(CLI::App& app, int& exit);
void add_merge(CLI::App& app, int& exit);
void add_report(CLI::App& app, int& exit);
void add_open(CLI::App& app, int& exit);
void add_compare(CLI::App& app, int& exit);
void add_verify(CLI::App& app, int& exit);
void add_attribute(CLI::App& app, int& exit);
void add_cluster(CLI::App& app, int& exit);
void add_status(CLI::App& app, int& exit);
void add_leaderboard(CLI::App& app, int& exit);
void add_new_plugin(CLI::App& app, int& exit);
void add_check_plugin(CLI::App& app, int& exit);
void add_cache(CLI::App& app, int& exit);
void add_encoder(CLI::App& app, int& exit);
void add_new_scenario(CLI::App& app, int& exit);
void add_new_suite(CLI::App& app, int& exit);
void add_drawn_commands(CLI::App& app, int& exit);
void add_study(CLI::App& app, int& exit);
void add_answers(CLI::App& app, int& exit);

// In `lgabench-worker`, beside its own verbs.
void add_select(CLI::App& app, int& exit);
void add_demos(CLI::App& app, int& exit);
void add_render(CLI::App& app, int& exit);
void add_pictures(CLI::App& app, int& exit);
void add_strips(CLI::App& app, int& exit);
void add_replay(CLI::App& app, int& exit);
void add_rescore(CLI::App& app, int& exit);
void add_check_scenario(CLI::App& app, int& exit);
void add_bench(CLI::App& app, int& exit);

/// A check for an option: a number from `low` to `high`, which NaN is not.
inline CLI::Validator within(double low, double high) {
  return CLI::Validator(
      [low, high](const std::string& word) {
        double value = 0;
        const bool number = CLI::detail::lexical_cast(word, value) && value >= low && value <= high;
        return number ? std::string() : fmt::format("expected a number from {} to {}, got {}", low, high, word);
      },
      fmt::format("FLOAT in [{} - {}]", low, high), "");
}

/// A check for an option: a seed as suites and `run --seeds` take them.
inline CLI::Validator a_seed() {
  return CLI::Validator(
      [](const std::string& word) {
        using Number = std::int64_t;
        const std::optional<Number> seed = number_of<Number>(word);
        return seed && *seed >= 0 ? std::string()
                                  : fmt::format("expected a whole number from 0 to {}, got {}",
                                                std::numeric_limits<Number>::max(), word);
      },
      "", "");
}

/// The rows that every run has beside its methods, and what they do: {"id", "summary"} each.
Json reference_rows();
/// The layouts that all of the scenarios have, in the order of the first one's. @pre there is one
std::vector<std::string> common_layouts(const std::vector<Scenario>& scenarios);

/// What --layout names, or the scenario's first layout where it names none. @throws InputError for one that the
/// scenario has not.
std::string layout_of(const Scenario& scenario, const std::string& word);

/// A check for an option: one of those words.
inline CLI::Validator one_of(std::string what, std::vector<std::string> known) {
  return CLI::Validator(
      [what = std::move(what), known = std::move(known)](const std::string& word) {
        const bool is_known = contains(known, word);
        return is_known ? std::string() : none_named(what, word, known);
      },
      "", "");
}

/// A check for an option: an installed feature space.
CLI::Validator feature_space();

/// Every option of the plugin, some as words OPTION=VALUE set them. @throws InputError
Json options_set(const PluginInfo& plugin, const std::vector<std::string>& words);

/// What --plugin-path of a verb takes that finds its plugins with plugins_at() (host/python_method.hpp).
inline constexpr const char* any_plugin = "a directory, a site-packages folder, a .so file, or FILE.py:CLASS";

/// "x.so: no such file or directory" of a word that names a plugin's file or a directory of plugins, none of which is
/// there; else "".
inline std::string missing_plugin(const std::string& word) {
  const std::size_t python = word.find(".py:");
  const std::string file = python == word.npos ? word : word.substr(0, python + 3);
  std::error_code not_there;
  return fs::exists(file, not_there) ? "" : file + ": no such file or directory";
}

/// Adds the path to $LGABENCH_PLUGIN_PATH: workers that are asked for pictures, and scenarios that are read before
/// plugins are, find environments there.
void also_for_workers(const std::string& path);

/// --plugin-path, as every verb has it.
inline void add_plugin_path(Verb& verb, std::vector<fs::path>& paths,
                            const std::string& takes = "a directory or a .so file") {
  const auto there = [](const std::string& word) {
    const std::string missing = missing_plugin(word);
    const bool several = !missing.empty() && missing.find(':') < missing.rfind(": ");
    return missing + (several ? "; for several, repeat --plugin-path" : "");
  };
  verb.option("--plugin-path PATH", paths, fmt::format("Also look for plugins here: {}; can be repeated", takes), there,
              repeatable)
      ->each(also_for_workers);
}

/// --jobs and --timeout, as every verb has them that computes cells of its own.
template <class... More>
void add_pool(Verb& verb, int& jobs, double& timeout_s, More... of_timeout) {
  verb.option("--jobs N", jobs, "Cells to compute at once (default: one for each core that the job has)",
              CLI::Range(1, 4096));
  verb.option("--timeout SECONDS", timeout_s, "Seconds after which a cell is stopped and counts as failed",
              within(1, 1e7), with_default, of_timeout...);
}
/// How many cells to compute at once, where --jobs is that; 0: as many as usable_cores().
inline int jobs_of(int asked) { return asked != 0 ? asked : usable_cores(); }

/// --timeout and --memory of a plugin's process, as every verb has them that uses a plugin outside of cells; `whose`:
/// the process.
void add_plugin_limits(Verb& verb, double& timeout_s, double& memory_gib, const std::string& whose);
/// GiB that a plugin's process may take, where --memory is that; 0: a plugin that takes all must not take the
/// machine's.
double plugin_memory_gib(double asked);

/// --python, as every verb has it that takes plugins in Python.
template <class... More>
void add_python(Verb& verb, std::string& python, More... more) {
  verb.option("--python PROGRAM", python, "The interpreter for plugins in Python", with_default, more...)
      ->each([](const std::string& program) { ::setenv("LGABENCH_PYTHON", program.c_str(), 1); });  // usual_python()
}

/// --prompt, as every verb has it that asks a server, or reads what it replied.
template <class... More>
void add_prompt(Verb& verb, std::string& file, More... more) {
  verb.option(
      "--prompt FILE", file,
      "A text of your own that asks yes or no about each name, in place of share/lgabench/prompts/selection.txt: "
      "a line --- between system and user prompt, and {object_types}, {textures}, {command}, {about}, {group} "
      "and {candidate} in it",
      more...);
}

/// How a server is asked. --ca-file is for the workers too, which read the variable.
template <class... More>
void add_server(Verb& verb, std::string& request, long& reply_timeout_s, bool& any_served, More... more) {
  verb.option("--request JSON", request,
              "With --answers openai: a JSON merge patch applied to each request; null removes a field: "
              "'{\"temperature\": null, \"reasoning_effort\": \"low\"}'",
              more...);
  const std::function<void(const std::string&)> trust = [](const std::string& file) {
    ::setenv("SSL_CERT_FILE", fs::absolute(file).c_str(), 1);
  };
  verb.option("--ca-file FILE", trust,
              "With --answers openai: certificates (PEM) of the authorities to trust in place of this machine's; like "
              "SSL_CERT_FILE",
              CLI::ExistingFile, more...);
  verb.option("--reply-timeout SECONDS", reply_timeout_s, "With --answers openai: seconds to wait for a reply",
              CLI::Range(1, 1000000), with_default, more...);
  verb.option("--any-served", any_served,
              "With --answers openai: go on where the server begins to name another model than in the cassette's "
              "replies, and name all of them as the source",
              more...);
}

/// --scenario-path, as every verb that reads scenarios has it.
inline void add_scenario_path(Verb& verb) {
  const std::function<void(const std::vector<fs::path>&)> add = [](const std::vector<fs::path>& directories) {
    for (const fs::path& directory : directories) lgabench::add_scenario_path(directory);
  };
  verb.option("--scenario-path DIR", add, "Also look for scenarios (.json files) here; can be repeated", repeatable);
}

/// Says on stderr what to write in place of words of an earlier release, which still work.
void say_renamed(const std::string& old, const std::string& now);

/// Becomes lgabench-worker with these words; the first is a verb of worker_verbs. @returns an exit status where that
/// program cannot be started
int hand_to_worker(std::vector<std::string> words);

/// Parses the words behind the program, runs the verb's callback, turns typed errors into one line on stderr and an
/// exit status.
int dispatch(CLI::App& app, const std::vector<std::string>& words, const int& exit);

}  // namespace lgabench::cli

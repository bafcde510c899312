#include <lgabench/cli/verbs.hpp>

#include <cstdlib>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/read_space.hpp>
#include <lgabench/core/suggest.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench::cli {

// Lists the spaces only when a word is given.
CLI::Validator feature_space() {
  return CLI::Validator([](std::string& word) { return one_of("feature space", feature_space_ids())(word); }, "", "");
}

std::string layout_of(const Scenario& scenario, const std::string& word) {
  const std::vector<std::string> there = layouts_of(scenario);
  if (word.empty()) return there.front();
  if (!contains(there, word)) throw InputError("--layout: " + none_named("layout", word, there));
  return word;
}

Json options_set(const PluginInfo& plugin, const std::vector<std::string>& words) {
  Json given = Json::object();
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    if (equals == word.npos) throw InputError(fmt::format("--set {}: expected option=value", word));
    given[word.substr(0, equals)] = option_value(word.substr(equals + 1));
  }
  return resolve_options(plugin, given);
}

void also_for_workers(const std::string& path) {
  if (path.find(':') != path.npos && path.find(".py:") == path.npos) return;  // would be two
  const char* const listed = std::getenv("LGABENCH_PLUGIN_PATH");
  const std::string all = (listed && *listed ? listed + std::string(":") : "") + fs::absolute(path).string();
  ::setenv("LGABENCH_PLUGIN_PATH", all.c_str(), 1);
}

void add_plugin_limits(Verb& verb, double& timeout_s, double& memory_gib, const std::string& whose) {
  verb.option("--timeout SECONDS", timeout_s, fmt::format("Time limit of {}, in seconds", whose), within(1, 1e6),
              with_default);
  verb.option(
      "--memory GIB", memory_gib,
      fmt::format("Memory limit of {}, in GiB (default: 4, or half of the job's memory where that is less)", whose),
      within(.1, 1e6));
}

double plugin_memory_gib(double asked) {
  constexpr double gib = 1 << 30, usual = 4;
  return asked > 0 ? asked : std::min(usual, usable_bytes() / gib / 2);
}

}  // namespace lgabench::cli

#include <lgabench/cli/verbs.hpp>

#include <cstdlib>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/read_space.hpp>
#include <lgabench/core/suggest.hpp>

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

void also_for_workers(const std::string& path) {
  if (path.find(':') != path.npos && path.find(".py:") == path.npos) return;  // would be two
  const char* const listed = std::getenv("LGABENCH_PLUGIN_PATH");
  const std::string all = (listed && *listed ? listed + std::string(":") : "") + fs::absolute(path).string();
  ::setenv("LGABENCH_PLUGIN_PATH", all.c_str(), 1);
}

}  // namespace lgabench::cli

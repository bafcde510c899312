#include <lgabench/cli/verbs.hpp>

#include <lgabench/core/environments.hpp>
#include <lgabench/core/shipped.hpp>

namespace lgabench::cli {

// Both open their files only when a word is given.
CLI::Validator installed_task() {
  return CLI::Validator([](std::string& word) { return one_of("task", installed_task_ids())(word); }, "", "");
}

CLI::Validator feature_space() {
  return CLI::Validator([](std::string& word) { return one_of("feature space", shipped_names("spaces"))(word); }, "",
                        "");
}

}  // namespace lgabench::cli

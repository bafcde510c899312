#include <lgabench/cli/verbs.hpp>

#include <lgabench/core/shipped.hpp>

namespace lgabench::cli {

// Lists the spaces only when a word is given.
CLI::Validator feature_space() {
  return CLI::Validator([](std::string& word) { return one_of("feature space", shipped_names("spaces"))(word); }, "",
                        "");
}

}  // namespace lgabench::cli

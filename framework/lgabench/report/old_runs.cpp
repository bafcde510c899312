#include <lgabench/report/old_runs.hpp>

namespace lgabench::report {

Json meaning_of(const Json& options) {
  Json meaning = options;
  // 0.1: batch_norm was all that the network could be asked for.
  if (options.contains("batch_norm")) {
    meaning.erase("batch_norm");
    meaning["network"] = options["batch_norm"] == true ? "text" : "plain";
  }
  // Since 0.2, with what held before.
  const Json before{
      {"batches", "shuffled"}, {"picture", "none"}, {"instances", "all"}, {"mask", "binary"}, {"policy", "regression"}};
  for (const auto& [option, value] : before.items())
    if (meaning.value(option, Json()) == value) meaning.erase(option);
  return meaning;
}

}  // namespace lgabench::report

// What `lgabench` asks its worker, which has renderer and engines, of scenes: `lgabench` links neither.
#pragma once
#include <string>
#include <vector>

#include <lgabench/core/json.hpp>

namespace lgabench {

struct WorkerAnswers {
  std::vector<Json> lines;  // one for each request; null where none came
  std::string problem;      // why lines may be missing; "" where nothing went wrong
};

/// Runs `lgabench-worker VERB` with that list of requests on its standard input. Blocks; any thread. A worker that is
/// missing or fails is the answers' problem, not an error.
WorkerAnswers ask_worker(const std::string& verb, const Json& requests);

}  // namespace lgabench

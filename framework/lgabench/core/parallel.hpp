#pragma once

#include <cstddef>
#include <functional>

namespace lgabench {

// Calls work(0) to work(n - 1), in any order, on as many threads as there are cores: what they write must not overlap.
// Where some throw, the first of them by number is thrown again when all threads have ended; later numbers may then
// have been left out.
void in_parallel(std::size_t n, const std::function<void(std::size_t)>& work);

}  // namespace lgabench

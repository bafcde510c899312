#pragma once

#include <cstddef>
#include <functional>

namespace lgabench {

// Calls work(0) to work(n - 1), in any order, on as many threads as usable_cores(), or fewer where the system starts
// fewer. Calls must not write to the same memory. If calls throw, the exception of the lowest number is thrown again
// when all threads have ended; calls of higher numbers may then be missing.
void in_parallel(std::size_t n, const std::function<void(std::size_t)>& work);

}  // namespace lgabench

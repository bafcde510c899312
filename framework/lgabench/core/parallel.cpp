#include <lgabench/core/parallel.hpp>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include <lgabench/core/refused.hpp>
#include <lgabench/core/resources.hpp>

namespace lgabench {

void in_parallel(std::size_t n, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::size_t failed = n;
  std::exception_ptr failure;
  const auto work_on = [&] {
    for (std::size_t i; (i = next++) < n;) {
      try {
        work(i);
      } catch (...) {
        next = n;  // lower numbers are all taken
        const std::lock_guard lock(mutex);
        if (i > failed) continue;
        failed = i;
        failure = std::current_exception();
      }
    }
  };
  if (n == 0) return;
  std::vector<std::thread> others = start_helpers(std::min<std::size_t>(usable_cores(), n) - 1, work_on);
  work_on();
  for (std::thread& thread : others) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace lgabench
